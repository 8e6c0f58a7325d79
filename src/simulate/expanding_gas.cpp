// A gas that expands where it is heated: the masses of its vertices follow from the temperature, and what they gain the
// velocity has to bring.
#include "simulate/expanding_gas.h"

#include <numeric>
#include <utility>

namespace kropla {

ExpandingGas::ExpandingGas(VertexMasses masses, const Pattern& pattern, const FlowBoundary& boundary,
                           FlowMaterial& material, double dt)
    : masses_(std::move(masses)), pattern_(pattern), boundary_(boundary), material_(material), dt_(dt),
      gained_(material.densities.size(), 0.0) {
    for (Array<Vertex, double>& passed : passed_) passed = gained_;
}

/// What vertices gain is as it is then, but in the last stage, that in the step all is gained that there is to gain. Where
/// the mesh goes otherwise than the velocity of a solid body has it, for a moment, mass would pass its surface: that is the
/// same in all.
void ExpandingGas::begin(const StageTime& stage, const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& velocity,
                         const Array<Vertex, Vec3>& mesh_velocity) {
    material_.densities = masses_.densities(stage.share);
    expansion_ = Array<Vertex, double>(gained_.size(), 0.0);
    if (mesh_velocity.empty()) return;
    material_.density_rate = masses_.density_rate();
    const Array<Vertex, double>& density = material_.densities;
    const Array<Vertex, double> mass = masses_.masses(stage.share);
    Array<Vertex, double> rate = masses_.rates(stage.share);
    if (stage.share == 1) {
        const Array<Vertex, double> begin = masses_.masses(0);
        for (Vertex v : rate.indices()) rate[v] = (mass[v] - begin[v] - gained_[v]) / (stage.weight * dt_);
    }
    for (Vertex v : rate.indices()) gained_[v] += stage.weight * dt_ * rate[v];
    Array<Vertex, Vec3> passing = velocity;
    for (Vertex v : passing.indices()) passing[v] -= mesh_velocity[v];
    std::vector<double> leak(as_size(pattern_.rows.pieces), 0.0), all(leak);
    for (const SolidSurface& solid : boundary_.solids)
        for_each_flux(solid.facets, position, passing, [&](Vertex v, double flux) {
            rate[v] += density[v] * flux;
            leak[pattern_.piece_of(v)] += density[v] * flux;
        });
    const std::vector<Vertex>& vertices = pattern_.numbering.vertex;
    for (Vertex v : vertices) all[pattern_.piece_of(v)] += mass[v];
    for (Vertex v : vertices) {
        const std::size_t piece = pattern_.piece_of(v);
        expansion_[v] = (rate[v] - leak[piece] * mass[v] / all[piece]) / density[v];
    }
}

void ExpandingGas::end(const StageTime& stage, const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& velocity) {
    for (std::size_t face = 0; face < 6; ++face)
        for_each_flux(boundary_.faces[face], position, velocity, [&](Vertex v, double flux) {
            passed_[face][v] += stage.weight * densities()[v] * flux;
        });
}

std::vector<FaceMass> ExpandingGas::through() const {
    std::vector<FaceMass> through;
    for (std::size_t face = 0; face < 6; ++face)
        for (Vertex v : pattern_.numbering.vertex)
            if (const double rate = passed_[face][v]; rate != 0) through.push_back({v, face, rate});
    return through;
}

double ExpandingGas::mass_error() const {
    double out = 0;
    for (const FaceMass& part : through()) out += part.rate;
    return dt_ * out + std::accumulate(gained_.begin(), gained_.end(), 0.0);
}

}  // namespace kropla
