// The initial mesh (paper 1.1): points, Delaunay, identification of the bodies.
//
// A surface triangle is a facet of the Delaunay mesh if a sphere through its corners is empty. Where one is
// not there, points in its diametral sphere are removed; where that does not do, an edge of it is split, as
// in [Shewchuk 1998, "Tetrahedral mesh generation by Delaunay refinement"], with the new point on the body's
// surface. The interior of a body is then what can be reached from the inner side of its surface without
// crossing a surface.

#include "base/error.h"
#include "generate/box.h"
#include "generate/generate.h"
#include "generate/relax.h"
#include "generate/skin.h"
#include "generate/triangle.h"
#include "mesh/cells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace kropla {

namespace {

/// The points of a mesh to be: the bodies' surfaces, which may be refined, and all others.
struct Draft {
    std::vector<Surface> surfaces;
    std::vector<Vec3> others;
};

std::vector<Vec3> all_points(const Draft& draft) {
    std::vector<Vec3> points;
    for (const Surface& s : draft.surfaces) points.insert(points.end(), s.points.begin(), s.points.end());
    points.insert(points.end(), draft.others.begin(), draft.others.end());
    return points;
}

/// The sampled points, relaxed but for those of the surfaces.
Draft relaxed_draft(const Snapshot& at, std::uint64_t seed) {
    constexpr int rounds = 10;
    PointSet set = sample_points(at, seed);
    Draft draft{std::move(set.surfaces), {}};
    std::size_t fixed = 0;
    for (const Surface& s : draft.surfaces) fixed += s.points.size();
    relax_points(set.points, fixed, at, rounds);
    draft.others.assign(set.points.begin() + static_cast<std::ptrdiff_t>(fixed), set.points.end());
    return draft;
}

/// Three vertices in a cyclic order that matters, the least first.
using Turn = std::array<Vertex, 3>;
Turn turn(Vertex a, Vertex b, Vertex c) {
    Turn abc = {a, b, c};
    std::ranges::rotate(abc, std::ranges::min_element(abc));
    return abc;
}

struct TetFacet {
    Turn vertices;  // counter-clockwise seen from outside the tet
    Tet tet;
    std::size_t corner;
};

/// The facets among the first `count` points, from both sides, sorted by their vertices.
std::vector<TetFacet> facets_among(const Triangulation& filled, std::size_t count) {
    std::vector<TetFacet> found;
    const Vertex end(count);
    for (Tet t : filled.tets.indices())
        for (std::size_t i = 0; i < 4; ++i) {
            const auto corner = [&](std::size_t k) {
                return filled.tets[t][static_cast<std::size_t>(tet_facets[i][k])];
            };
            if (corner(0) < end && corner(1) < end && corner(2) < end)
                found.push_back({turn(corner(0), corner(1), corner(2)), t, i});
        }
    std::ranges::sort(found, {}, &TetFacet::vertices);
    return found;
}

/// Where a surface triangle was looked for: the tet on its inner side, if it is a facet.
struct SurfaceFacet {
    std::size_t body, triangle;
    std::optional<TetFacet> inner;
};

std::vector<SurfaceFacet> find_surfaces(const Triangulation& filled, const std::vector<Surface>& surfaces) {
    std::size_t count = 0;
    for (const Surface& s : surfaces) count += s.points.size();
    const std::vector<TetFacet> facets = facets_among(filled, count);
    std::vector<SurfaceFacet> found;
    std::int32_t first = 0;
    for (std::size_t body = 0; body < surfaces.size(); ++body) {
        for (std::size_t i = 0; i < surfaces[body].triangles.size(); ++i) {
            const auto& [a, b, c] = surfaces[body].triangles[i];
            const Turn sought = turn(Vertex(first + a), Vertex(first + b), Vertex(first + c));
            const auto at = std::ranges::lower_bound(facets, sought, {}, &TetFacet::vertices);
            const bool there = at != facets.end() && at->vertices == sought;
            found.push_back({body, i, there ? std::optional(*at) : std::nullopt});
        }
        first += static_cast<std::int32_t>(surfaces[body].points.size());
    }
    return found;
}

/// The sphere whose centre is in the plane of a triangle and that passes through its corners.
struct Sphere {
    Vec3 centre;
    double radius;
};
Sphere diametral_sphere(const Surface& surface, std::size_t triangle) {
    const auto& [i, j, k] = surface.triangles[triangle];
    const auto place = [&](int p) { return surface.points[static_cast<std::size_t>(p)]; };
    const Vec3 centre = triangle_circumcentre(place(i), place(j), place(k));
    return {centre, distance(centre, place(i))};
}

/// Removes the inner points in the sphere; those of the box stay. Returns how many.
std::size_t clear_sphere(std::vector<Vec3>& others, const Box& box, const Sphere& sphere) {
    return std::erase_if(others, [&](const Vec3& x) {
        return distance(x, sphere.centre) <= sphere.radius && !shared_face(box, {x}).exists();
    });
}

/// Splits the longest edges of `triangles`, all of one body, and frees the space around the new points.
void refine_surface(Draft& draft, std::size_t body, const std::vector<std::size_t>& triangles,
                    const Snapshot& at) {
    Skin skin = make_skin(draft.surfaces[body], at.shapes[body].centre);
    const Skin before = skin;
    for (std::size_t i : triangles) {
        const Triangle triangle(i);
        if (skin.triangles[triangle] != before.triangles[triangle])
            continue;  // split from across an edge of it
        const Vertex added = split_longest_edge(skin, at.shapes[body], triangle);
        const double half_edge = distance(skin.points[added], skin.points[skin.triangles[triangle][0]]);
        clear_sphere(draft.others, at.box, {skin.points[added], half_edge});
    }
    flip_edges(skin);
    draft.surfaces[body] = surface_of(skin);
}

/// Makes room for the surface triangles that were not found.
void recover(Draft& draft, const std::vector<SurfaceFacet>& found, const Snapshot& at) {
    std::size_t cleared = 0;
    for (const SurfaceFacet& f : found)
        if (!f.inner)
            cleared +=
                clear_sphere(draft.others, at.box, diametral_sphere(draft.surfaces[f.body], f.triangle));
    if (cleared > 0) return;
    for (std::size_t body = 0; body < draft.surfaces.size(); ++body) {
        std::vector<std::size_t> missing;
        for (const SurfaceFacet& f : found)
            if (!f.inner && f.body == body) missing.push_back(f.triangle);
        if (!missing.empty()) refine_surface(draft, body, missing, at);
    }
}

/// The region of each tet: that of the body whose surface encloses it, else the surroundings.
Array<Tet, Region> identify_regions(const Triangulation& filled, const std::vector<SurfaceFacet>& surfaces) {
    Array<Tet, Region> region(filled.tets.size(), surroundings);
    Array<Tet, std::array<bool, 4>> closed(filled.tets.size());
    std::vector<Tet> open;
    for (const SurfaceFacet& f : surfaces) {
        const auto& [vertices, inner, corner] = *f.inner;
        const Tet outer = filled.neighbour[inner][corner];
        closed[inner][corner] = true;
        for (std::size_t i = 0; i < 4; ++i)
            if (filled.neighbour[outer][i] == inner) closed[outer][i] = true;
        region[inner] = region_of_body(f.body);
        open.push_back(inner);
    }
    while (!open.empty()) {
        const Tet t = open.back();
        open.pop_back();
        for (std::size_t i = 0; i < 4; ++i) {
            const Tet next = filled.neighbour[t][i];
            if (closed[t][i] || !next.exists() || region[next] == region[t]) continue;
            region[next] = region[t];
            open.push_back(next);
        }
    }
    return region;
}

std::vector<BoundaryFacet> box_facets(const Triangulation& filled, const Array<Vertex, Vec3>& position,
                                      const Box& box) {
    std::vector<BoundaryFacet> facets;
    for (Tet t : filled.tets.indices())
        for (std::size_t i = 0; i < 4; ++i) {
            if (filled.neighbour[t][i].exists()) continue;
            std::array<Vertex, 3> corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = filled.tets[t][static_cast<std::size_t>(tet_facets[i][k])];
            facets.push_back({corners, shared_face(box, {position[corners[0]], position[corners[1]],
                                                         position[corners[2]]})});
        }
    return facets;
}

}  // namespace

Mesh generate_mesh(const Domain& domain, std::uint64_t seed) {
    constexpr double least_gap =
        0.25;  // of the surface size: R/r = 7 for the tet across on an equilateral one
    constexpr int recoveries = 20;
    check_placement(domain, 0, least_gap);
    const Snapshot at = snapshot(domain, 0);
    Draft draft = relaxed_draft(at, seed);
    for (int i = 0; i < recoveries; ++i) {
        const std::vector<Vec3> points = all_points(draft);
        Triangulation filled = triangulate(points);
        const std::vector<SurfaceFacet> surfaces = find_surfaces(filled, draft.surfaces);
        if (std::ranges::any_of(surfaces, [](const SurfaceFacet& f) { return !f.inner; })) {
            recover(draft, surfaces, at);
            continue;
        }
        Array<Vertex, Vec3> position(points.size());
        std::ranges::copy(points, position.begin());
        const Array<Tet, Region> region = identify_regions(filled, surfaces);
        const std::vector<BoundaryFacet> boundary = box_facets(filled, position, at.box);
        return make_mesh(std::move(position), std::move(filled.tets), region, boundary);
    }
    throw DomainError(
        "the bodies' surfaces cannot be made facets of the mesh; a smaller size.surface may do");
}

}  // namespace kropla
