// Surfaces as facets of a Delaunay mesh (paper 1.1): found, and what they enclose identified.
//
// A surface triangle is a facet of the Delaunay mesh if a sphere through its corners is empty, for which its
// diametral sphere can be cleared [Shewchuk 1998, "Tetrahedral mesh generation by Delaunay refinement"]. The
// interior of a body is what can be reached from the inner side of its surface without crossing a surface.

#include "generate/conform.h"

#include "generate/box.h"
#include "generate/triangle.h"
#include <kropla/mesh/cells.h>

#include <algorithm>

namespace kropla {

std::vector<Vec3> all_points(const Room& room) {
    std::vector<Vec3> points;
    for (const Surface& s : room.surfaces) points.insert(points.end(), s.points.begin(), s.points.end());
    points.insert(points.end(), room.others.begin(), room.others.end());
    return points;
}

namespace {

Turn turn(Vertex a, Vertex b, Vertex c) {
    Turn abc = {a, b, c};
    std::rotate(abc.begin(), std::ranges::min_element(abc), abc.end());
    return abc;
}

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

}  // namespace

std::vector<SurfaceFacet> find_surfaces(const Triangulation& filled, const Room& room) {
    std::size_t count = 0;
    for (const Surface& s : room.surfaces) count += s.points.size();
    const std::vector<TetFacet> facets = facets_among(filled, count);
    std::vector<SurfaceFacet> found;
    std::int32_t first = 0;
    for (std::size_t surface = 0; surface < room.surfaces.size(); ++surface) {
        for (std::size_t i = 0; i < room.surfaces[surface].triangles.size(); ++i) {
            const auto& [a, b, c] = room.surfaces[surface].triangles[i];
            const Turn sought = turn(Vertex(first + a), Vertex(first + b), Vertex(first + c));
            const auto at = std::ranges::lower_bound(facets, sought, {}, &TetFacet::vertices);
            const bool there = at != facets.end() && at->vertices == sought;
            found.push_back({surface, i, there ? std::optional(*at) : std::nullopt});
        }
        first += static_cast<std::int32_t>(room.surfaces[surface].points.size());
    }
    return found;
}

Array<Tet, Region> identify_regions(const Triangulation& filled, const Room& room,
                                    const std::vector<SurfaceFacet>& found) {
    Array<Tet, Region> region(filled.tets.size(), surroundings);
    Array<Tet, std::array<bool, 4>> closed(filled.tets.size());
    std::vector<Tet> open;
    for (const SurfaceFacet& f : found) {
        const auto& [vertices, inner, corner] = *f.inner;
        const Tet outer = filled.neighbour[inner][corner];  // none: the surface is on the hull there
        closed[inner][corner] = true;
        for (std::size_t i = 0; outer.exists() && i < 4; ++i)
            if (filled.neighbour[outer][i] == inner) closed[outer][i] = true;
        region[inner] = room.enclosed[f.surface];
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

Sphere diametral_sphere(const Surface& surface, std::size_t triangle) {
    const auto& [i, j, k] = surface.triangles[triangle];
    const auto place = [&](int p) { return surface.points[static_cast<std::size_t>(p)]; };
    const Vec3 centre = triangle_circumcentre(place(i), place(j), place(k));
    return {centre, distance(centre, place(i))};
}

std::size_t clear_sphere(std::vector<Vec3>& others, const Box& box, const Sphere& sphere) {
    return std::erase_if(others, [&](const Vec3& x) {
        return distance(x, sphere.centre) <= sphere.radius && !shared_face(box, {x}).exists();
    });
}

}  // namespace kropla
