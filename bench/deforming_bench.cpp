// A step of a body that deforms beside one of a rigid body: the droplet of cases/droplet.toml, which falls one edge length a
// step, by a path and by the same displacement of each place of its surface. Items are the cells that a step touches: moved,
// changed or new; so items per second compare what each costs. One thread, a step an iteration.

#include "adapt/stepping.h"
#include <kropla/mesh/quality.h>
#include <kropla/step/initial_mesh.h>

#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>

namespace kropla {
namespace {

constexpr int steps = 40;
constexpr double step_time = 2e-4;  // [s], in which the droplet falls by 0.2 mm

Vec3 fallen(double t) { return {0, 0, -1.0 * t}; }

Domain droplet(bool deforms) {
    Domain domain{{{-0.004, -0.004, 0}, {0.004, 0.004, 0.016}}, {}, {.surface = 2e-4, .growth = 0.1, .far = 8e-4}};
    Body body{"droplet", {{0, 0, 0.013}, {0.001, 0.001, 0.001}, {}}};
    if (deforms) body.deformation = [](const Vec3& x, double t0, double t1) { return x + fallen(t1) - fallen(t0); };
    else body.motion = [](double t) { return Pose{fallen(t), {}}; };
    domain.bodies.push_back(body);
    return domain;
}

void step(benchmark::State& state, bool deforms) {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    const Domain domain = droplet(deforms);
    MovingMesh moving(domain, initial_mesh(domain, 1), 0);
    double touched = 0, worst = 0;
    int done = 0;
    for ([[maybe_unused]] auto _ : state) {
        touched += step_to(moving, ++done * step_time).cells_touched;
        state.PauseTiming();
        worst = std::max(worst, summarise_quality(moving.reference()).max_aspect_ratio);
        state.ResumeTiming();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(touched));
    state.counters["touched"] = touched / done;
    state.counters["worst R/r"] = worst;
}

BENCHMARK_CAPTURE(step, rigid, false)->Unit(benchmark::kMillisecond)->Iterations(steps);
BENCHMARK_CAPTURE(step, deforming, true)->Unit(benchmark::kMillisecond)->Iterations(steps);

}  // namespace
}  // namespace kropla
