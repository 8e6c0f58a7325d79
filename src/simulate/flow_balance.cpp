// The balance of what passes the boundary of a flow: what is given or solved for leaves a rest, and this says where it goes.
#include "simulate/flow_balance.h"

namespace kropla {
namespace {

/// At vertices of open faces the directions along normals that are free.
Array<Vertex, Vec3> outward_where_open(const FlowBoundary& boundary, const FlowConditions& conditions,
                                       std::size_t vertices) {
    Array<Vertex, Vec3> outward(vertices);
    for (std::size_t face = 0; face < 6; ++face) {
        const auto axis = static_cast<int>(face / 2);
        for (const auto& facet : boundary.faces[face])
            for (Vertex v : facet)
                if (conditions.open[face] && !conditions.fixed[v][face / 2]) outward[v][axis] = face % 2 == 0 ? -1 : 1;
    }
    return outward;
}

}  // namespace

std::vector<double> shares_of_volume(const Mesh& mesh, const Cells& cells, const Numbering& numbering,
                                     const Array<Vertex, Vec3>& position) {
    std::vector<double> shares(numbering.vertex.size(), 0.0);
    double total = 0;
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        const double part = total_volume(cell_points(corners(position, mesh, cell)));
        total += part;
        for (Vertex v : vertices)
            shares[as_size(numbering.row_at(v, cell_region(mesh, cell)))] += part / static_cast<double>(vertices.size());
    });
    for (double& share : shares) share /= total;
    return shares;
}

void spread_net_flux(const Ranks& ranks, const SparseRows& rows, const std::vector<double>& share_of_volume,
                     std::vector<double>& residual) {
    double mine = 0, net = 0;
    for (std::size_t r = 0; r < rows.count(); ++r) mine += residual[block_size * r + 3];
    MPI_Allreduce(&mine, &net, 1, MPI_DOUBLE, MPI_SUM, ranks.communicator);
    for (std::size_t r = 0; r < rows.count(); ++r)
        residual[block_size * r + 3] -= net * share_of_volume[static_cast<std::size_t>(rows.first_row) + r];
}

void let_rest_out(const Ranks& ranks, const Pattern& pattern, const FlowBoundary& boundary,
                  const FlowConditions& conditions, const Array<Vertex, Vec3>& position,
                  const Array<Vertex, double>& densities, const std::vector<double>& residual,
                  Array<Vertex, Vec3>& velocity) {
    const auto density = [&](Vertex v) { return densities.empty() ? 1.0 : densities[v]; };
    const std::vector<Vertex>& vertex = pattern.numbering.vertex;
    double mine = 0, rest = 0;
    for (std::size_t r = 0; r < pattern.rows.count(); ++r)
        mine += density(vertex[static_cast<std::size_t>(pattern.rows.first_row) + r]) * residual[block_size * r + 3];
    MPI_Allreduce(&mine, &rest, 1, MPI_DOUBLE, MPI_SUM, ranks.communicator);
    const Array<Vertex, Vec3> outward = outward_where_open(boundary, conditions, position.size());
    double passing = 0;
    for (const auto& facets : boundary.faces)
        for_each_flux(facets, position, outward, [&](Vertex v, double flux) { passing += density(v) * flux; });
    if (!(passing > 0)) return;
    for (Vertex v : velocity.indices()) velocity[v] -= rest / passing * outward[v];
}

}  // namespace kropla
