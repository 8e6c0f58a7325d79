// kropla_engine [STEPS]: two promises of the mesh engine, measured on the droplet of cases/droplet.toml, STEPS steps of
// one edge length each (10 unless told) after two that warm up.
//
// Proportional work: the box widened until there are 4 and 16 times as many cells around the same droplet, with the same
// target size; processor seconds of mesh work per step, on one thread.
//
// Threads: the target size divided until there are 10^6 cells; the same steps with one thread and with two, in turns
// from the same mesh. Seconds on the wall, as those are what a second thread saves; the meshes must have the same bits.

#include "adapt/stepping.h"
#include <kropla/step/initial_mesh.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace kropla {
namespace {

constexpr int warm_up = 2;
constexpr double step_time = 2e-4;  // [s], in which the droplet falls by 0.2 mm

/// The droplet's box widened `wide` times about its start; `finer` divides all target sizes and the step's length.
Domain droplet(double wide, double finer) {
    Domain domain;
    const Vec3 start{0, 0, 0.013}, low{-0.004, -0.004, 0}, high{0.004, 0.004, 0.016};
    domain.box = {start + wide * (low - start), start + wide * (high - start)};
    domain.size = {.surface = 2e-4 / finer, .growth = 0.1 / finer, .far = 8e-4 / finer};
    Body body{"droplet", {start, {0.001, 0.001, 0.001}, {}}};
    body.motion = [finer](double t) {
        const double s = t / finer;
        return Pose{{0.0003 * std::sin(4 * std::numbers::pi * s / 0.01), 0, -s}, {}};
    };
    domain.bodies.push_back(body);
    return domain;
}

struct Measured {
    int cells = 0;
    double cpu_seconds = 0, wall_seconds = 0;  // per step, medians
    double touched = 0;                        // [cells]
    Mesh last;
};

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

Measured measure(MovingMesh moving, int steps) {
    std::vector<double> cpu, wall, touched;
    for (int i = 1; i <= warm_up + steps; ++i) {
        const StepCost cost = step_to(moving, i * step_time);
        std::printf("\r%d cells, step %d/%d ", count_tets(moving.reference()), i, warm_up + steps);
        std::fflush(stdout);
        if (i <= warm_up) continue;
        cpu.push_back(cost.cpu_seconds);
        wall.push_back(cost.wall_seconds);
        touched.push_back(cost.cells_touched);
    }
    std::printf("\n");
    return {count_tets(moving.reference()), median(cpu), median(wall), median(touched), moving.reference()};
}

MovingMesh started(const Domain& domain) {
    std::printf("\rmeshing ...          ");
    std::fflush(stdout);
    return {domain, initial_mesh(domain, 1), 0};
}

bool proportional_work(int steps) {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    std::vector<Measured> all;
    for (const double wide : {1.0, 2.27, 3.82}) all.push_back(measure(started(droplet(wide, 1)), steps));
    std::printf("\n| cells | touched per step | mesh, CPU seconds per step | ratio (at most 1.25) |\n|---|---|---|---|\n");
    for (const Measured& m : all)
        std::printf("| %d | %.0f | %.4f | %.2f |\n", m.cells, m.touched, m.cpu_seconds,
                    m.cpu_seconds / all.front().cpu_seconds);
    std::printf("\n");
    return all.back().cpu_seconds <= 1.25 * all.front().cpu_seconds;
}

bool two_threads(int steps) {
    constexpr double finer = 2.33;  // 10^6 cells
    const MovingMesh start = started(droplet(1, finer));
    std::vector<Measured> all;
    for (const std::size_t threads : {1u, 2u}) {
        const oneapi::tbb::global_control allowed(oneapi::tbb::global_control::max_allowed_parallelism, threads);
        all.push_back(measure(start, steps));
    }
    const double gain = all[0].wall_seconds / all[1].wall_seconds;
    std::printf("\n| threads | cells | touched per step | mesh, seconds per step | CPU seconds |\n|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < 2; ++i)
        std::printf("| %zu | %d | %.0f | %.4f | %.4f |\n", i + 1, all[i].cells, all[i].touched, all[i].wall_seconds,
                    all[i].cpu_seconds);
    const bool same = all[0].last == all[1].last;
    std::printf("\nTwo threads are %.2f times as fast as one (at least 1.5); the meshes are %s.\n", gain,
                same ? "the same, bit for bit" : "NOT the same");
    return same && gain >= 1.5;
}

}  // namespace
}  // namespace kropla

int main(int count, char** arguments) {
    const int steps = count > 1 ? std::atoi(arguments[1]) : 10;
    if (steps < 1) return std::fprintf(stderr, "kropla_engine [STEPS]\n"), 2;
    const bool proportional = kropla::proportional_work(steps);
    const bool threads = kropla::two_threads(steps);
    if (!proportional) std::printf("BROKEN: work is not proportional to change\n");
    if (!threads) std::printf("BROKEN: two threads do not give enough\n");
    return proportional && threads ? 0 : 1;
}
