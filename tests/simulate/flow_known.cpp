// Spheres in viscous liquids.
//   [Happel, Brenner 1965] Low Reynolds number hydrodynamics: in a sphere, l the ratio of radii, the drag is
//     (1 - l^5) / (1 - 9/4 l + 5/2 l^3 - 9/4 l^5 + l^6).
//   [Brenner 1961] The slow motion of a sphere through a viscous fluid towards a plane surface. Chem. Eng.
//     Sci. 16.
//   [Landau, Lifshitz 1987] Fluid mechanics, 2nd ed.: section 24 (the sphere that swings).
// In closed boxes: by fundamental solutions and least squares, with Blake's images for the floor.
#include "flow_known.h"

#include "flow_problems.h"

#include <kropla/adapt/moving_mesh.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr double stokes_drag = 6 * pi;  // [N] of the sphere at 1 m/s

/// The liquid around a body, within walls.
FlowOptions around_body(double density) {
    return {.regions = {FlowRegion{.density = density, .viscosity = 1}, {}}, .convection = false,
            .tolerance = 1e-5};
}

/// On the sphere that moves by 1 m/s along z, of what lasts on this mesh.
double lasting_drag(const Ranks& ranks, const Mesh& mesh) {
    FlowOptions options = around_body(1);
    options.scheme = FlowScheme::steady;
    options.bodies.push_back([](double) { return RigidVelocity{{}, {0, 0, 1}, {}}; });
    FlowState state = still_flow(mesh);
    return -step_flow(ranks, mesh, mesh, options, state, 0, 1).bodies[0].force.z / stokes_drag;
}
Outcome lasting(const Ranks& ranks, const Mesh& mesh, double exact) {
    return {.mesh = in_words(mesh), .steps = "one, steady",
            .reached = {{"drag [-]", exact, lasting_drag(ranks, mesh)}}};
}

/// The sphere with prisms, in this box; sizes on it, and as they grow [m].
Domain sphere_in(const Box& box, const SizeField& size, const Motion& motion) {
    Domain domain{.box = box, .bodies = {}, .size = size};
    Body& sphere = domain.bodies.emplace_back();
    sphere.name = "sphere";
    sphere.shape.semi_axes = {1, 1, 1};
    sphere.motion = motion;
    sphere.layer = LayerOptions{.count = 3, .first_height = 0.3 * size.surface, .growth = 1.4};
    return domain;
}

/// A flow on a mesh that moves, carried as a run does.
class MovingFlow {
public:
    MovingFlow(const Ranks& ranks, const Domain& domain, FlowOptions options, Outcome& outcome)
        : moving(domain, initial_mesh(domain, 1), 0), state(still_flow(moving.reference())), ranks_(ranks),
          options_(std::move(options)), outcome_(outcome) {
        fields_.per_vertex(state.velocity, {.only = Region(0), .limit = false});
        fields_.per_vertex(state.pressure, {.only = Region(0), .limit = false});
        outcome_.mesh = in_words(moving.reference());
    }

    /// To `end` [s], the force on the sphere there [N].
    Vec3 step_to(double end) {
        Vec3 force;
        const auto solve = [&](const StepToSolve& step) -> Answer {
            const FlowReport report =
                step_flow(ranks_, step.before, step.current, options_, state, step.time, step.dt);
            force = report.bodies[0].force;
            outcome_.passes = std::max(outcome_.passes, report.passes);
            return Solved{};
        };
        while (moving.time() < end * (1 - 1e-9)) {
            const Advanced done = advance(moving, fields_, end - moving.time(), solve);
            if (!done.changes.cells.empty()) ++remeshed;
        }
        return force;
    }

    MovingMesh moving;
    FlowState state;
    int remeshed = 0;  // steps with new cells

private:
    const Ranks& ranks_;
    FlowOptions options_;
    Outcome& outcome_;
    Fields fields_;
};

/// The drag of a sphere that moves to a plane, its middle h radii before it [Brenner 1961].
double drag_before_plane(double h) {
    const double alpha = std::acosh(h);
    double sum = 0;
    for (int n = 1; n < 200; ++n) {
        const double m = 2 * n + 1, narrow = std::sinh(0.5 * m * alpha), wide = m * std::sinh(alpha);
        const double above = 2 * std::sinh(m * alpha) + m * std::sinh(2 * alpha);
        const double term = above / (4 * narrow * narrow - wide * wide) - 1;
        sum += n * (n + 1) / ((2.0 * n - 1) * (2 * n + 3)) * term;
        if (m * alpha > 40) break;
    }
    return 4.0 / 3 * std::sinh(alpha) * sum;
}

/// The flow around a sphere that swings with the velocity e^(i omega t) along z; nu = 1 m^2/s.
struct Swinging {
    using Complex = std::complex<double>;
    double omega;
    Complex decay = std::sqrt(Complex{0, omega});  // [1/m]

    /// u_r = f cos theta, u_theta = -(f + r f'/2) sin theta.
    [[nodiscard]] Vec3 velocity(const Vec3& x, double t) const {
        const double r = norm(x), cube = r * r * r;
        const Complex viscous = -3.0 / (decay * decay) * std::exp(-decay * (r - 1)),
                      potential = (1.0 + 3.0 / decay + 3.0 / (decay * decay)) / cube;
        const Complex f = potential + viscous * (1.0 + decay * r) / cube;
        const Complex slope =
            -3.0 * potential - viscous * (decay * decay * r * r + 3.0 * (1.0 + decay * r)) / cube;  // r f'
        const Complex turn = std::exp(Complex{0, omega * t});
        const double along = (f * turn).real(), across = ((f + 0.5 * slope) * turn).real();
        const Vec3 out = x / r;
        return across * Vec3{0, 0, 1} + (along - across) * out.z * out;
    }
    /// In 6 pi mu a, the opposite of the force.
    [[nodiscard]] Complex drag() const { return 1.0 + decay + decay * decay / 9.0; }
};

}  // namespace

Outcome drag_in_sphere(const Ranks& ranks, int fineness) {
    const int k = 2 * fineness;
    const Mesh mesh = sphere_in_cube(
        {.radius = 1, .half = 4, .around = 2 * k, .prisms = k, .layer = 0.3, .out = 4 * k, .round = true});
    return lasting(ranks, mesh, 2.10493827);
}

Outcome drag_in_cube(const Ranks& ranks, int fineness) {
    const double f = fineness;
    const Domain domain = sphere_in({{-5, -5, -5}, {5, 5, 5}},
                                    {.surface = 0.2 / f, .growth = 0.3 / f, .far = 1.2 / f},
                                    [](double) { return Pose{}; });
    return lasting(ranks, initial_mesh(domain, 1), 1.601688);
}

Outcome way_to_floor(const Ranks& ranks, int fineness) {
    Outcome outcome;
    const double f = fineness, start = fineness == 1 ? 2.1 : 4.1, each = 0.1 / f;
    Domain domain = sphere_in({{-10, -10, -start}, {10, 10, 20 - start}},
                              {.surface = 0.2 / f, .growth = 0.5 / f, .far = 4 / f},
                              [](double t) { return Pose{{0, 0, -t}, {}}; });
    domain.bodies[0].size = 0.2 / f;
    domain.bodies[0].local_size = [f](const Vec3& x) {  // half of it at the poles: the gap will be as narrow
        return std::clamp(0.05 + 0.2 * std::hypot(x.x, x.y), 0.1, 0.2) / f;
    };
    FlowOptions options = around_body(1e-6);
    options.bodies.push_back([](double t) { return RigidVelocity{{0, 0, -t}, {0, 0, -1}, {}}; });
    MovingFlow flow(ranks, domain, options, outcome);
    const int count = static_cast<int>(std::lround((start - 1.2) / each));
    std::vector<double> drags, shares;  // and the drags in those before a plane
    double by_remeshing = 0;
    for (int step = 1; step <= count; ++step) {
        drags.push_back(flow.step_to(step * each).z / stokes_drag);
        shares.push_back(drags.back() / drag_before_plane(start - step * each));
        const double after = lasting_drag(ranks, flow.moving.reference());
        by_remeshing = std::max(by_remeshing, std::abs(after / drags.back() - 1));
    }
    constexpr std::array<std::pair<double, double>, 4> exact = {
        {{4, 1.40201}, {2, 2.12976}, {1.5, 3.20759}, {1.2, 6.3422}}};
    for (const auto& [h, drag] : exact) {
        if (h > start) continue;
        const auto step = static_cast<std::size_t>(std::lround((start - h) / each));
        const std::string what = "drag, h = " + std::to_string(h).substr(0, 3) + " [-]";
        outcome.reached.push_back({what, drag, drags[step - 1]});
    }
    double jump = 0;
    for (std::size_t k = 1; k + 1 < shares.size(); ++k)
        jump = std::max(jump, std::abs(shares[k] - 0.5 * (shares[k - 1] + shares[k + 1])));
    outcome.reached.push_back({"drag off its neighbours' mean, at most [-]", 0, jump, 1});
    outcome.reached.push_back({"drag's rise by remeshing, at most [-]", 0, by_remeshing, 1});
    outcome.steps = std::to_string(count) + " equal, " + std::to_string(flow.remeshed) + " with new cells";
    return outcome;
}

Outcome swinging_sphere(const Ranks& ranks, int fineness) {
    Outcome outcome;
    const double f = fineness, amplitude = 0.02;
    const Swinging exact{10};
    const double speed = amplitude * exact.omega;
    const auto place = [=](double t) { return Vec3{0, 0, amplitude * std::sin(exact.omega * t)}; };
    const Domain domain =
        sphere_in({{-4, -4, -4}, {4, 4, 4}}, {.surface = 0.25 / f, .growth = 0.3 / f, .far = 1.2 / f},
                  [=](double t) { return Pose{place(t), {}}; });
    FlowOptions options = around_body(1);
    const auto velocity = [=](const Vec3& x, double t) { return speed * exact.velocity(x - place(t), t); };
    options.faces.fill({.kind = FlowFace::Kind::velocity, .velocity = velocity_of(velocity)});
    options.bodies.push_back([=](double t) {
        return RigidVelocity{place(t), {0, 0, speed * std::cos(exact.omega * t)}, {}};
    });
    MovingFlow flow(ranks, domain, options, outcome);
    const Mesh& mesh = flow.moving.reference();
    const Array<Vertex, char> of_liquid = vertices_of(mesh, Region(0));
    for (Vertex v : mesh.position.indices())
        if (of_liquid[v]) flow.state.velocity[v] = velocity(mesh.position[v], 0);
    const int count = 16 * fineness;
    std::complex<double> drag = 0;
    for (int step = 1; step <= 2 * count; ++step) {
        const double phase = 2 * pi * step / count;
        const double force = flow.step_to(phase / exact.omega).z / (stokes_drag * speed);
        if (step > count) drag -= 2.0 / count * force * std::polar(1.0, -phase);
    }
    outcome.reached.push_back({"in phase [-]", exact.drag().real(), drag.real()});
    outcome.reached.push_back({"a quarter before [-]", exact.drag().imag(), drag.imag()});
    outcome.steps = std::to_string(count) + " a period, " + std::to_string(flow.remeshed) + " with new cells";
    return outcome;
}

}  // namespace kropla
