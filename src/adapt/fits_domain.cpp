#include "adapt/fits_domain.h"

#include "adapt/constants.h"
#include <kropla/base/error.h>
#include <kropla/domain/words.h>
#include <kropla/mesh/cells.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <cmath>
#include <string>
#include <vector>

namespace kropla {
namespace {

std::string region_words(Region region) { return "region " + std::to_string(region.value); }

void check_regions(const Domain& domain, const Mesh& mesh) {
    std::vector<bool> has_cells(domain.bodies.size() + 1, false);
    const auto check = [&](Region region, const auto& what) {
        if (region.value < 0 || as_size(region.value) >= has_cells.size())
            throw DomainError(what() + " is of " + region_words(region) + ", but the domain has " +
                              std::to_string(domain.bodies.size()) + " bodies");
    };
    for (Tet t : all_tets(mesh)) {
        check(mesh.region[t],
              [&] { return "cell " + std::to_string(t.value) + " at " + place_words(centroid(mesh, t)); });
        has_cells[as_size(mesh.region[t].value)] = true;
    }
    for (const PrismLayer& layer : mesh.layers)
        for (Region region : {layer.region, layer.body}) check(region, [] { return std::string("a layer"); });
    for (std::size_t body = 0; body < domain.bodies.size(); ++body)
        if (!has_cells[body + 1])
            throw DomainError(named(domain.bodies[body]) + " has no cells: the mesh has none of " +
                              region_words(region_of_body(body)));
}

void check_faces(const Box& box, const Mesh& mesh) {
    const Vec3 width = box.max - box.min;
    for (Tet t : all_tets(mesh))
        for (std::size_t i = 0; i < 4; ++i) {
            const Patch patch = mesh.patch[t][i];
            if (mesh.neighbour[t][i].exists() || !patch.exists() || patch.value >= box_faces) continue;
            const int axis = patch.value / 2;
            const double face = patch.value % 2 == 0 ? box.min[axis] : box.max[axis];
            for (int corner : tet_facets[i]) {
                const Vec3& x = mesh.position[mesh.tets[t][as_size(corner)]];
                if (std::abs(x[axis] - face) <= most_off_its_face * width[axis]) continue;
                throw DomainError("a facet of patch " + std::to_string(patch.value) + " has a vertex at " +
                                  place_words(x) + ", off " + wall_name(patch.value) + " of the domain's box");
            }
        }
}

void check_surfaces(const Domain& domain, const Mesh& mesh, double time) {
    const Snapshot at = snapshot(domain, time);
    const auto check = [&](std::size_t body, const Vec3& x) {
        const double off = std::abs(signed_distance(at.shapes[body], x));
        if (off <= most_off_its_shape * surface_size(at, body)) return;
        throw DomainError(named(domain.bodies[body]) + " is not where the mesh has it: a vertex of its surface at " +
                          place_words(x) + " is " + metres(off) + " from where it stands at t = " + time_words(time));
    };
    for (Tet t : all_tets(mesh))
        for (std::size_t i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[t][i];
            if (!n.exists() || mesh.region[t] == surroundings || mesh.region[n] == mesh.region[t]) continue;
            const auto body = as_size(mesh.region[t].value) - 1;
            for (int corner : tet_facets[i])
                check(body, mesh.position[mesh.tets[t][as_size(corner)]]);
        }
    for (const PrismLayer& layer : mesh.layers)
        for (int column = 0; column < count_columns(layer); ++column)
            check(as_size(layer.body.value) - 1, mesh.position[column_vertex(layer, column, 0)]);
}

}  // namespace

void check_fits(const Domain& domain, const Mesh& mesh, double t) {
    if (const std::string fault = verify(mesh); !fault.empty()) throw DomainError("the mesh has a fault: " + fault);
    check_regions(domain, mesh);
    check_faces(domain.box, mesh);
    check_surfaces(domain, mesh, t);
}

}  // namespace kropla
