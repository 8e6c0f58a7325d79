#include "mesh/proposals.h"

#include <kropla/base/predicates.h>

namespace kropla {
namespace {

NewTet with_vertex_replaced(const Mesh& mesh, Tet t, Vertex old_vertex, Vertex new_vertex) {
    NewTet added{mesh.tets[t], mesh.region[t], mesh.patch[t]};
    added.vertices[std::size_t(corner_of(mesh, t, old_vertex))] = new_vertex;
    return added;
}

}  // namespace

Cavity insertion(const Mesh& mesh, Tet t, const Vec3& place) {
    Cavity cavity{{t}, {}, {place}};
    for (Vertex v : mesh.tets[t]) {
        cavity.added.push_back(with_vertex_replaced(mesh, t, v, inserted_vertex(0)));
        cavity.added.back().patch = {};
    }
    return cavity;
}

Cavity facet_removal(const Mesh& mesh, Facet f) {
    const Tet across = mesh.neighbour[f.tet][std::size_t(f.corner)];
    const Vertex d = mesh.tets[f.tet][std::size_t(f.corner)];
    const Vertex e = mesh.tets[across][std::size_t(mirror_corner(mesh, f))];
    const auto [p, q, r] = facet_vertices(mesh, f);
    const Region region = mesh.region[f.tet];
    return {{f.tet, across}, {{{d, e, p, q}, region}, {{d, e, q, r}, region}, {{d, e, r, p}, region}}, {}};
}

Cavity edge_removal(const Mesh& mesh, Edge e) {
    const Shell s = shell(mesh, e).value();
    const Vertex p = s.ring[0], q = s.ring[1], r = s.ring[2];
    const Region region = mesh.region[s.tets[0]];
    return {s.tets, {{{p, q, r, e.b}, region}, {{p, r, q, e.a}, region}}, {}};
}

Cavity wall_swap(const Mesh& mesh, Edge e) {
    const Shell s = shell(mesh, e).value();
    const Vertex p = s.ring[0], q = s.ring[1], r = s.ring[2];
    const Region region = mesh.region[s.tets[0]];
    const Patch wall = mesh.patch[s.tets[0]][std::size_t(corner_of(mesh, s.tets[0], q))];
    return {s.tets,
            {{{p, q, r, e.b}, region, {Patch{}, wall, Patch{}, Patch{}}},
             {{p, r, q, e.a}, region, {Patch{}, Patch{}, wall, Patch{}}}},
            {}};
}

Cavity edge_split(const Mesh& mesh, Edge e) {
    Cavity cavity{shell(mesh, e).value().tets, {}, {(mesh.position[e.a] + mesh.position[e.b]) / 2}};
    for (Tet t : cavity.removed)
        for (Vertex end : {e.a, e.b})
            cavity.added.push_back(with_vertex_replaced(mesh, t, end, inserted_vertex(0)));
    return cavity;
}

Cavity edge_collapse(const Mesh& mesh, Edge e) {
    Cavity cavity{ball(mesh, e.a), {}, {}};
    for (Tet t : cavity.removed)
        if (corner_of(mesh, t, e.b) < 0) cavity.added.push_back(with_vertex_replaced(mesh, t, e.a, e.b));
    return cavity;
}

bool all_positive(const Mesh& mesh, const Cavity& cavity) {
    for (const auto& [v, region, patch] : cavity.added) {
        const auto place = [&](std::size_t corner) { return place_in(mesh, cavity, v[corner]); };
        if (orient3d(place(0), place(1), place(2), place(3)) <= 0) return false;
    }
    return true;
}

}  // namespace kropla
