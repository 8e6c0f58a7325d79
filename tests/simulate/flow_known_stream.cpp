// A sphere that is held in a uniform stream.
//   References are of an axisymmetric solution by vorticity and stream function on grids of 160^2 and 320^2, extrapolated,
//   out to 150 radii: drag to 0.0005, angle to 0.1 degrees, wake to 0.001, Nusselt number to 0.002.
//   [Fornberg 1988] Steady viscous flow past a sphere at high Reynolds numbers. J. Fluid Mech. 190: 1.0852 at 100.
#include "flow_known.h"

#include "flow_problems.h"

#include <kropla/mesh/cells.h>
#include <kropla/mesh/prisms.h>
#include <kropla/simulate/heat.h>
#include <kropla/step/initial_mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr double radius = 0.5, prandtl = 0.7;

/// The sphere in a wide box, its wake finer than what is beside it.
Mesh sphere_in_wide_box(int fineness) {
    const double size = fineness == 1 ? 0.14 : 0.05, growth = fineness == 1 ? 0.25 : 0.11, half = 16;
    Domain domain{.box = {{-half, -half, -half}, {half, half, 2 * half}}, .bodies = {}, .size = {}};
    domain.bodies.push_back({.name = "sphere",
                             .shape = {.centre = {}, .semi_axes = {radius, radius, radius}, .orientation = {}},
                             .layer = LayerOptions{.count = 4, .first_height = 0.3 * size}});
    domain.size = {.surface = size, .growth = growth, .far = half / 4};
    return initial_mesh(domain, 1);
}

/// The velocity along z at a height on the axis; nothing where no tet is.
std::optional<double> on_axis(const Mesh& mesh, const Array<Vertex, Vec3>& velocity, const std::vector<Tet>& near, double z) {
    const Vec3 place{1e-6, 2e-6, z};
    for (Tet t : near) {
        const auto& v = mesh.tets[t];
        std::array<Vec3, 4> x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = mesh.position[v[i]];
        const double all = determinant(x[1] - x[0], x[2] - x[0], x[3] - x[0]);
        double value = 0, least = 1;
        for (std::size_t i = 0; i < 4; ++i) {
            auto with = x;
            with[i] = place;
            const double share = determinant(with[1] - with[0], with[2] - with[0], with[3] - with[0]) / all;
            least = std::min(least, share);
            value += share * velocity[v[i]].z;
        }
        if (least >= -1e-9) return value;
    }
    return {};
}

/// From the sphere's rear to where the flow on the axis no longer comes back, in diameters; 0: nowhere.
double wake_length(const Mesh& mesh, const Array<Vertex, Vec3>& velocity) {
    std::vector<Tet> near;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t) || mesh.region[t] != Region(0)) continue;
        Vec3 least{INFINITY, INFINITY, INFINITY}, most = -1.0 * least;
        for (Vertex v : mesh.tets[t])
            for (int axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], mesh.position[v][axis]);
                most[axis] = std::max(most[axis], mesh.position[v][axis]);
            }
        if (least.x <= 1e-5 && most.x >= 0 && least.y <= 1e-5 && most.y >= 0 && most.z > 0) near.push_back(t);
    }
    double end = radius, last = 0;
    for (double z = 4 * radius + 3; z > radius; z -= 0.005) {
        const std::optional<double> u = on_axis(mesh, velocity, near, z);
        if (!u) continue;
        if (*u < 0) {
            end = z + 0.005 * *u / (*u - last);
            break;
        }
        last = *u;
    }
    return (end - radius) / (2 * radius);
}

/// Where the shear at the surface changes its sign, in degrees from the front; 180: nowhere. Of a parabola through the wall
/// and the two vertices above it, and a line by angles near there.
double separation_angle(const Mesh& mesh, const Array<Vertex, Vec3>& velocity) {
    const PrismLayer& layer = mesh.layers[0];
    std::vector<std::pair<double, double>> shear;  // by angle
    for (int column = 0; column < count_columns(layer); ++column) {
        const Vec3 wall = mesh.position[column_vertex(layer, column, 0)], out = wall / norm(wall);
        const double angle = std::acos(std::clamp(-out.z, -1.0, 1.0)), sine = std::sin(angle);
        if (sine < 0.05) continue;
        const Vec3 along = (1 / sine) * (Vec3{0, 0, 1} - out.z * out);  // downstream
        std::array<double, 2> height, speed;
        for (int k : {0, 1}) {
            const Vertex v = column_vertex(layer, column, k + 1);
            height[as_size(k)] = norm(mesh.position[v] - wall);
            speed[as_size(k)] = dot(velocity[v], along);
        }
        shear.emplace_back(angle * 180 / pi, (speed[0] * height[1] / height[0] - speed[1] * height[0] / height[1]) /
                                                 (height[1] - height[0]));
    }
    double angle = 180;
    for (int pass = 0; pass < 4; ++pass) {  // the line's zero, and again around it
        const double width = pass == 0 ? 60 : 6;
        const double middle = pass == 0 ? 130 : angle;
        double n = 0, x = 0, y = 0, xx = 0, xy = 0;
        for (const auto& [at, value] : shear) {
            if (std::abs(at - middle) > width) continue;
            n += 1, x += at, y += value, xx += at * at, xy += at * value;
        }
        const double slope = (n * xy - x * y) / (n * xx - x * x);
        angle = std::clamp((slope * x - y) / (n * slope), 90.0, 175.0);
    }
    return angle;
}

/// Of the sphere at 1 K in a stream at 0.
double nusselt_number(const Ranks& ranks, const Mesh& mesh, const Array<Vertex, Vec3>& velocity, double viscosity) {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    const double conductivity = viscosity / prandtl;
    options.regions[0].material.conductivity = conductivity;
    options.regions[1].carried = Carried::with_mesh;
    options.regions[1].held = 1;
    for (std::size_t face = 0; face < 5; ++face)
        options.faces[face] = {HeatFace::Kind::value, [](const Vec3&, double) { return 0.0; }};
    NodalField temperature{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 0.0)};
    const MaterialFlow flow = material_flow(ranks, mesh, mesh, {Region(0)}, 1e6, {.velocity = velocity});
    const HeatReport report = step_heat(ranks, mesh, mesh, options, flow, temperature, 0, 1e6);
    return report.surfaces[0].total / (pi * conductivity);
}

}  // namespace

Outcome sphere_in_stream(const Ranks& ranks, const KnownStream& known, int fineness) {
    const Mesh mesh = sphere_in_wide_box(fineness);
    const double viscosity = 1 / known.reynolds;
    FlowOptions options{.regions = {FlowRegion{.density = 1, .viscosity = viscosity}, {}}};
    options.faces.fill({.kind = FlowFace::Kind::velocity,
                        .velocity = {Quantity{}, Quantity{}, [](const Vec3&, double) { return 1.0; }}});
    options.faces[5] = {.kind = FlowFace::Kind::open};
    FlowState state = still_flow(mesh);
    options.scheme = FlowScheme::first_order;  // towards the steady state: from rest it is far
    for (const double dt : {0.5, 2.0, 8.0}) step_flow(ranks, mesh, mesh, options, state, 0, dt);
    options.scheme = FlowScheme::steady;
    options.tolerance = 1e-4;
    const FlowReport report = step_flow(ranks, mesh, mesh, options, state, 0, 1);
    Outcome outcome{.mesh = in_words(mesh),
                    .steps = "three of first order, one steady",
                    .reached = {{"drag coefficient [-]", known.drag, report.bodies[0].force.z / (0.5 * pi * radius * radius)}},
                    .passes = report.passes};
    if (known.wake > 0) {
        outcome.reached.push_back({"wake by diameter [-]", known.wake, wake_length(mesh, state.velocity)});
        outcome.reached.push_back({"separation [degrees]", known.angle, separation_angle(mesh, state.velocity)});
    }
    outcome.reached.push_back({"Nusselt number, Pr 0.7 [-]", known.nusselt, nusselt_number(ranks, mesh, state.velocity, viscosity)});
    return outcome;
}

}  // namespace kropla
