// What a cell, a tet or a prism, adds to a stage of a flow's step. With a = u - w and the residual of momentum
// r = rho (du/dt + a.grad u) - f + grad p (without viscosity: linear tets have none within them, prisms next to none)
//     momentum i:  integral(phi_i (rho (du/dt + a.grad u) - f) + sigma.grad phi_i)
//                  + integral(tau_M rho a.grad phi_i r) + integral(tau_C div u grad phi_i),
//     volume i:    integral(phi_i div u) + integral(tau_M grad phi_i.r).
//   [Brooks, Hughes 1982] Streamline upwind/Petrov-Galerkin formulations. CMAME 32.
//   [Hughes, Franca, Balestra 1986] A new finite element formulation for computational fluid dynamics: V. CMAME 59: PSPG.
//   [Bazilevs, Calo, Cottrell, Hughes, Reali, Scovazzi 2007] Variational multiscale residual-based turbulence modeling.
//     CMAME 197: tau_M = (4/dt^2 + a.G.a + 36 nu^2 G:G)^(-1/2) / rho and tau_C = 1 / (tau_M tr G), G the metric tensor of the
//     cell, without the terms of second order in the unresolved velocity.
//   [Bazilevs, Gohean, Hughes, Moser, Zhang 2009] Patient-specific isogeometric fluid-structure interaction analysis.
//     CMAME 198: an open boundary takes -rho/2 (u.n)_- u where the flow comes back.
//   [Heywood, Rannacher, Turek 1996] Artificial boundaries and flux and pressure conditions. Int. J. Numer. Methods
//     Fluids 22: there mu du/dn - p n is given rather than the traction, so that a developed flow goes out as it is.
// G of a tet is the mean over the four corners that the reference tet may begin at, so that it does not depend on their
// order; likewise over the three of a prism's triangle, with its height from -1 to 1.
#include "simulate/flow_cell.h"

#include <kropla/mesh/cells.h>

#include <cmath>

namespace kropla {
namespace {

using Matrix3 = std::array<Vec3, 3>;  // by rows

template <std::size_t n>
struct FlowCell {
    Corners<n> x;
    std::array<Vertex, n> vertex;
    std::array<Vec3, n> velocity, carrying, rate, force;  // carrying: a
    std::array<double, n> pressure;
    double density, viscosity, per_time;
    bool convection;
};

template <std::size_t n>
double mean_at(const Array<Vertex, double>& values, const std::array<Vertex, n>& vertices) {
    double sum = 0;
    for (Vertex v : vertices) sum += values[v];
    return sum / static_cast<double>(n);
}

template <std::size_t n, class Name>
FlowCell<n> gather(const FlowStage& stage, const Name& name) {
    FlowCell<n> cell;
    cell.vertex = cell_vertices(stage.mesh, name);
    const FlowMaterial& material = stage.material[cell_region(stage.mesh, name)];
    const bool varies = !material.densities.empty();
    cell.density = varies ? mean_at(material.densities, cell.vertex) : material.density;
    cell.viscosity =
        material.viscosities.empty() ? material.viscosity : mean_at(material.viscosities, cell.vertex);
    cell.per_time = stage.per_time;
    cell.convection = stage.convection;
    for (std::size_t i = 0; i < n; ++i) {
        const Vertex v = cell.vertex[i];
        cell.x[i] = stage.position[v];
        const Vec3 u = stage.guess.velocity[v];
        cell.velocity[i] = u;
        cell.pressure[i] = stage.guess.pressure[v];
        cell.carrying[i] = stage.convection ? u : Vec3{};
        if (!stage.mesh_velocity.empty()) cell.carrying[i] -= stage.mesh_velocity[v];
        cell.rate[i] = stage.per_time > 0 ? stage.per_time * (u - stage.old[v]) : Vec3{};
        cell.force[i] = (varies ? material.densities[v] : cell.density) * stage.gravity;
        if (!material.force.empty()) cell.force[i] += material.force[v];
    }
    return cell;
}

/// The gradients of the coordinates of the reference cell, with the weights of their squares in the metric tensor.
template <std::size_t n>
struct Directions {
    static constexpr std::size_t count = 4;
    std::array<Vec3, count> gradient;  // [1/m]
    static constexpr std::array<double, count> weight = n == 4 ? std::array<double, 4>{0.75, 0.75, 0.75, 0.75}
                                                               : std::array<double, 4>{2.0 / 3, 2.0 / 3, 2.0 / 3, 4};
};

Directions<4> directions(const std::array<Vec3, 4>& gradient) { return {gradient}; }

Directions<6> directions(const std::array<Vec3, 6>& gradient) {
    return {{gradient[0] + gradient[3], gradient[1] + gradient[4], gradient[2] + gradient[5],
             gradient[3] + gradient[4] + gradient[5]}};
}

struct Times {
    double momentum;  // tau_M [m^3 s/kg]
    double volume;    // tau_C [Pa s]
};

template <std::size_t n>
Times intrinsic_times(const FlowCell<n>& cell, const Directions<n>& of, const Vec3& carrying) {
    double crossing = 0, trace = 0, squares = 0;  // a.G.a, tr G, G:G
    for (std::size_t c = 0; c < of.count; ++c) {
        const double across = dot(carrying, of.gradient[c]);
        crossing += of.weight[c] * across * across;
        trace += of.weight[c] * squared_norm(of.gradient[c]);
        for (std::size_t d = 0; d < of.count; ++d) {
            const double product = dot(of.gradient[c], of.gradient[d]);
            squares += of.weight[c] * of.weight[d] * product * product;
        }
    }
    const double kinematic = cell.viscosity / cell.density;
    const double momentum = 1 / (std::sqrt(4 * cell.per_time * cell.per_time + crossing +
                                           36 * kinematic * kinematic * squares) * cell.density);
    return {momentum, 1 / (momentum * trace)};
}

/// What is known at a point of a cell, for the part of it that the point stands for.
template <std::size_t n>
struct FlowPoint {
    double volume;
    const ShapeMeans<n>& means;
    std::array<Vec3, n> gradient;  // of phi_i
    Matrix3 du;                    // row m: grad u_m
    Vec3 dp, residual;             // grad p, r
    double divergence, pressure;
    Times tau;
    std::array<Vec3, n> carried;   // mean of phi_i a
    std::array<double, n> along;   // mean a.grad phi_i
};

template <std::size_t n>
FlowPoint<n> flow_point(const FlowCell<n>& cell, const CellPoint<n>& at, std::size_t k) {
    FlowPoint<n> point{at.volume, shape_means<n>[k], {}, {}, {}, {}, 0, 0, {}, {}, {}};
    Vec3 carrying, rate, force;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 g = point.gradient[i] = (1 / at.volume) * at.volume_gradient[i];
        for (int m = 0; m < 3; ++m) point.du[static_cast<std::size_t>(m)] += cell.velocity[i][m] * g;
        const double value = point.means.value[i];
        point.dp += cell.pressure[i] * g;
        point.pressure += value * cell.pressure[i];
        carrying += value * cell.carrying[i];
        rate += value * cell.rate[i];
        force += value * cell.force[i];
    }
    point.divergence = point.du[0].x + point.du[1].y + point.du[2].z;
    const Vec3 convected{dot(carrying, point.du[0]), dot(carrying, point.du[1]), dot(carrying, point.du[2])};
    point.residual = cell.density * (rate + convected) - force + point.dp;
    point.tau = intrinsic_times(cell, directions(point.gradient), carrying);
    for (std::size_t i = 0; i < n; ++i) {
        point.along[i] = dot(carrying, point.gradient[i]);
        for (std::size_t j = 0; j < n; ++j) point.carried[i] += point.means.product[i][j] * cell.carrying[j];
    }
    return point;
}

template <std::size_t n>
void add_residual(const FlowCell<n>& cell, const FlowPoint<n>& at, std::array<double, block_size * n>& residual) {
    const Matrix3& du = at.du;
    const double isotropic = at.tau.volume * at.divergence - at.pressure;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& g = at.gradient[i];
        Vec3 inertia, force;
        for (std::size_t j = 0; j < n; ++j) {
            inertia += at.means.product[i][j] * cell.rate[j];
            force += at.means.product[i][j] * cell.force[j];
        }
        inertia += Vec3{dot(at.carried[i], du[0]), dot(at.carried[i], du[1]), dot(at.carried[i], du[2])};
        const Vec3 sheared = Vec3{dot(du[0], g), dot(du[1], g), dot(du[2], g)} + g.x * Vec3{du[0].x, du[0].y, du[0].z} +
                             g.y * Vec3{du[1].x, du[1].y, du[1].z} + g.z * Vec3{du[2].x, du[2].y, du[2].z};
        const Vec3 sum = cell.density * inertia - force + cell.viscosity * sheared + isotropic * g +
                         at.tau.momentum * cell.density * at.along[i] * at.residual;
        for (int m = 0; m < 3; ++m) residual[block_size * i + static_cast<std::size_t>(m)] += at.volume * sum[m];
        residual[block_size * i + 3] +=
            at.volume * (at.means.value[i] * at.divergence + at.tau.momentum * dot(g, at.residual));
    }
}

/// The derivative; tau and the weight of SUPG are taken as they are.
template <std::size_t n>
void add_derivative(const FlowCell<n>& cell, const FlowPoint<n>& at, CellBlocks<n>& blocks) {
    const double density = cell.density, volume = at.volume, tau = at.tau.momentum;
    std::array<double, n> follows;  // of r by u_j, but for a change of a
    for (std::size_t j = 0; j < n; ++j) follows[j] = density * (at.means.value[j] * cell.per_time + at.along[j]);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& gi = at.gradient[i];
        const double weight = tau * density * at.along[i];
        const Vec3 turned = cell.convection ? density * (gi.x * at.du[0] + gi.y * at.du[1] + gi.z * at.du[2]) : Vec3{};
        const Vec3 viscous = volume * cell.viscosity * gi, compressed = volume * at.tau.volume * gi;
        const Vec3 pushed = volume * gi, steered = volume * tau * gi;
        for (std::size_t j = 0; j < n; ++j) {
            const Vec3& gj = at.gradient[j];
            const double product = at.means.product[i][j], value = at.means.value[j];
            const double same = volume * (density * (product * cell.per_time + dot(at.carried[i], gj)) +
                                          weight * follows[j]) + dot(viscous, gj);
            const double bent = cell.convection ? volume * density * (product + tau * at.along[i] * density * value) : 0;
            double* const block = blocks.block(i, j);
            for (int c = 0; c < 3; ++c) {
                double* const column = block + block_size * static_cast<std::size_t>(c);
                for (int m = 0; m < 3; ++m)
                    column[m] += bent * at.du[static_cast<std::size_t>(m)][c] + viscous[c] * gj[m] +
                                 compressed[m] * gj[c];
                column[c] += same;
                column[3] += volume * at.means.value[i] * gj[c] +
                             volume * tau * (follows[j] * gi[c] + value * turned[c]);
            }
            double* const column = block + block_size * 3;
            for (int m = 0; m < 3; ++m) column[m] += volume * weight * gj[m] - value * pushed[m];
            column[3] += dot(steered, gj);
        }
    }
}

/// An open facet of a tet, opposite `corner`. On one viscosity, the transposed gradient has no part in what is given.
void add_open_facet(const FlowStage& stage, const FlowCell<4>& cell, const CellPoint<4>& at, std::size_t corner,
                    const Array<Vertex, double>& pressure, bool derivative, CellBlocks<4>& blocks) {
    const Vec3 area = -3 * at.volume_gradient[corner];  // out of the domain
    std::array<Vec3, 4> gradient;
    Matrix3 du = {};
    for (std::size_t j = 0; j < 4; ++j) {
        gradient[j] = at.volume_gradient[j] / at.volume;
        for (int m = 0; m < 3; ++m) du[static_cast<std::size_t>(m)] += cell.velocity[j][m] * gradient[j];
    }
    double sum = 0;
    for (int c : tet_facets[corner])
        if (!pressure.empty()) sum += pressure[cell.vertex[static_cast<std::size_t>(c)]];
    const Vec3 transposed = area.x * du[0] + area.y * du[1] + area.z * du[2];  // (grad u)^T as it acts on the area
    for (int local : tet_facets[corner]) {
        const auto i = static_cast<std::size_t>(local);
        const double given = pressure.empty() ? 0 : (sum + pressure[cell.vertex[i]]) / 12;
        const double back = stage.convection ? std::min(dot(cell.velocity[i], area), 0.0) : 0;
        const Vec3 more = given * area - (cell.viscosity / 3) * transposed - (cell.density * back / 6) * cell.velocity[i];
        for (int m = 0; m < 3; ++m) blocks.residual[block_size * i + static_cast<std::size_t>(m)] += more[m];
        if (!derivative) continue;
        for (std::size_t m = 0; m < 3; ++m) blocks.block(i, i)[block_size * m + m] -= cell.density * back / 6;
        for (std::size_t j = 0; j < 4; ++j)
            for (int c = 0; c < 3; ++c)
                for (int m = 0; m < 3; ++m)
                    blocks.block(i, j)[block_size * static_cast<std::size_t>(c) + static_cast<std::size_t>(m)] -=
                        cell.viscosity / 3 * area[c] * gradient[j][m];
    }
}

template <std::size_t n, class Name>
void add_cell_points(const FlowStage& stage, const Name& name, bool derivative, CellBlocks<n>& blocks) {
    const FlowCell<n> cell = gather<n>(stage, name);
    const CellPoints<n> points = cell_points(cell.x);
    blocks.residual.fill(0);
    if (derivative) blocks.matrix.fill(0);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const FlowPoint<n> point = flow_point(cell, points[k], k);
        add_residual(cell, point, blocks.residual);
        if (derivative) add_derivative(cell, point, blocks);
    }
    if constexpr (n == 4) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Patch patch = stage.mesh.patch[name][corner];
            if (!patch.exists() || patch.value >= box_faces || !stage.open[static_cast<std::size_t>(patch.value)]) continue;
            add_open_facet(stage, cell, points[0], corner, stage.open_pressure[static_cast<std::size_t>(patch.value)],
                           derivative, blocks);
        }
    }
}

template <std::size_t n, class Name>
double most_crossed(const FlowStage& stage, const Name& name) {
    const FlowCell<n> cell = gather<n>(stage, name);
    const CellPoints<n> points = cell_points(cell.x);
    double most = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        std::array<Vec3, n> gradient;
        for (std::size_t i = 0; i < n; ++i) gradient[i] = points[k].volume_gradient[i] / points[k].volume;
        const Vec3 carrying = mean_value(k, cell.carrying);
        for (const Vec3& g : directions(gradient).gradient) most = std::max(most, std::abs(dot(carrying, g)));
    }
    return most;
}

}  // namespace

void flow_cell(const FlowStage& stage, Tet t, bool derivative, CellBlocks<4>& blocks) {
    add_cell_points<4>(stage, t, derivative, blocks);
}

void flow_cell(const FlowStage& stage, const Prism& prism, bool derivative, CellBlocks<6>& blocks) {
    add_cell_points<6>(stage, prism, derivative, blocks);
}

double crossing_rate(const FlowStage& stage, Tet t) { return most_crossed<4>(stage, t); }
double crossing_rate(const FlowStage& stage, const Prism& prism) { return most_crossed<6>(stage, prism); }

}  // namespace kropla
