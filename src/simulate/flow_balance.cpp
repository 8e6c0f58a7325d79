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

std::vector<double> shares_of_volume(const Mesh& mesh, const Cells& cells, const Pattern& pattern,
                                     const Array<Vertex, Vec3>& position) {
    std::vector<double> shares(pattern.numbering.vertex.size(), 0.0), volume(as_size(pattern.rows.pieces), 0.0);
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        const double part = total_volume(cell_points(corners(position, mesh, cell)));
        volume[pattern.piece_of(vertices[0])] += part;
        for (Vertex v : vertices)
            shares[as_size(pattern.numbering.row_at(v, cell_region(mesh, cell)))] += part / static_cast<double>(vertices.size());
    });
    for (std::size_t r = 0; r < shares.size(); ++r) shares[r] /= volume[pattern.rows.piece_of(r)];
    return shares;
}

void spread_net_flux(const Ranks& ranks, const SparseRows& rows, const std::vector<char>& closed,
                     const std::vector<double>& share_of_volume, std::vector<double>& residual) {
    const auto net = sums_of_pieces(ranks, rows, [&](std::size_t r) { return residual[block_size * r + 3]; });
    for (std::size_t r = 0; r < rows.count(); ++r)
        if (const std::size_t piece = rows.piece_of_owned(r); closed[piece] != 0)
            residual[block_size * r + 3] -= net[piece] * share_of_volume[static_cast<std::size_t>(rows.first_row) + r];
}

void let_rest_out(const Ranks& ranks, const Pattern& pattern, const FlowBoundary& boundary,
                  const FlowConditions& conditions, const Array<Vertex, Vec3>& position,
                  const Array<Vertex, double>& densities, const std::vector<double>& residual,
                  Array<Vertex, Vec3>& velocity) {
    const auto density = [&](Vertex v) { return densities.empty() ? 1.0 : densities[v]; };
    const SparseRows& rows = pattern.rows;
    const std::vector<Vertex>& vertex = pattern.numbering.vertex;
    const auto rest = sums_of_pieces(ranks, rows, [&](std::size_t r) {
        return density(vertex[static_cast<std::size_t>(rows.first_row) + r]) * residual[block_size * r + 3];
    });
    const Array<Vertex, Vec3> outward = outward_where_open(boundary, conditions, position.size());
    std::vector<double> passing(rest.size(), 0.0);
    for (const auto& facets : boundary.faces)
        for_each_flux(facets, position, outward,
                      [&](Vertex v, double flux) { passing[pattern.piece_of(v)] += density(v) * flux; });
    for (std::size_t r = 0; r < vertex.size(); ++r)
        if (const std::size_t piece = rows.piece_of(r); passing[piece] > 0 && !pattern.numbering.is_further(r))
            velocity[vertex[r]] -= rest[piece] / passing[piece] * outward[vertex[r]];
}

}  // namespace kropla
