// What a prism layer costs: the mesh work of the droplet's steps with it and without, and the part of that
// which is the layer's own. The layer of cases/droplet_layer.toml shall add at most a tenth to a step.

#include "generate/layers.h"
#include <kropla/mesh/quality.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <stdexcept>

namespace kropla {
namespace {

constexpr double step = 2e-4;  // [s]

/// The droplet of cases/droplet.toml.
Domain droplet(bool layered) {
    Body body{.name = "droplet",
              .shape = {{0, 0, 0.013}, {1e-3, 1e-3, 1e-3}, {}},
              .motion = [](double t) { return Pose{{0, 0, -t}, {}}; }};
    if (layered) body.layer = LayerOptions{};
    return {{{-0.004, -0.004, 0}, {0.004, 0.004, 0.016}}, {body}, {}};
}

void take_step(MovingMesh& moving) {
    Fields none;
    if (advance(moving, none, step, {}).attempts > 1) throw std::runtime_error("a step of the benchmark was refused");
}

/// Items are steps, the first ten of the droplet's way.
void measure_step(benchmark::State& state, bool layered) {
    const Domain domain = droplet(layered);
    const MovingMesh start(domain, initial_mesh(domain, 1), 0);
    double worst = 0;
    for (auto _ : state) {
        MovingMesh moving = start;
        for (int i = 0; i < 10; ++i) take_step(moving);
        worst = summarise_quality(moving.reference()).max_aspect_ratio;
    }
    state.SetItemsProcessed(10 * state.iterations());
    state.counters["worst R/r"] = worst;
    state.counters["tets"] = summarise_quality(start.reference()).tets;
    state.counters["prisms"] = count_prisms(start.reference());
}
BENCHMARK_CAPTURE(measure_step, without_layer, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(measure_step, with_layer, true)->Unit(benchmark::kMillisecond);

/// What a step does for its layer alone: columns set up anew, the gap measured, prisms looked at.
void measure_layer(benchmark::State& state) {
    const Domain domain = droplet(true);
    const Mesh mesh = initial_mesh(domain, 1);
    const Snapshot at = snapshot(domain, 0);
    const PrismLayer& layer = mesh.layers.front();
    for (auto _ : state) {
        benchmark::DoNotOptimize(column_places(layer, wall_places(mesh, layer), at));
        benchmark::DoNotOptimize(narrowest_gap(mesh, at));
        double least = 1;
        for (const Prism& prism : all_prisms(mesh))
            least = std::min(least, scaled_corner_jacobian(prism_corners(mesh, prism)));
        benchmark::DoNotOptimize(least);
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["columns"] = count_columns(layer);
}
BENCHMARK(measure_layer)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kropla
