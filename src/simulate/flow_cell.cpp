// What a cell, a tet or a prism, adds to a stage of a flow's step. With a = u - w and the residual of
// momentum r = rho (du/dt + a.grad u) - f + grad p (without viscosity: linear tets have none within them,
// prisms next to none)
//     momentum i:  integral(phi_i (rho (du/dt + a.grad u) - f) + sigma.grad phi_i)
//                  + integral(tau_M rho a.grad phi_i r) + integral(tau_C div u grad phi_i),
//     volume i:    integral(phi_i div u) + integral(tau_M grad phi_i.r).
// Where the density depends on the temperature, the latter is of mass, in terms of the density rho_i at the vertex,
//     volume i:    (integral(rho (tau_M r - (u - w)).grad phi_i) + what passes faces) / rho_i,
// in which rho is the cell's mean; what its vertices gain (flow_mass.h) comes in addition. With tau_C then is
// div u + (d rho/dt + (u - w).grad rho) / rho.
//   [Brooks, Hughes 1982] Streamline upwind/Petrov-Galerkin formulations. CMAME 32.
//   [Hughes, Franca, Balestra 1986] A new finite element formulation for computational fluid dynamics: V.
//     CMAME 59: PSPG.
//   [Bazilevs, Calo, Cottrell, Hughes, Reali, Scovazzi 2007] Variational multiscale residual-based turbulence
//     modeling. CMAME 197: tau_M = (4/dt^2 + a.G.a + C nu^2 G:G)^(-1/2) / rho, G the metric tensor of the
//     cell, without the terms of second order in the unresolved velocity. Theirs is tau_C = 1 / (tau_M tr G);
//     here it is rho^2 a.G.a tau_M / tr G, without the rate's part: the same where convection rules, and
//     nothing where viscosity does, which would be stiffened by it: the drag of a sphere in Stokes flow was
//     1.6 times as far off.
//   [Franca, Frey 1992] Stabilized finite element methods: II. The incompressible Navier-Stokes equations.
//     CMAME 99.
//   [Bazilevs, Gohean, Hughes, Moser, Zhang 2009] Patient-specific isogeometric fluid-structure interaction
//     analysis. CMAME 198: an open boundary takes -rho/2 (u.n)_- u where the flow comes back.
//   [Heywood, Rannacher, Turek 1996] Artificial boundaries and flux and pressure conditions. Int. J. Numer.
//     Methods Fluids 22: there mu du/dn - p n is given rather than the traction, so that a developed flow
//     goes out as it is.
// G of a tet is the mean over the four corners that the reference tet may begin at, so that it does not
// depend on their order; likewise over the three of a prism's triangle, with its height from -1 to 1.
#include "simulate/flow_cell.h"

#include "base/four.h"
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace kropla {
namespace {

constexpr double of_inverse_estimate = 9;  // [-] C: on a line tau_M is h^2 / (12 nu) [Franca, Frey 1992]

// [-] of tau_M, what the rate alone would make it: from here on the weight of SUPG is differentiated too. Far
//   from the
// solution, where steps are large, Newton's method does not find it so.
constexpr double rate_rules = 0.7;

template <class Number>
using Matrix3 = std::array<Vector3<Number>, 3>;  // by rows

/// A cell of n corners; or, if the number is a Four, four of them.
template <std::size_t n, class Number = double>
struct FlowCell {
    Corners<n, Number> x;
    std::array<Vertex, n> vertex;                   // not of four at once
    Corners<n, Number> velocity, carrying, inertia;  // u, a, rho du/dt - f
    std::array<Number, n> pressure;
    Number density, viscosity;
    double per_time;
    bool convection;
    bool expands;                      // the density depends on the temperature; four at once never do; only then:
    std::array<Vec3, n> passing;       // u - w
    std::array<double, n> in_terms;    // of the vertex's density, that of the cell
    std::array<double, n> densities;
    double density_rate;               // at vertices, in the mean [kg/(m^3 s)]
};

template <std::size_t n>
double mean_at(const Array<Vertex, double>& values, const std::array<Vertex, n>& vertices) {
    double sum = 0;
    for (Vertex v : vertices) sum += values[v];
    return sum / static_cast<double>(n);
}

/// What is of cells alone whose density depends on the temperature.
template <std::size_t n>
void gather_expansion(const FlowStage& stage, const FlowMaterial& material, FlowCell<n>& cell) {
    cell.density_rate = material.density_rate.empty() ? 0 : mean_at(material.density_rate, cell.vertex);
    cell.densities = at_corners(material.densities, cell.vertex);
    for (std::size_t i = 0; i < n; ++i) {
        cell.passing[i] = cell.velocity[i];
        if (!stage.mesh_velocity.empty()) cell.passing[i] -= stage.mesh_velocity[cell.vertex[i]];
        cell.in_terms[i] = cell.density / cell.densities[i];
    }
}

template <std::size_t n, class Name>
FlowCell<n> gather(const FlowStage& stage, const Name& name) {
    FlowCell<n> cell;
    cell.vertex = cell_vertices(stage.mesh, name);
    const Region region = cell_region(stage.mesh, name);
    const FlowMaterial& material = stage.material[region];
    const Array<Vertex, double>* const within =
        stage.upper.empty() || region.value == 0 ? nullptr : &stage.guess.within[as_size(region.value - 1)];
    const bool varies = !material.densities.empty();
    cell.density = varies ? mean_at(material.densities, cell.vertex) : material.density;
    cell.viscosity =
        material.viscosities.empty() ? material.viscosity : mean_at(material.viscosities, cell.vertex);
    cell.per_time = stage.per_time;
    cell.convection = stage.convection;
    cell.expands = varies;
    for (std::size_t i = 0; i < n; ++i) {
        const Vertex v = cell.vertex[i];
        cell.x[i] = stage.position[v];
        const Vec3 u = stage.guess.velocity[v];
        cell.velocity[i] = u;
        cell.pressure[i] = within != nullptr && stage.upper[v] == region ? (*within)[v] : stage.guess.pressure[v];
        cell.carrying[i] = stage.convection ? u : Vec3{};
        if (!stage.mesh_velocity.empty()) cell.carrying[i] -= stage.mesh_velocity[v];
        cell.inertia[i] = -(varies ? material.densities[v] : cell.density) * stage.gravity;
        if (stage.per_time > 0) cell.inertia[i] += cell.density * stage.per_time * (u - stage.old[v]);
        if (!material.force.empty()) cell.inertia[i] -= material.force[v];
    }
    if (varies) gather_expansion(stage, material, cell);
    return cell;
}

/// The gradients of the coordinates of the reference cell, with the weights of their squares in the metric
/// tensor.
template <std::size_t n, class Number>
struct Directions {
    static constexpr std::size_t count = 4;
    std::array<Vector3<Number>, count> gradient;  // [1/m]
    static constexpr std::array<double, count> weight =
        n == 4 ? std::array<double, 4>{0.75, 0.75, 0.75, 0.75}
               : std::array<double, 4>{2.0 / 3, 2.0 / 3, 2.0 / 3, 4};
};

template <class Number>
Directions<4, Number> directions(const Corners<4, Number>& gradient) { return {gradient}; }

Directions<6, double> directions(const Corners<6>& gradient) {
    return {{gradient[0] + gradient[3], gradient[1] + gradient[4], gradient[2] + gradient[5],
             gradient[3] + gradient[4] + gradient[5]}};
}

template <class Number>
struct Times {
    Number momentum;  // tau_M [m^3 s/kg]
    Number volume;    // tau_C [Pa s]
};

template <std::size_t n, class Number>
Times<Number> intrinsic_times(const FlowCell<n, Number>& cell, const Directions<n, Number>& of, const Vector3<Number>& carrying) {
    Number crossing = 0;  // a.G.a
    Vector3<Number> squares, products;  // G on its diagonal and off it
    for (std::size_t c = 0; c < of.count; ++c) {
        const Vector3<Number> &g = of.gradient[c], weighted = of.weight[c] * g;
        const Number across = dot(carrying, g);
        crossing += of.weight[c] * across * across;
        squares += {weighted.x * g.x, weighted.y * g.y, weighted.z * g.z};
        products += {weighted.y * g.z, weighted.z * g.x, weighted.x * g.y};
    }
    const Number trace = squares.x + squares.y + squares.z;
    const Number kinematic = cell.viscosity / cell.density;
    const Number viscous =
        of_inverse_estimate * kinematic * kinematic * (squared_norm(squares) + 2 * squared_norm(products));
    return {1 / (square_root(4 * cell.per_time * cell.per_time + crossing + viscous) * cell.density),
            where_positive(crossing, Number(cell.density * crossing / (square_root(crossing + viscous) * trace)))};
}

/// The means over the part of a cell that point k stands for of phi_i times what has these values at the
/// corners.
template <std::size_t n, class Number>
Corners<n, Number> means_with_shapes(const Corners<n, Number>& values, const Vector3<Number>& mean, std::size_t k) {
    Corners<n, Number> means;
    for (std::size_t i = 0; i < n; ++i)  // the products of shape_means, written out
        means[i] = n == 4 ? 0.05 * (4 * mean + values[i]) : shape_means<n>[k].value[i] * mean;
    return means;
}

/// What is known at a point of a cell, for the part of it that the point stands for.
template <std::size_t n, class Number = double>
struct FlowPoint {
    Number volume;
    const ShapeMeans<n>& means;
    Corners<n, Number> gradient;   // of phi_i
    Matrix3<Number> du;            // row m: grad u_m
    Vector3<Number> dp, residual;  // grad p, r
    Number divergence, pressure;
    Number missing;                // of the divergence: the residual of continuity
    Vec3 passing, thins;           // mean u - w; grad rho / rho: where the density depends on the temperature
    Times<Number> tau;
    Corners<n, Number> carried;    // mean of phi_i a
    Corners<n, Number> inertia;    // mean of phi_i (rho du/dt - f)
    std::array<Number, n> along;   // mean a.grad phi_i
};

template <std::size_t n>
void find_expansion(const FlowCell<n>& cell, FlowPoint<n>& point) {
    for (std::size_t i = 0; i < n; ++i) {
        point.passing += point.means.value[i] * cell.passing[i];
        point.thins += cell.densities[i] / cell.density * point.gradient[i];
    }
    point.missing += cell.density_rate / cell.density + dot(point.passing, point.thins);
}

template <std::size_t n, class Number>
FlowPoint<n, Number> flow_point(const FlowCell<n, Number>& cell, const CellPoint<n, Number>& at, std::size_t k) {
    using Vector = Vector3<Number>;
    FlowPoint<n, Number> point{at.volume, shape_means<n>[k], {}, {}, {}, {}, 0, 0, 0, {}, {}, {}, {}, {}, {}};
    Vector carrying, inertia;
    const Number per_volume = 1 / at.volume;
    for (std::size_t i = 0; i < n; ++i) {
        const Vector g = point.gradient[i] = per_volume * at.volume_gradient[i];
        for (int m = 0; m < 3; ++m) point.du[static_cast<std::size_t>(m)] += cell.velocity[i][m] * g;
        const double value = point.means.value[i];
        point.dp += cell.pressure[i] * g;
        point.pressure += value * cell.pressure[i];
        carrying += value * cell.carrying[i];
        inertia += value * cell.inertia[i];
    }
    point.missing = point.divergence = point.du[0].x + point.du[1].y + point.du[2].z;
    if constexpr (std::is_same_v<Number, double>)
        if (cell.expands) find_expansion(cell, point);
    const Vector convected{dot(carrying, point.du[0]), dot(carrying, point.du[1]), dot(carrying, point.du[2])};
    point.residual = cell.density * convected + inertia + point.dp;
    point.tau = intrinsic_times(cell, directions(point.gradient), carrying);
    for (std::size_t i = 0; i < n; ++i) point.along[i] = dot(carrying, point.gradient[i]);
    point.carried = means_with_shapes<n>(cell.carrying, carrying, k);
    point.inertia = means_with_shapes<n>(cell.inertia, inertia, k);
    return point;
}

template <std::size_t n, class Number>
void add_residual(const FlowCell<n, Number>& cell, const FlowPoint<n, Number>& at,
                  std::array<Number, block_size * n>& residual) {
    using Vector = Vector3<Number>;
    const Matrix3<Number>& du = at.du;
    const Number isotropic = at.tau.volume * at.missing - at.pressure;
    const Matrix3<Number> stress = {
        cell.viscosity * (du[0] + Vector{du[0].x, du[1].x, du[2].x}) + Vector{isotropic, 0, 0},
        cell.viscosity * (du[1] + Vector{du[0].y, du[1].y, du[2].y}) + Vector{0, isotropic, 0},
        cell.viscosity * (du[2] + Vector{du[0].z, du[1].z, du[2].z}) + Vector{0, 0, isotropic}};
    for (std::size_t i = 0; i < n; ++i) {
        const Vector &g = at.gradient[i], &carried = at.carried[i];
        const Vector convected{dot(carried, du[0]), dot(carried, du[1]), dot(carried, du[2])};
        const Vector sum = cell.density * convected + at.inertia[i] +
                           Vector{dot(stress[0], g), dot(stress[1], g), dot(stress[2], g)} +
                           at.tau.momentum * cell.density * at.along[i] * at.residual;
        for (int m = 0; m < 3; ++m)
            residual[block_size * i + static_cast<std::size_t>(m)] += at.volume * sum[m];
        const Number steered = at.tau.momentum * dot(g, at.residual);
        Number gained = at.means.value[i] * at.divergence + steered;
        if constexpr (std::is_same_v<Number, double>)
            if (cell.expands) gained = cell.in_terms[i] * (steered - dot(at.passing, g));
        residual[block_size * i + 3] += at.volume * gained;
    }
}

/// Writes or adds a column of a block.
template <bool add>
void put(const Four& column, double* to) {
    Four sum = column;
    if constexpr (add) {
        Four::Register before;
        std::memcpy(&before, to, sizeof before);
        sum = Four(before) + column;
    }
    std::memcpy(to, &sum.all, sizeof sum.all);
}

Four four(const Vec3& a, double last) { return Four(Four::Register{a.x, a.y, a.z, last}); }

/// The derivative, column by column of each block, three of momentum and one of volume at once. tau is taken
/// as it is, and so is the weight of SUPG in large steps.
template <bool add, bool expands, std::size_t n>
void put_derivative(const FlowCell<n>& cell, const FlowPoint<n>& at, CellBlocks<n>& blocks) {
    const double density = cell.density, volume = at.volume, tau = at.tau.momentum;
    const double newton = cell.convection ? volume * density : 0;
    const std::array<Four, 3> unit = {four({1, 0, 0}, 0), four({0, 1, 0}, 0), four({0, 0, 1}, 0)};
    const bool turns = cell.convection && 2 * cell.per_time * density * tau > rate_rules;
    std::array<Four, 3> du;  // by columns
    for (int c = 0; c < 3; ++c)
        du[static_cast<std::size_t>(c)] = four({at.du[0][c], at.du[1][c], at.du[2][c]}, 0);
    std::array<double, n> follows;  // of r by u_j, but for a change of a
    std::array<Four, n> gradient;   // with what the volume's row has of `follows`, in terms of the viscosity
    for (std::size_t j = 0; j < n; ++j) {
        follows[j] = density * (at.means.value[j] * cell.per_time + at.along[j]);
        gradient[j] = four(at.gradient[j], tau * follows[j] / cell.viscosity);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& gi = at.gradient[i];
        const double weight = tau * density * at.along[i];
        const Vec3 viscous = volume * cell.viscosity * gi, steered = volume * tau * gi;
        const Four compressed = four(volume * at.tau.volume * gi, expands ? 0 : volume * at.means.value[i]);
        const Four terms = expands ? four({1, 1, 1}, cell.in_terms[i]) : Four(1);
        const auto in_terms = [&](const Four& column) { return expands ? terms * column : column; };
        const Vec3 turned = newton * tau * (gi.x * at.du[0] + gi.y * at.du[1] + gi.z * at.du[2]);
        const Four turning = turns ? volume * tau * density * four(at.residual, 0) : Four(0);
        const Four pushed = four(-volume * gi, 0), along = volume * weight * four({1, 1, 1}, 0);
        for (std::size_t j = 0; j < n; ++j) {
            const Vec3& gj = at.gradient[j];
            const double product = at.means.product[i][j], value = at.means.value[j];
            const double same = volume * (density * (product * cell.per_time + dot(at.carried[i], gj)) +
                                          weight * follows[j]) + dot(viscous, gj);
            const Four bent = newton * (product + weight * value);
            double* const block = blocks.block(i, j);
            for (int c = 0; c < 3; ++c) {
                const auto column = static_cast<std::size_t>(c);
                const double passed = expands ? volume * value * gi[c] : 0;
                const double dilates = expands ? gj[c] + value * at.thins[c] : gj[c];
                put<add>(in_terms(bent * du[column] + Four(viscous[c]) * gradient[j] + Four(dilates) * compressed +
                                  Four(same) * unit[column] + Four(value * gi[c]) * turning +
                                  four({}, value * turned[c] - passed)),
                         block + block_size * column);
            }
            put<add>(in_terms(along * gradient[j] + Four(value) * pushed + four({}, dot(steered, gj))),
                     block + block_size * 3);
        }
    }
}

/// An open facet of a tet, opposite `corner`: the transposed gradient has no part in what is given. As div u
/// = 0, that part, (grad u)^T n - (div u) n, is of derivatives along the facet alone, and symmetric.
void add_open_facet(const FlowStage& stage, const FlowCell<4>& cell, const CellPoint<4>& at,
                    std::size_t corner, const Array<Vertex, double>& pressure, bool derivative,
                    CellBlocks<4>& blocks) {
    const Vec3 area = -3 * at.volume_gradient[corner];  // out of the domain
    std::array<Vec3, 4> gradient;
    Matrix3<double> du = {};
    for (std::size_t j = 0; j < 4; ++j) {
        gradient[j] = at.volume_gradient[j] / at.volume;
        for (int m = 0; m < 3; ++m) du[static_cast<std::size_t>(m)] += cell.velocity[j][m] * gradient[j];
    }
    double sum = 0;
    for (int c : tet_facets[corner])
        if (!pressure.empty()) sum += pressure[cell.vertex[static_cast<std::size_t>(c)]];
    const Vec3 transposed =
        area.x * du[0] + area.y * du[1] + area.z * du[2] - (du[0].x + du[1].y + du[2].z) * area;
    for (int local : tet_facets[corner]) {
        const auto i = static_cast<std::size_t>(local);
        const double given = pressure.empty() ? 0 : (sum + pressure[cell.vertex[i]]) / 12;
        const double back = stage.convection ? std::min(dot(cell.velocity[i], area), 0.0) : 0;
        const Vec3 more =
            given * area - (cell.viscosity / 3) * transposed - (cell.density * back / 6) * cell.velocity[i];
        for (int m = 0; m < 3; ++m) blocks.residual[block_size * i + static_cast<std::size_t>(m)] += more[m];
        if (!derivative) continue;
        for (std::size_t m = 0; m < 3; ++m) blocks.block(i, i)[block_size * m + m] -= cell.density * back / 6;
        for (std::size_t j = 0; j < 4; ++j)
            for (int c = 0; c < 3; ++c)
                for (int m = 0; m < 3; ++m)
                    blocks.block(i, j)[static_cast<std::size_t>(4 * c + m)] -=
                        cell.viscosity / 3 * (area[c] * gradient[j][m] - area[m] * gradient[j][c]);
    }
}

/// What passes a facet of a tet on a face of the box, opposite `corner`, where the density is of the temperature.
void add_passing(const FlowCell<4>& cell, const CellPoint<4>& at, std::size_t corner, bool derivative,
                 CellBlocks<4>& blocks) {
    const Vec3 area = -3 * at.volume_gradient[corner];  // out of the domain
    Vec3 sum;
    for (int c : tet_facets[corner]) sum += cell.velocity[static_cast<std::size_t>(c)];
    for (int row : tet_facets[corner]) {
        const auto i = static_cast<std::size_t>(row);
        blocks.residual[block_size * i + 3] += dot(area, cell.velocity[i] + sum) / 12;
        if (!derivative) continue;
        for (int column : tet_facets[corner]) {
            const auto j = static_cast<std::size_t>(column);
            for (std::size_t c = 0; c < 3; ++c)
                blocks.block(i, j)[block_size * c + 3] += (i == j ? 2 : 1) * area[static_cast<int>(c)] / 12;
        }
    }
}

/// What passes the facets of a tet on faces of the box, and what acts on those that are open.
void add_facets(const FlowStage& stage, Tet t, const FlowCell<4>& cell, bool derivative, CellBlocks<4>& blocks) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const Patch patch = stage.mesh.patch[t][corner];
        if (!patch.exists() || patch.value >= box_faces) continue;
        const auto face = static_cast<std::size_t>(patch.value);
        if (!cell.expands && !stage.open[face]) continue;
        const CellPoint<4> at = linear_tet(cell.x);
        if (cell.expands) add_passing(cell, at, corner, derivative, blocks);
        if (stage.open[face]) add_open_facet(stage, cell, at, corner, stage.open_pressure[face], derivative, blocks);
    }
}

template <std::size_t n>
void add_cell_points(const FlowCell<n>& cell, bool derivative, CellBlocks<n>& blocks) {
    const CellPoints<n> points = cell_points(cell.x);
    blocks.residual.fill(0);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const FlowPoint<n> point = flow_point(cell, points[k], k);
        add_residual(cell, point, blocks.residual);
        if (!derivative) continue;
        if (cell.expands) {
            if (k == 0) put_derivative<false, true>(cell, point, blocks);
            else put_derivative<true, true>(cell, point, blocks);
        } else {
            if (k == 0) put_derivative<false, false>(cell, point, blocks);
            else put_derivative<true, false>(cell, point, blocks);
        }
    }
}

using FourTets = std::array<FlowCell<4>, 4>;

/// Of which none expands.
FlowCell<4, Four> four_of(const FourTets& cells) {
    const auto numbers = [&](const auto& of) { return Four(Four::Register{of(cells[0]), of(cells[1]), of(cells[2]), of(cells[3])}); };
    return {.x = places_together(cells, [](const auto& cell) -> auto& { return cell.x; }),
            .vertex = {},
            .velocity = places_together(cells, [](const auto& cell) -> auto& { return cell.velocity; }),
            .carrying = places_together(cells, [](const auto& cell) -> auto& { return cell.carrying; }),
            .inertia = places_together(cells, [](const auto& cell) -> auto& { return cell.inertia; }),
            .pressure = together(cells, [](const auto& cell) -> auto& { return cell.pressure; }),
            .density = numbers([](const auto& cell) { return cell.density; }),
            .viscosity = numbers([](const auto& cell) { return cell.viscosity; }),
            .per_time = cells[0].per_time,
            .convection = cells[0].convection,
            .expands = false,
            .passing = {},
            .in_terms = {},
            .densities = {},
            .density_rate = 0};
}

template <std::size_t n, class Name>
CrossingRates most_crossed(const FlowStage& stage, const Name& name) {
    const auto vertices = cell_vertices(stage.mesh, name);
    const CellPoints<n> points = cell_points(corners(stage.position, stage.mesh, name));
    const Corners<n> flows = stage.convection ? at_corners(stage.guess.velocity, vertices) : Corners<n>{};
    const Corners<n> goes = at_corners(stage.mesh_velocity, vertices);
    CrossingRates most{0, 0};
    for (std::size_t k = 0; k < points.size(); ++k) {
        Corners<n> gradient;
        for (std::size_t i = 0; i < n; ++i) gradient[i] = points[k].volume_gradient[i] / points[k].volume;
        const Vec3 flow = mean_value(k, flows), past = flow - mean_value(k, goes);
        for (const Vec3& g : directions(gradient).gradient) {
            most.standing = std::max(most.standing, std::abs(dot(flow, g)));
            most.going = std::max(most.going, std::abs(dot(past, g)));
        }
    }
    return most;
}

}  // namespace

KROPLA_FOR_EACH_PROCESSOR KROPLA_WITH_ITS_CALLS
void flow_cell(const FlowStage& stage, Tet t, bool derivative, CellBlocks<4>& blocks) {
    const FlowCell<4> cell = gather<4>(stage, t);
    add_cell_points<4>(cell, derivative, blocks);
    add_facets(stage, t, cell, derivative, blocks);
}

KROPLA_FOR_EACH_PROCESSOR KROPLA_WITH_ITS_CALLS
void flow_cell(const FlowStage& stage, const Prism& prism, bool derivative, CellBlocks<6>& blocks) {
    add_cell_points<6>(gather<6>(stage, prism), derivative, blocks);
}

KROPLA_FOR_EACH_PROCESSOR KROPLA_WITH_ITS_CALLS
void flow_residuals(const FlowStage& stage, const std::array<Tet, 4>& tets, std::array<CellBlocks<4>, 4>& blocks) {
    const FourTets cells = {gather<4>(stage, tets[0]), gather<4>(stage, tets[1]), gather<4>(stage, tets[2]),
                            gather<4>(stage, tets[3])};
    if (std::ranges::any_of(cells, [](const FlowCell<4>& cell) { return cell.expands; })) {
        for (std::size_t which = 0; which < 4; ++which) add_cell_points<4>(cells[which], false, blocks[which]);
    } else {
        const FlowCell<4, Four> all = four_of(cells);
        std::array<Four, block_size * 4> residual = {};
        add_residual(all, flow_point(all, linear_tet(all.x), 0), residual);
        for (std::size_t which = 0; which < 4; ++which)
            for (std::size_t i = 0; i < residual.size(); ++i) blocks[which].residual[i] = residual[i][which];
    }
    for (std::size_t which = 0; which < 4; ++which) add_facets(stage, tets[which], cells[which], false, blocks[which]);
}

CrossingRates crossing_rates(const FlowStage& stage, Tet t) { return most_crossed<4>(stage, t); }
CrossingRates crossing_rates(const FlowStage& stage, const Prism& prism) { return most_crossed<6>(stage, prism); }

}  // namespace kropla
