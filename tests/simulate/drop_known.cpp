// Liquid spheres in viscous liquids.
//   [Happel, Brenner 1965] Low Reynolds number hydrodynamics: between concentric spheres the stream function outside is
//     (A/r + B r + C r^2 + D r^4) sin^2, inside (E r^2 + F r^4) sin^2; the drag is 4/3 B.
//   [Bart 1968] The slow unsteady settling of a fluid sphere toward a flat fluid interface. Chem. Eng. Sci. 23: before a
//     floor, series in bispherical coordinates.
// In a stream: an axisymmetric solution by vorticity and stream function inside and outside, on two grids, extrapolated.
#include "drop_known.h"

#include "flow_problems.h"
#include "simulate/elements.h"
#include "simulate/tension.h"
#include <kropla/step/initial_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr Region of_drop{1};

/// A drop in a liquid of 1 Pa s, both without inertia.
FlowOptions slow_drop(double viscosity) {
    return {.regions = {FlowRegion{.density = 1, .viscosity = 1}, FlowRegion{.density = 1, .viscosity = viscosity}},
            .convection = false, .tolerance = 1e-7};
}

double volume_of(const Mesh& mesh) {
    double volume = 0;
    for_each_share(mesh, living_cells(mesh, of_drop), [&](const auto&, Vertex, double share) { volume += share; });
    return volume;
}

/// How fast the sphere through the surface's vertices goes along z: by their normals. The liquid's mean has more, of what flows
/// along the surface, and through facets between its vertices.
double velocity_of_surface(const Mesh& mesh, const FlowState& state) {
    const auto facets = region_surface(mesh, of_drop).interface;
    const std::vector<Vertex> vertices = vertices_of(facets);
    const std::vector<Vec3> normals = surface_normals(facets, vertices, mesh.position);
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        sum += dot(state.velocity[vertices[i]], normals[i]) * normals[i].z;
        all += normals[i].z * normals[i].z;
    }
    return sum / all;
}

/// The drop with prisms around it, in this box.
Mesh drop_in_box(double radius, const Box& box, const SizeField& size, int prisms) {
    Domain domain{.box = box, .bodies = {}, .size = size};
    domain.bodies.push_back({.name = "drop",
                             .shape = {.centre = {}, .semi_axes = {radius, radius, radius}, .orientation = {}},
                             .layer = LayerOptions{.count = prisms, .first_height = 0.3 * size.surface}});
    return initial_mesh(domain, 1);
}

/// The largest velocity of the drop's surface, in the mean over rings around z that are six degrees wide.
double fastest_ring(const Mesh& mesh, const FlowState& state) {
    std::array<double, 30> sum = {}, count = {};
    for (Vertex v : vertices_of(region_surface(mesh, of_drop).interface)) {
        const double angle = std::acos(mesh.position[v].z / norm(mesh.position[v])) / pi;
        const std::size_t ring = std::min(static_cast<std::size_t>(angle * sum.size()), sum.size() - 1);
        sum[ring] += norm(state.velocity[v]);
        count[ring] += 1;
    }
    double largest = 0;
    for (std::size_t ring = 0; ring < sum.size(); ++ring)
        if (count[ring] > 0) largest = std::max(largest, sum[ring] / count[ring]);
    return largest;
}

/// A drop on a mesh that rests, while what is around it flows by. In a long step its surface goes on until the tension [N/m]
/// holds it against the flow: slowly.
class HeldDrop {
public:
    HeldDrop(const Ranks& ranks, const Mesh& mesh, FlowOptions options, double tension)
        : state(still_flow(mesh)), ranks_(ranks), mesh_(mesh), options_(std::move(options)), tension_(tension) {
        options_.scheme = FlowScheme::first_order;
        options_.tension = {Property(tension)};
    }

    /// A step of this length [s]; returns what the flow does to the drop, along z [N].
    double step(double dt) {
        const FlowReport report = step_flow(ranks_, mesh_, mesh_, options_, state, 0, dt);
        passes = report.passes;
        return pull(report.surfaces.at(0));
    }

    FlowState state;
    int passes = 0;  // of the last step

private:
    /// What the flow has to do to a surface that goes this way, against the tension, along z [N].
    [[nodiscard]] double pull(const SurfaceCourse& course) const {
        const std::vector<double> tensions(course.vertices.size(), tension_);
        const SurfaceTension acts = surface_tension({course.body, course.facets, course.vertices, tensions}, mesh_.position);
        double sum = 0;
        for (const auto& [row, column, stiffness] : acts.bonds)
            sum += stiffness * dot(acts.normal[column], course.displacement[column]) * acts.normal[row].z;
        return sum;
    }

    const Ranks& ranks_;
    const Mesh& mesh_;
    FlowOptions options_;
    double tension_;
};

}  // namespace

Outcome drop_in_sphere(const Ranks& ranks, const SlowDrop& known, int fineness) {
    const int k = 2 * fineness;
    const Mesh mesh = sphere_in_cube(
        {.radius = 1, .half = 4, .around = 2 * k, .prisms = k, .layer = 0.3, .out = 4 * k, .round = true});
    FlowOptions options = slow_drop(known.viscosity);
    options.scheme = FlowScheme::steady;
    const double force = 6 * pi;  // [N]
    options.regions[1]->force[2] = [density = force / volume_of(mesh)](const Vec3&, double) { return density; };
    FlowState state = still_flow(mesh);
    const FlowReport report = step_flow(ranks, mesh, mesh, options, state, 0, 1);
    return {.mesh = in_words(mesh), .steps = "one, steady",
            .reached = {{"drag [-]", known.drag, force / (6 * pi * velocity_of_surface(mesh, state))}},
            .passes = report.passes};
}

Outcome drop_to_floor(const Ranks& ranks, const DropBeforeFloor& known, int fineness) {
    const double f = fineness, half = 20;
    const Mesh mesh = drop_in_box(1, {{-half, -half, -known.height}, {half, half, 2 * half - known.height}},
                                  {.surface = 0.12 / f, .growth = 0.3 / f, .far = 6 / f}, 3);
    FlowOptions options = slow_drop(known.drop.viscosity);
    options.faces.fill({.kind = FlowFace::Kind::velocity, .velocity = uniform({0, 0, 1})});  // the box comes to the drop
    HeldDrop drop(ranks, mesh, options, 1e-3);
    const double force = drop.step(1e6);
    return {.mesh = in_words(mesh), .steps = "one, of first order",
            .reached = {{"drag [-]", known.drop.drag, force / (6 * pi * (1 - velocity_of_surface(mesh, drop.state)))}},
            .passes = drop.passes};
}

Outcome drop_in_stream(const Ranks& ranks, const DropStream& known, int fineness) {
    constexpr double radius = 0.5, half = 16;
    const double size = fineness == 1 ? 0.1 : 0.042, growth = fineness == 1 ? 0.25 : 0.12;
    const Mesh mesh = drop_in_box(radius, {{-half, -half, -half}, {half, half, 2 * half}},
                                  {.surface = size, .growth = growth, .far = half / 4}, 4);
    FlowOptions options = fluid(1, 1 / known.reynolds, uniform({0, 0, 1}));
    options.regions.push_back(FlowRegion{.density = known.density, .viscosity = known.viscosity / known.reynolds});
    options.faces[5] = {.kind = FlowFace::Kind::open};
    options.tolerance = 1e-6;
    HeldDrop drop(ranks, mesh, options, 0.1);
    for (const double dt : {0.5, 2.0, 8.0}) drop.step(dt);
    const double force = drop.step(1e4), velocity = 1 - velocity_of_surface(mesh, drop.state);
    return {.mesh = in_words(mesh), .steps = "four of first order",
            .reached = {{"drag coefficient [-]", known.drag, force / (0.5 * pi * radius * radius * velocity * velocity)},
                        {"largest velocity of the surface [-]", known.surface, fastest_ring(mesh, drop.state) / velocity}},
            .passes = drop.passes};
}

}  // namespace kropla
