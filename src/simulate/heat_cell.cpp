// What a cell, a tet or a prism, adds to a step of the heat equation: the terms derived in heat.h.
//   [Donea, Huerta 2003] Finite element methods for flow problems: the conservative ALE form.
//   [Brooks, Hughes 1982] Streamline upwind/Petrov-Galerkin formulations. CMAME 32: SUPG.
//   [Shakib, Hughes, Johan 1991] A new finite element formulation for computational fluid dynamics: X. CMAME
//     89: tau, here with the cell's length along the flow of [Tezduyar, Park 1986] CMAME 59.
#include "simulate/heat_cell.h"

#include "base/four.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace kropla {
namespace {

/// A cell of n corners during the step; or, if the number is a Four, four of them.
template <std::size_t n, class Number = double>
struct Cell {
    Corners<n, Number> x0, x1;        // where the corners came from, seen from their body, and are [m]
    Corners<n, Number> begin;         // where they were [m]
    std::array<Number, n> old;        // enthalpy at the begin [J/m^3]
    std::array<Number, n> guess;      // [K] at the end
    std::array<Number, n> enthalpy;   // at the guess [J/m^3]
    std::array<Number, n> slope;      // of it there [J/(m^3 K)]
    std::array<Number, n> source;     // [W/m^3]
    std::array<Number, n> potential;  // of the flow [m^2/s]
    Corners<n, Number> velocity;      // of it, besides [m/s]
    std::array<double, n> expansion;  // of what is there, in the step [-]
    Number conductivity;              // [W/(m K)]
    double dt;                        // [s]
    Number density;                   // [kg/m^3] where enthalpies are per mass, the mean of the corners; else one
    std::array<Number, n> thin_before, thin;  // there, at the step's begin and end [kg/m^3]
    bool by_mass;
    bool convects;                    // it flows, or moves past its material
    bool proportional;                // the enthalpy is `slope` times the temperature, anywhere
    bool expands;                     // or shrinks; four cells at once never do
    bool low;                         // of low order
};

/// What is carried, per volume. Four cells at once never are carried by mass.
template <std::size_t n, class T>
T by_density(const Cell<n>& cell, const T& carried) {
    return cell.density * carried;
}
template <std::size_t n, class T>
const T& by_density(const Cell<n, Four>&, const T& carried) {
    return carried;
}

bool flows(const HeatStep& step, Region region) {
    const bool with_flow = step.options.regions[as_size(region.value)].carried == Carried::with_flow;
    return with_flow && (!step.flow.potential[region].empty() || !step.flow.velocity_in(region).empty());
}

template <std::size_t n, class Name>
Cell<n> gather(const HeatStep& step, const Name& name) {
    const auto v = cell_vertices(step.current, name);
    const Region region = cell_region(step.current, name);
    const Property& conductivity = step.options.regions[static_cast<std::size_t>(region.value)].material.conductivity;
    const Enthalpy& enthalpy = step.enthalpy[region];
    const MaterialState& state = step.material[region];
    const auto& carried = step.carried[region];
    const bool flowing = flows(step, region);
    Cell<n> cell{.x0 = {},
                 .x1 = corners(step.current, name),
                 .begin = corners(step.before, name),
                 .old = {},
                 .guess = {},
                 .enthalpy = {},
                 .slope = {},
                 .source = at_corners(step.source[region], v),
                 .potential = at_corners(step.flow.potential[region], v),
                 .velocity = {},
                 .expansion = {},
                 .conductivity = conductivity.constant() ? conductivity(0) : mean_of(at_corners(state.conductivity, v)),
                 .dt = step.dt,
                 .density = 1,
                 .thin_before = {},
                 .thin = {},
                 .by_mass = region == step.flow.by_mass,
                 .convects = false,
                 .proportional = enthalpy.proportional(),
                 .expands = flowing && step.flow.expands(region),
                 .low = false};
    cell.x0 = carried.empty() ? cell.begin : corners(carried, step.current, name);
    cell.convects = flowing || cell.x0 != cell.x1;
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
    if (flowing) cell.velocity = at_corners(step.flow.velocity_in(region), v);
    if (cell.expands)
        for (std::size_t i = 0; i < n; ++i) cell.expansion[i] = step.dt * step.flow.expansion[region][v[i]];
    if (!step.low.empty())
        for (Vertex corner : v) cell.low = cell.low || step.low[corner] != 0;
    return cell;
}

/// What is carried: a matrix on enthalpies, in the form of CellSystem [m^3], or [kg] if these are per mass.
template <std::size_t n, class Number>
struct Carrying {
    std::array<std::array<Number, n>, n> matrix = {};
    std::array<Number, n> row_sum = {};
};

/// What there is, at the step's begin and end. In the matrix the consistent mass and L add up to the lumped one; on the
/// old enthalpy they act with the old and the new volume. Of low order, both masses are lumped.
template <std::size_t n, class Number>
void add_mass(const Cell<n, Number>& cell, const CellPoints<n, Number>& at_end, Carrying<n, Number>& carrying,
              CellSystem<n, Number>& system) {
    const CellPoints<n, Number> at_begin = cell_points(cell.begin);
    for (std::size_t k = 0; k < at_end.size(); ++k) {
        const ShapeMeans<n>& means = shape_means<n>[k];
        const Number now = at_end[k].volume, gained = now - at_begin[k].volume;
        for (std::size_t i = 0; i < n; ++i) {
            const Number old_product = cell.low ? means.value[i] * cell.old[i] : mean_product(k, i, cell.old);
            const Number lumped = now * means.value[i];
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
void add_mass_by_density(const Cell<n>& cell, const CellPoints<n>& at_end, Carrying<n, double>& carrying,
                         CellSystem<n>& system) {
    const CellPoints<n> at_begin = cell_points(cell.begin);
    for (std::size_t k = 0; k < at_end.size(); ++k) {
        const ShapeMeans<n>& means = shape_means<n>[k];
        const double now = at_end[k].volume, before = at_begin[k].volume;
        for (std::size_t i = 0; i < n; ++i) {
            const double lumped = now * mean_product(k, i, cell.thin);
            carrying.row_sum[i] += lumped;
            system.held[i] += cell.slope[i] * now * means.value[i] * cell.thin[i];  // the sum of a column: as much as energy counts
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

/// Of material that expands more comes, of the enthalpy at the begin, or some leaves, of that at the end.
template <std::size_t n>
void add_expansion(const Cell<n>& cell, const CellPoints<n>& at_end, Carrying<n, double>& carrying, CellSystem<n>& system) {
    for (std::size_t k = 0; k < at_end.size(); ++k) {
        for (std::size_t i = 0; i < n; ++i) {
            const double mean = cell.by_mass ? mean_product(k, i, cell.thin) : shape_means<n>[k].value[i];
            const double more = at_end[k].volume * mean * cell.expansion[i];
            if (more > 0) system.right[i] += more * cell.old[i];
            else carrying.row_sum[i] -= more;
        }
    }
}

/// Conduction, on temperatures.
template <std::size_t n, class Number>
void add_conduction(const Cell<n, Number>& cell, const CellPoints<n, Number>& at_end, CellSystem<n, Number>& system) {
    for (const CellPoint<n, Number>& point : at_end) {
        const Number conducted = cell.dt * cell.conductivity / point.volume;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const Number exchanged = conducted * dot(point.volume_gradient[i], point.volume_gradient[j]);
                system.matrix[i][j] += exchanged;
                system.matrix[j][i] += exchanged;
            }
        }
    }
}

/// The intrinsic time [s] of SUPG, for the speed |v| and its components v.grad phi_i, diffusivity [m^2/s] and
/// step.
template <class Number>
Number intrinsic_time(const Number& speed, const Number& sum_of_components, const Number& diffusivity, double dt) {
    const Number length = 2 * speed / sum_of_components;
    const Number transient = 2 / dt, convective = 2 * speed / length;
    const Number diffusive = 12 * diffusivity / (length * length);
    const Number time = 1 / square_root(transient * transient + convective * convective + diffusive * diffusive);
    return where_positive(sum_of_components, time);
}

/// The means of grad phi_i over the cell [1/m].
template <std::size_t n, class Number>
Corners<n, Number> mean_gradients(const CellPoints<n, Number>& points) {
    const Number per_volume = 1 / total_volume<n, Number>(points);
    Corners<n, Number> mean = {};
    for (const CellPoint<n, Number>& point : points)
        for (std::size_t i = 0; i < n; ++i) mean[i] += per_volume * point.volume_gradient[i];
    return mean;
}

/// SUPG, for the mean velocity `v` [m/s] of the material relative to the mesh.
template <std::size_t n, class Number>
void add_upwinding(const Cell<n, Number>& cell, const CellPoints<n, Number>& at_end,
                   const Corners<n, Number>& mean_gradient, const Vector3<Number>& v, Carrying<n, Number>& carrying,
                   CellSystem<n, Number>& system) {
    Number sum_along = 0;
    for (const Vector3<Number>& g : mean_gradient) sum_along += size(dot(v, g));
    const Number tau = intrinsic_time<Number>(square_root(squared_norm(v)), sum_along,
                                              cell.conductivity / by_density(cell, mean_of(cell.slope)), cell.dt);
    for (std::size_t k = 0; k < at_end.size(); ++k) {
        const CellPoint<n, Number>& point = at_end[k];
        std::array<Number, n> along;  // the point's volume times v.grad phi_i [m^3/s]
        for (std::size_t i = 0; i < n; ++i) along[i] = dot(v, point.volume_gradient[i]);
        const Number per_volume = cell.dt / point.volume;
        std::array<Number, n> means;  // of what j brings: phi_j and, over the step, v.grad phi_j
        for (std::size_t j = 0; j < n; ++j) means[j] = shape_means<n>[k].value[j] + per_volume * along[j];
        const Number known = by_density(cell, mean_value(k, cell.old)) + cell.dt * mean_value(k, cell.source);
        for (std::size_t i = 0; i < n; ++i) {
            const Number weight = tau * along[i];
            for (std::size_t j = 0; j < n; ++j) carrying.matrix[i][j] += by_density(cell, weight) * means[j];
            carrying.row_sum[i] += by_density(cell, weight);  // the components sum to zero
            system.right[i] += weight * known;
        }
    }
}

/// What the material and the mesh carry past each other: - dt C, and but for low order L on what moved (which makes
/// nothing of a constant), and the upwinding.
template <std::size_t n, class Number>
void add_convection(const Cell<n, Number>& cell, const CellPoints<n, Number>& at_end, Carrying<n, Number>& carrying,
                    CellSystem<n, Number>& system) {
    const auto mean_volume_gradient = mean_volume_gradients(cell.x0, cell.x1);
    Corners<n, Number> moved;        // dt w
    Corners<n, Number> flown_at;     // dt velocity
    Corners<n, Number> lumped = {};  // L on it
    for (std::size_t i = 0; i < n; ++i) {
        moved[i] = cell.x1[i] - cell.x0[i];
        flown_at[i] = cell.dt * cell.velocity[i];
    }
    Vector3<Number> past;  // the integral of dt (u - w)
    for (std::size_t k = 0; k < at_end.size(); ++k) {
        const CellPoint<n, Number>& point = at_end[k];
        const ShapeMeans<n>& means = shape_means<n>[k];
        const Vector3<Number> by_potential = cell.dt * gradient(point, cell.potential);
        const Vector3<Number> flown = by_potential + mean_value(k, flown_at);
        const Vector3<Number> mean_moved = mean_value(k, moved);
        past += point.volume * (flown - mean_moved);
        for (std::size_t i = 0; i < n; ++i)
            carrying.row_sum[i] -= by_density(cell, Number(dot(flown, point.volume_gradient[i]) -
                                                           dot(mean_moved, mean_volume_gradient[k][i])));
        for (std::size_t j = 0; j < n; ++j) {
            const Vector3<Number> product = mean_product(k, j, moved);
            lumped[j] += point.volume * (means.value[j] * moved[j] - product);
            const Vector3<Number> flown_product = means.value[j] * by_potential + mean_product(k, j, flown_at);
            for (std::size_t i = 0; i < n; ++i)
                carrying.matrix[i][j] -= by_density(cell, Number(dot(flown_product, point.volume_gradient[i]) -
                                                                 dot(product, mean_volume_gradient[k][i])));
        }
    }
    if (cell.low) return;
    const Corners<n, Number> mean_gradient = mean_gradients<n, Number>(at_end);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) carrying.matrix[i][j] -= by_density(cell, Number(dot(lumped[i], mean_gradient[j])));
    add_upwinding(cell, at_end, mean_gradient, past / (cell.dt * total_volume<n, Number>(at_end)), carrying, system);
}

/// The slope of the chord of the enthalpy between two corners, at their guesses.
template <std::size_t n, class Number>
Number chord(const Cell<n, Number>& cell, std::size_t i, std::size_t j) {
    if constexpr (std::is_same_v<Number, double>) {
        constexpr double distinct = 1e-6;  // [-] of the temperature: nearer to each other, rounding is seen
        const double between = cell.guess[j] - cell.guess[i];
        if (!cell.proportional && std::abs(between) > distinct * std::abs(cell.guess[i]))
            return (cell.enthalpy[j] - cell.enthalpy[i]) / between;
    }
    return 0.5 * (cell.slope[i] + cell.slope[j]);
}

/// What is carried, on temperatures: differences by chords, what is there by Newton's method.
template <std::size_t n, class Number>
void add_carrying(const Cell<n, Number>& cell, const Carrying<n, Number>& carrying, CellSystem<n, Number>& system) {
    for (std::size_t i = 0; i < n; ++i) {
        system.row_sum[i] += carrying.row_sum[i] * cell.slope[i];
        if (!cell.proportional)
            system.right[i] += carrying.row_sum[i] * (cell.slope[i] * cell.guess[i] - cell.enthalpy[i]);
        for (std::size_t j = 0; j < n; ++j)
            if (i != j) system.matrix[i][j] += carrying.matrix[i][j] * chord(cell, i, j);
    }
}

template <std::size_t n, class Number>
CellSystem<n, Number> system_of(const Cell<n, Number>& cell) {
    const CellPoints<n, Number> at_end = cell_points(cell.x1);
    Carrying<n, Number> carrying;
    CellSystem<n, Number> system;
    if constexpr (std::is_same_v<Number, double>) {
        if (cell.by_mass) add_mass_by_density(cell, at_end, carrying, system);
        if (cell.expands) add_expansion(cell, at_end, carrying, system);
    }
    if (!cell.by_mass) add_mass(cell, at_end, carrying, system);
    add_conduction(cell, at_end, system);
    if (cell.convects) add_convection(cell, at_end, carrying, system);
    add_carrying(cell, carrying, system);
    return system;
}

using FourTets = std::array<Cell<4>, 4>;

/// Are the same terms asked for, of all four? Only where the enthalpy is proportional.
bool alike(const FourTets& cells) {
    return std::ranges::all_of(cells, [&](const Cell<4>& cell) {
        return cell.proportional && !cell.by_mass && !cell.expands && cell.convects == cells[0].convects && cell.low == cells[0].low;
    });
}

Cell<4, Four> four_of(const FourTets& cells) {
    const auto conductivity = [&](std::size_t which) { return cells[which].conductivity; };
    return {.x0 = places_together(cells, [](const auto& cell) -> auto& { return cell.x0; }),
            .x1 = places_together(cells, [](const auto& cell) -> auto& { return cell.x1; }),
            .begin = places_together(cells, [](const auto& cell) -> auto& { return cell.begin; }),
            .old = together(cells, [](const auto& cell) -> auto& { return cell.old; }),
            .guess = {},
            .enthalpy = {},
            .slope = together(cells, [](const auto& cell) -> auto& { return cell.slope; }),
            .source = together(cells, [](const auto& cell) -> auto& { return cell.source; }),
            .potential = together(cells, [](const auto& cell) -> auto& { return cell.potential; }),
            .velocity = places_together(cells, [](const auto& cell) -> auto& { return cell.velocity; }),
            .expansion = {},
            .conductivity = Four(Four::Register{conductivity(0), conductivity(1), conductivity(2), conductivity(3)}),
            .dt = cells[0].dt,
            .density = 1,
            .thin_before = {},
            .thin = {},
            .by_mass = false,
            .convects = cells[0].convects,
            .proportional = true,
            .expands = false,
            .low = cells[0].low};
}

void put(const CellSystem<4, Four>& fours, std::size_t which, CellSystem<4>& system) {
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) system.matrix[i][j] = fours.matrix[i][j][which];
        system.row_sum[i] = fours.row_sum[i][which];
        system.held[i] = fours.held[i][which];
        system.right[i] = fours.right[i][which];
        system.load[i] = fours.load[i][which];
    }
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

KROPLA_FOR_EACH_PROCESSOR KROPLA_WITH_ITS_CALLS
CellSystem<4> cell_system(const HeatStep& step, Tet t) {
    return system_of(gather<4>(step, t));
}

CellSystem<6> cell_system(const HeatStep& step, const Prism& prism) {
    return system_of(gather<6>(step, prism));
}

KROPLA_FOR_EACH_PROCESSOR KROPLA_WITH_ITS_CALLS
void cell_systems(const HeatStep& step, const std::array<Tet, 4>& tets, const FourPlaces& systems) {
    const FourTets cells = {gather<4>(step, tets[0]), gather<4>(step, tets[1]), gather<4>(step, tets[2]),
                            gather<4>(step, tets[3])};
    if (!alike(cells)) {
        for (std::size_t which = 0; which < 4; ++which) *systems[which] = system_of(cells[which]);
        return;
    }
    const CellSystem<4, Four> all = system_of(four_of(cells));
    for (std::size_t which = 0; which < 4; ++which) put(all, which, *systems[which]);
}

}  // namespace kropla
