#pragma once

#include "simulate/cells.h"

namespace kropla {

/// The masses of vertices in a step, m_i = integral(rho phi_i), where the density at vertices and their places change
/// evenly with time.
class VertexMasses {
public:
    VertexMasses(const Mesh& before, const Mesh& current, Cells cells, Array<Vertex, double> begin,
                 Array<Vertex, double> end, double dt);

    /// At a share of the step.
    [[nodiscard]] Array<Vertex, double> densities(double share) const;  // [kg/m^3]
    [[nodiscard]] Array<Vertex, double> density_rate() const;           // [kg/(m^3 s)]
    [[nodiscard]] Array<Vertex, double> masses(double share) const;     // [kg]
    [[nodiscard]] Array<Vertex, double> rates(double share) const;      // [kg/s]

private:
    template <class Visit>
    void for_each_corner(double share, const Visit& visit) const;

    const Mesh &before_, &current_;
    Cells cells_;
    Array<Vertex, double> begin_, end_;
    double dt_;
};

}  // namespace kropla
