// Relaxation of the points before the bodies are identified.
//
// Each point moves to the mean of the circumcentres of its tets, weighted by their volumes over the cube of
// the target size: the optimal Delaunay triangulation of [Chen, Xu 2004; Alliez, Cohen-Steiner, Yvinec,
// Desbrun 2005, "Variational tetrahedral meshing"], graded. Points of a face of the box do the same among its
// triangles, which in a Delaunay mesh of a box are the Delaunay triangulation of the face.

#include "generate/relax.h"

#include "base/tetrahedron.h"
#include "generate/box.h"
#include "generate/clearance.h"
#include "generate/triangle.h"
#include <kropla/mesh/cells.h>

#include <bit>

namespace kropla {

namespace {

constexpr std::int32_t cells_at_once = 4096;  // between two looks at the watch: a millisecond

/// The mean that a point is drawn to: sums over its cells.
struct Pull {
    Vec3 sum;  // of weight * displacement
    double weight = 0;
};

/// The faces of the box on which `x` lies, as bits.
unsigned faces_at(const Box& box, const Vec3& x) {
    unsigned faces = 0;
    for (int face = 0; face < 6; ++face)
        if (lies_on_face(box, Patch(face), x)) faces |= 1u << face;
    return faces;
}

struct Relaxation {
    const std::vector<Vec3>& points;
    const Snapshot& at;
    std::vector<unsigned> faces;
    std::vector<Pull> pull;

    [[nodiscard]] const Vec3& place(Vertex v) const { return points[static_cast<std::size_t>(v.value)]; }
};

void pull_towards(Relaxation& r, Vertex v, const Vec3& target, double weight) {
    Pull& pull = r.pull[static_cast<std::size_t>(v.value)];
    pull.sum += weight * (target - r.place(v));
    pull.weight += weight;
}

void pull_inner(Relaxation& r, const std::array<Vertex, 4>& tet) {
    const Vec3 &a = r.place(tet[0]), &b = r.place(tet[1]), &c = r.place(tet[2]), &d = r.place(tet[3]);
    const double size = target_size(r.at, 0.25 * (a + b + c + d));
    const double weight = tet_volume(a, b, c, d) / (size * size * size);
    const Vec3 centre = tet_circumcentre(a, b, c, d);
    for (Vertex v : tet)
        if (r.faces[static_cast<std::size_t>(v.value)] == 0) pull_towards(r, v, centre, weight);
}

void pull_on_face(Relaxation& r, const std::array<Vertex, 3>& triangle) {
    const Vec3 &a = r.place(triangle[0]), &b = r.place(triangle[1]), &c = r.place(triangle[2]);
    const double size = target_size(r.at, (a + b + c) / 3);
    const double weight = norm(cross(b - a, c - a)) / (size * size);
    const Vec3 centre = triangle_circumcentre(a, b, c);
    for (Vertex v : triangle)
        if (std::has_single_bit(r.faces[static_cast<std::size_t>(v.value)]))
            pull_towards(r, v, centre, weight);
}

Relaxation pulls(const std::vector<Vec3>& points, const Snapshot& at, const Watch* watch) {
    Relaxation r{points, at, {}, std::vector<Pull>(points.size())};
    for (const Vec3& x : points) r.faces.push_back(faces_at(at.box, x));
    const Triangulation filled = triangulate(points, watch);
    for (Tet t : filled.tets.indices()) {
        if (t.value % cells_at_once == 0) heed(watch);
        const auto& corners = filled.tets[t];
        pull_inner(r, corners);
        for (std::size_t i = 0; i < 4; ++i) {
            if (filled.neighbour[t][i].exists()) continue;
            const auto& f = tet_facets[i];
            pull_on_face(r, {corners[static_cast<std::size_t>(f[0])], corners[static_cast<std::size_t>(f[1])],
                             corners[static_cast<std::size_t>(f[2])]});
        }
    }
    return r;
}

/// The place to which the pull takes the point, or half way, as the clearance allows; else where it is.
Vec3 pulled(const Snapshot& at, const Vec3& x, unsigned faces, const Pull& pull) {
    Vec3 by = pull.sum / pull.weight;
    for (int face = 0; face < 6; ++face)
        if (faces >> face & 1u) by[face / 2] = 0;  // against rounding: exactly on the face
    for (double part : {1.0, 0.5}) {
        const Vec3 to = x + part * by;
        const double kept =
            faces == 0 ? clearance(at, to) : clearance_on_face(at, Patch(std::countr_zero(faces)), to);
        if (kept >= 0) return to;
    }
    return x;
}

}  // namespace

void relax_points(std::vector<Vec3>& points, std::size_t first_free, const Snapshot& at, int rounds,
                  const Watch* watch) {
    for (int round = 0; round < rounds; ++round) {
        heed(watch, "relaxing points", static_cast<double>(round) / rounds);
        const Relaxation r = pulls(points, at, watch);
        for (std::size_t i = first_free; i < points.size(); ++i)
            if (r.pull[i].weight > 0) points[i] = pulled(at, points[i], r.faces[i], r.pull[i]);
    }
}

}  // namespace kropla
