// What a flow does to bodies and to faces of the box: consistent, from the residual of the momentum rows there.
#include "simulate/flow_forces.h"

#include <bit>

namespace kropla {
namespace {

/// The faces that hold this direction of the velocity, a bit each.
unsigned holding(const FlowOptions& options, unsigned across) {
    unsigned hold = 0;
    for (std::size_t face = 0; face < 6; ++face) {
        const FlowFace::Kind kind = options.faces[face].kind;
        const bool along = kind == FlowFace::Kind::wall || kind == FlowFace::Kind::velocity;
        const bool slips = kind == FlowFace::Kind::slip && (across >> face & 1u) != 0;
        if (along || slips) hold |= 1u << face;
    }
    return hold;
}

/// The faces that each vertex stands on, a bit each; none where a body or a fixed wall holds it.
Array<Vertex, unsigned> faces_at(const FlowBoundary& boundary, std::size_t vertices) {
    Array<Vertex, unsigned> faces(vertices, 0);
    for (std::size_t face = 0; face < 6; ++face)
        for (const auto& facet : boundary.faces[face])
            for (Vertex v : facet) faces[v] |= 1u << face;
    for (const SolidSurface& solid : boundary.solids)
        for (Vertex v : solid.vertices) faces[v] = 0;
    for (const auto& facet : boundary.fixed_walls)
        for (Vertex v : facet) faces[v] = 0;
    return faces;
}

}  // namespace

Array<Vertex, Vec3> reactions(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& residual) {
    const std::vector<Vertex>& vertex = pattern.numbering.vertex;
    std::vector<double> all(3 * vertex.size(), 0.0);
    for (std::size_t r = 0; r < pattern.rows.count(); ++r)
        for (std::size_t m = 0; m < 3; ++m)
            all[3 * (static_cast<std::size_t>(pattern.rows.first_row) + r) + m] = residual[block_size * r + m];
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, ranks.communicator);
    Array<Vertex, Vec3> reaction(pattern.numbering.row.size());
    for (std::size_t r = 0; r < vertex.size(); ++r)
        if (!pattern.numbering.is_further(r)) reaction[vertex[r]] = {all[3 * r], all[3 * r + 1], all[3 * r + 2]};
    return reaction;
}

void take_off_pressure(const Pattern& pattern, const FlowBoundary& boundary, const FlowConditions& conditions,
                       const Array<Vertex, Vec3>& position, const std::vector<double>& pressure,
                       Array<Vertex, Vec3>& reaction) {
    const auto take_off = [&](const std::vector<std::array<Vertex, 3>>& facets) {
        for (const auto& [a, b, c] : facets)
            for (Vertex v : {a, b, c})
                reaction[v] += pressure[pattern.piece_of(a)] / 6 * cross(position[b] - position[a], position[c] - position[a]);
    };
    for (std::size_t face = 0; face < 6; ++face)
        if (!conditions.open[face]) take_off(boundary.faces[face]);
    for (const SolidSurface& solid : boundary.solids) take_off(solid.facets);
}

std::vector<FaceShare> shares_of_faces(const FlowBoundary& boundary, const FlowConditions& conditions,
                                       const Array<Vertex, Vec3>& position, const Array<Vertex, double>& pressure) {
    Array<Vertex, char> held(position.size(), 0);
    for (const SolidSurface& solid : boundary.solids)
        for (Vertex v : solid.vertices) held[v] = 1;
    std::vector<FaceShare> shares;
    for (std::size_t face = 0; face < 6; ++face) {
        if (conditions.open[face]) continue;  // what acts there is no reaction
        for (const auto& facet : boundary.faces[face]) {
            const auto& [a, b, c] = facet;
            const Vec3 area = 0.5 * cross(position[b] - position[a], position[c] - position[a]);
            const double sum = pressure[a] + pressure[b] + pressure[c];
            for (Vertex v : facet)
                if (held[v] != 0) shares.push_back({face, v, -(pressure[v] + sum) / 12 * area});
        }
    }
    return shares;
}

std::vector<BodyForce> body_forces(const FlowBoundary& boundary, const Array<Vertex, Vec3>& position,
                                   const Array<Vertex, Vec3>& velocity, const Array<Vertex, Vec3>& reaction) {
    std::vector<BodyForce> bodies;
    for (const SolidSurface& solid : boundary.solids) {
        BodyForce of{solid.body, solid.centre};
        for (Vertex v : solid.vertices) {
            of.force -= reaction[v];
            of.torque -= cross(position[v] - solid.centre, reaction[v]);
        }
        of.flux = flux_through(solid.facets, position, velocity);
        bodies.push_back(of);
    }
    return bodies;
}

std::array<Vec3, 6> face_forces(const FlowOptions& options, const FlowBoundary& boundary,
                                const std::vector<FaceShare>& shares, const Array<Vertex, Vec3>& reaction) {
    const Array<Vertex, unsigned> faces = faces_at(boundary, reaction.size());
    std::array<Vec3, 6> forces = {};
    for (const FaceShare& share : shares) forces[share.face] -= share.reaction;
    for (int m = 0; m < 3; ++m) {
        const unsigned across = 3u << (2 * m), hold = holding(options, across);
        for (Vertex v : reaction.indices()) {
            const unsigned all = faces[v] & hold, those = (all & across) != 0 ? all & across : all;
            for (std::size_t face = 0; face < 6; ++face)
                if ((those >> face & 1u) != 0) forces[face][m] -= reaction[v][m] / std::popcount(those);
        }
    }
    return forces;
}

}  // namespace kropla
