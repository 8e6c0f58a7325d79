#include "app/fault.h"

#include "app/hanging.h"
#include <kropla/base/predicates.h>
#include "mesh/crossing.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <algorithm>
#include <fmt/format.h>

namespace kropla {
namespace {

std::string place(const Vec3& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x, x.y, x.z); }

bool is_turned(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return orient3d(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]) < 0;
}

std::string fault_of_numbering(const Mesh& mesh) {
    const auto tets = all_tets(mesh);
    if (tets.size() < 2 || !std::ranges::all_of(tets, [&](Tet t) { return is_turned(mesh, t); })) return {};
    return fmt::format("all {} tets are inside out: the file numbers their corners the other way round", tets.size());
}

std::string fault_of_hanging(const Mesh& mesh) {
    const auto hanging = hanging_vertex(mesh);
    if (!hanging) return {};
    return fmt::format(
        "cell {} at {}: vertex {} at {} lies in its facet opposite corner {} without being one of its "
        "corners",
        hanging->facet.tet.value, place_of(mesh, hanging->facet.tet), hanging->vertex.value,
        place(mesh.position[hanging->vertex]), hanging->facet.corner);
}

std::string fault_of_crossing(const Mesh& mesh) {
    const auto found = find_crossing(mesh);
    if (!found) return {};
    return fmt::format("cell {} at {}: its facet opposite corner {} {} that opposite corner {} of cell {} at {}",
                       found->a.tet.value, place_of(mesh, found->a.tet), found->a.corner,
                       found->covers ? "covers" : "cuts", found->b.corner, found->b.tet.value,
                       place_of(mesh, found->b.tet));
}

std::string named(const Mesh& mesh, Tet t) { return fmt::format("cell {} at {}", t.value, place_of(mesh, t)); }
std::string named(const Mesh& mesh, const Prism& prism) {
    return fmt::format("prism {} on triangle {} of layer {} at {}", prism.k, prism.triangle, prism.layer.value,
                       place(prism_corners(mesh, prism)[0]));
}

std::string fault_of_buried(const Mesh& mesh) {
    const auto found = find_buried(mesh);
    if (!found) return {};
    return fmt::format("cell {} at {} lies within {}", found->cell.value, place_of(mesh, found->cell),
                       std::visit([&](auto within) { return named(mesh, within); }, found->within));
}

}  // namespace

std::string place_of(const Mesh& mesh, Tet t) { return place(centroid(mesh, t)); }

std::string fault_of(const Mesh& mesh) {
    for (const auto check : {fault_of_numbering, verify, fault_of_hanging, fault_of_crossing, fault_of_buried})
        if (auto fault = check(mesh); !fault.empty()) return fault;
    return {};
}

}  // namespace kropla
