// What a cell, a tet or a prism, adds to a step of the heat equation: the terms derived in heat.h.
//   [Donea, Huerta 2003] Finite element methods for flow problems: the conservative ALE form.
//   [Brooks, Hughes 1982] Streamline upwind/Petrov-Galerkin formulations. CMAME 32: SUPG.
//   [Shakib, Hughes, Johan 1991] A new finite element formulation for computational fluid dynamics: X. CMAME
//     89: tau, here with the cell's length along the flow of [Tezduyar, Park 1986] CMAME 59.
#include "simulate/heat_cell.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// A cell of n corners during the step.
template <std::size_t n>
struct Cell {
    Corners<n> x0, x1;                // where the corners came from, seen from their body, and are [m]
    CellPoints<n> before, now;        // at the step's begin and end
    std::array<double, n> old;        // enthalpy at the begin [J/m^3]
    std::array<double, n> guess;      // [K] at the end
    std::array<double, n> enthalpy;   // at the guess [J/m^3]
    std::array<double, n> slope;      // of it there [J/(m^3 K)]
    std::array<double, n> source;     // [W/m^3]
    std::array<double, n> potential;  // of the flow [m^2/s]
    std::array<Vec3, n> velocity;     // of it, besides [m/s]
    bool flows;
    double conductivity;              // [W/(m K)]
    double dt;                        // [s]
    double density;                   // [kg/m^3] where enthalpies are per mass, the mean of the corners; else one
    std::array<double, n> thin_before, thin;  // there, at the step's begin and end [kg/m^3]
    bool by_mass;
    bool proportional;                // the enthalpy is `slope` times the temperature, anywhere
    bool low;                         // of low order
};

bool flows(const HeatStep& step, Region region) {
    const bool rests = step.options.regions[static_cast<std::size_t>(region.value)].carried == Carried::at_rest;
    return rests && (!step.flow.potential[region].empty() || !step.flow.velocity.empty());
}

template <std::size_t n, class Name>
Cell<n> gather(const HeatStep& step, const Name& name) {
    const auto v = cell_vertices(step.current, name);
    const Region region = cell_region(step.current, name);
    const Property& conductivity = step.options.regions[static_cast<std::size_t>(region.value)].material.conductivity;
    const Enthalpy& enthalpy = step.enthalpy[region];
    const MaterialState& state = step.material[region];
    const auto& carried = step.carried[region];
    const Corners<n> x0 = corners(step.before, name), x1 = corners(step.current, name);
    Cell<n> cell{.x0 = carried.empty() ? x0 : corners(carried, step.current, name),
                 .x1 = x1,
                 .before = cell_points(x0),
                 .now = cell_points(x1),
                 .old = {},
                 .guess = {},
                 .enthalpy = {},
                 .slope = {},
                 .source = at_corners(step.source[region], v),
                 .potential = at_corners(step.flow.potential[region], v),
                 .velocity = {},
                 .flows = flows(step, region),
                 .conductivity = conductivity.constant() ? conductivity(0) : mean_of(at_corners(state.conductivity, v)),
                 .dt = step.dt,
                 .density = 1,
                 .thin_before = {},
                 .thin = {},
                 .by_mass = region == step.flow.by_mass,
                 .proportional = enthalpy.proportional(),
                 .low = false};
    if (cell.proportional) {
        cell.slope.fill(enthalpy.slope(0));
        for (std::size_t i = 0; i < n; ++i) cell.old[i] = cell.slope[i] * step.old_temperature[v[i]];
    } else {
        cell.old = at_corners(state.old, v);
        cell.guess = at_corners(step.guess, v);
        cell.enthalpy = at_corners(state.enthalpy, v);
        cell.slope = at_corners(state.slope, v);
    }
    if (cell.by_mass) {
        cell.thin_before = at_corners(step.flow.density_before, v);
        cell.thin = at_corners(step.flow.density, v);
        cell.density = mean_of(cell.thin);
    }
    if (cell.flows) cell.velocity = at_corners(step.flow.velocity, v);
    if (!step.low.empty())
        for (Vertex corner : v) cell.low = cell.low || step.low[corner] != 0;
    return cell;
}

/// What is carried: a matrix on enthalpies, in the form of CellSystem [m^3], or [kg] if these are per mass.
template <std::size_t n>
struct Carrying {
    std::array<std::array<double, n>, n> matrix = {};
    std::array<double, n> row_sum = {};
};

/// What there is, at the step's begin and end. In the matrix the consistent mass and L add up to the lumped one; on the
/// old enthalpy they act with the old and the new volume. Of low order, both masses are lumped.
template <std::size_t n>
void add_mass(const Cell<n>& cell, Carrying<n>& carrying, CellSystem<n>& system) {
    for (std::size_t k = 0; k < cell.now.size(); ++k) {
        const ShapeMeans<n>& means = shape_means<n>[k];
        const double now = cell.now[k].volume, gained = now - cell.before[k].volume;
        for (std::size_t i = 0; i < n; ++i) {
            const double old_product = cell.low ? means.value[i] * cell.old[i] : mean_product(k, i, cell.old);
            const double lumped = now * means.value[i];
            carrying.row_sum[i] += lumped;
            system.held[i] += cell.slope[i] * lumped;
            system.right[i] += lumped * cell.old[i] - gained * old_product;
            system.load[i] += cell.dt * lumped * cell.source[i];
        }
    }
}

/// The same where enthalpies are per mass, M_ij = integral(rho_j phi_i phi_j): L is of the cell's density, and of low order
/// masses are exchanged along edges until no coupling has the wrong sign: at the end by the larger density of its ends, at
/// the begin by the smaller one. Both act on differences alone.
template <std::size_t n>
void add_mass_by_density(const Cell<n>& cell, Carrying<n>& carrying, CellSystem<n>& system) {
    for (std::size_t k = 0; k < cell.now.size(); ++k) {
        const ShapeMeans<n>& means = shape_means<n>[k];
        const double now = cell.now[k].volume, before = cell.before[k].volume;
        for (std::size_t i = 0; i < n; ++i) {
            const double lumped = now * mean_product(k, i, cell.thin);
            carrying.row_sum[i] += lumped;
            system.held[i] += cell.slope[i] * lumped;
            system.load[i] += cell.dt * now * means.value[i] * cell.source[i];
            for (std::size_t j = 0; j < n; ++j) {
                const double product = means.product[i][j], rise = cell.old[i] - cell.old[j];
                system.right[i] += before * product * cell.thin_before[j] * cell.old[j];
                if (cell.low) {
                    carrying.matrix[i][j] += now * product * (cell.thin[j] - std::max(cell.thin[i], cell.thin[j]));
                    system.right[i] += before * product * std::min(cell.thin_before[i], cell.thin_before[j]) * rise;
                } else {
                    carrying.matrix[i][j] += now * product * (cell.thin[j] - cell.density);
                    system.right[i] += now * product * cell.density * rise;
                }
            }
        }
    }
}

/// Conduction, on temperatures.
template <std::size_t n>
void add_conduction(const Cell<n>& cell, CellSystem<n>& system) {
    for (const CellPoint<n>& point : cell.now) {
        const double conducted = cell.dt * cell.conductivity / point.volume;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const double exchanged = conducted * dot(point.volume_gradient[i], point.volume_gradient[j]);
                system.matrix[i][j] += exchanged;
                system.matrix[j][i] += exchanged;
            }
        }
    }
}

/// The intrinsic time [s] of SUPG, for the speed |v| and its components v.grad phi_i, diffusivity [m^2/s] and
/// step.
double intrinsic_time(double speed, double sum_of_components, double diffusivity, double dt) {
    if (!(sum_of_components > 0)) return 0;
    const double length = 2 * speed / sum_of_components;
    const double transient = 2 / dt, convective = 2 * speed / length;
    const double diffusive = 12 * diffusivity / (length * length);
    return 1 / std::sqrt(transient * transient + convective * convective + diffusive * diffusive);
}

/// The means of grad phi_i over the cell [1/m].
template <std::size_t n>
std::array<Vec3, n> mean_gradients(const CellPoints<n>& points) {
    const double volume = total_volume<n>(points);
    std::array<Vec3, n> mean = {};
    for (const CellPoint<n>& point : points)
        for (std::size_t i = 0; i < n; ++i) mean[i] += point.volume_gradient[i] / volume;
    return mean;
}

/// SUPG, for the mean velocity `v` [m/s] of the material relative to the mesh.
template <std::size_t n>
void add_upwinding(const Cell<n>& cell, const std::array<Vec3, n>& mean_gradient, const Vec3& v,
                   Carrying<n>& carrying, CellSystem<n>& system) {
    double sum_along = 0;
    for (const Vec3& g : mean_gradient) sum_along += std::abs(dot(v, g));
    const double diffusivity = cell.conductivity / (cell.density * mean_of(cell.slope));
    const double tau = intrinsic_time(norm(v), sum_along, diffusivity, cell.dt);
    for (std::size_t k = 0; k < cell.now.size(); ++k) {
        const CellPoint<n>& point = cell.now[k];
        std::array<double, n> along;  // the point's volume times v.grad phi_i [m^3/s]
        for (std::size_t i = 0; i < n; ++i) along[i] = dot(v, point.volume_gradient[i]);
        std::array<double, n> means;  // of what j brings: phi_j and, over the step, v.grad phi_j
        for (std::size_t j = 0; j < n; ++j)
            means[j] = shape_means<n>[k].value[j] + cell.dt / point.volume * along[j];
        const double known = cell.density * mean_value(k, cell.old) + cell.dt * mean_value(k, cell.source);
        for (std::size_t i = 0; i < n; ++i) {
            const double weight = tau * along[i];
            for (std::size_t j = 0; j < n; ++j) carrying.matrix[i][j] += weight * cell.density * means[j];
            carrying.row_sum[i] += weight * cell.density;  // the components sum to zero
            system.right[i] += weight * known;
        }
    }
}

/// What the material and the mesh carry past each other: - dt C, and but for low order L on what moved (which makes
/// nothing of a constant), and the upwinding.
template <std::size_t n>
void add_convection(const Cell<n>& cell, Carrying<n>& carrying, CellSystem<n>& system) {
    const auto mean_volume_gradient = mean_volume_gradients(cell.x0, cell.x1);
    std::array<Vec3, n> moved;        // dt w
    std::array<Vec3, n> flown_at;     // dt velocity
    std::array<Vec3, n> lumped = {};  // L on it
    for (std::size_t i = 0; i < n; ++i) {
        moved[i] = cell.x1[i] - cell.x0[i];
        flown_at[i] = cell.dt * cell.velocity[i];
    }
    Vec3 past;  // the integral of dt (u - w)
    for (std::size_t k = 0; k < cell.now.size(); ++k) {
        const CellPoint<n>& point = cell.now[k];
        const ShapeMeans<n>& means = shape_means<n>[k];
        const Vec3 by_potential = cell.dt * gradient(point, cell.potential);
        const Vec3 flown = by_potential + mean_value(k, flown_at);
        const Vec3 mean_moved = mean_value(k, moved);
        past += point.volume * (flown - mean_moved);
        for (std::size_t i = 0; i < n; ++i)
            carrying.row_sum[i] -= cell.density * (dot(flown, point.volume_gradient[i]) -
                                                   dot(mean_moved, mean_volume_gradient[k][i]));
        for (std::size_t j = 0; j < n; ++j) {
            const Vec3 product = mean_product(k, j, moved);
            lumped[j] += point.volume * (means.value[j] * moved[j] - product);
            const Vec3 flown_product = means.value[j] * by_potential + mean_product(k, j, flown_at);
            for (std::size_t i = 0; i < n; ++i)
                carrying.matrix[i][j] -= cell.density * (dot(flown_product, point.volume_gradient[i]) -
                                                         dot(product, mean_volume_gradient[k][i]));
        }
    }
    if (cell.low) return;
    const std::array<Vec3, n> mean_gradient = mean_gradients<n>(cell.now);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) carrying.matrix[i][j] -= cell.density * dot(lumped[i], mean_gradient[j]);
    add_upwinding(cell, mean_gradient, past / (cell.dt * total_volume<n>(cell.now)), carrying, system);
}

/// The slope of the chord of the enthalpy between two corners, at their guesses.
template <std::size_t n>
double chord(const Cell<n>& cell, std::size_t i, std::size_t j) {
    constexpr double distinct = 1e-6;  // [-] of the temperature: nearer to each other, rounding is seen
    const double between = cell.guess[j] - cell.guess[i];
    if (cell.proportional || !(std::abs(between) > distinct * std::abs(cell.guess[i])))
        return 0.5 * (cell.slope[i] + cell.slope[j]);
    return (cell.enthalpy[j] - cell.enthalpy[i]) / between;
}

/// What is carried, on temperatures: differences by chords, what is there by Newton's method.
template <std::size_t n>
void add_carrying(const Cell<n>& cell, const Carrying<n>& carrying, CellSystem<n>& system) {
    for (std::size_t i = 0; i < n; ++i) {
        system.row_sum[i] += carrying.row_sum[i] * cell.slope[i];
        if (!cell.proportional)
            system.right[i] += carrying.row_sum[i] * (cell.slope[i] * cell.guess[i] - cell.enthalpy[i]);
        for (std::size_t j = 0; j < n; ++j)
            if (i != j) system.matrix[i][j] += carrying.matrix[i][j] * chord(cell, i, j);
    }
}

template <std::size_t n, class Name>
CellSystem<n> system_of(const HeatStep& step, const Name& name) {
    const Cell<n> cell = gather<n>(step, name);
    Carrying<n> carrying;
    CellSystem<n> system;
    if (cell.by_mass) add_mass_by_density(cell, carrying, system);
    else add_mass(cell, carrying, system);
    add_conduction(cell, system);
    if (cell.flows || cell.x0 != cell.x1) add_convection(cell, carrying, system);
    add_carrying(cell, carrying, system);
    return system;
}

}  // namespace

Array<Region, Enthalpy> enthalpy_curves(const HeatOptions& options, Region by_mass) {
    Array<Region, Enthalpy> curves;
    for (const HeatRegion& region : options.regions) {
        HeatMaterial material = region.material;
        if (by_mass == Region(curves.size())) material.density = 1;
        curves.push_back(Enthalpy(material));
    }
    return curves;
}

CellSystem<4> cell_system(const HeatStep& step, Tet t) {
    return system_of<4>(step, t);
}

CellSystem<6> cell_system(const HeatStep& step, const Prism& prism) {
    return system_of<6>(step, prism);
}

}  // namespace kropla
