// kropla_endurance [STEPS [SEED]]: a layered droplet wanders among bodies at rest (tests/adapt/endurance.h), 5000 steps
// unless told. Tells how it goes, then the figures and which bounds are broken. Exit code 1: at least one.

#include "adapt/endurance.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

using namespace kropla;

int main(int count, char** arguments) {
    const int steps = count > 1 ? std::atoi(arguments[1]) : 5000;
    const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
    if (steps < 4) return std::fprintf(stderr, "kropla_endurance [STEPS [SEED]], at least 4 steps\n"), 2;

    const EnduranceBounds bounds;
    const int told_every = std::max(1, steps / 50);
    double worst = 0, seconds = 0;
    int refused = 0, local = 0, least = 1 << 30, most = 0;
    const auto report = endure(steps, seed, bounds, [&](const EnduranceStep& s) {
        worst = std::max(worst, s.worst_aspect_ratio);
        seconds += s.cpu_seconds;
        refused += s.attempts - 1;
        local += s.local_remeshes;
        least = std::min(least, s.cells);
        most = std::max(most, s.cells);
        if (s.step % told_every != 0) return;
        std::printf("step %5d/%d  cells %6d  worst R/r %.2f, so far %.2f  refused %d  mesh %.3f s per step\n", s.step, steps,
                    s.cells, s.worst_aspect_ratio, worst, refused, seconds / s.step);
        std::fflush(stdout);
    });
    const int taken = static_cast<int>(report.steps.size());
    auto broken = broken_bounds(report, bounds);
    const double growth = taken < 4 ? 1 : growth_of(report, [](const EnduranceStep& s) { return s.cpu_seconds; });
    if (growth > bounds.growth) broken.push_back("the time per step grows by the factor " + std::to_string(growth));

    std::printf("\n| figure | seed %llu |\n|---|---|\n| steps | %d of %d |\n| attempts refused | %d |\n"
                "| cells at the start, least, most | %d, %d, %d |\n| worst R/r | %.2f |\n| local remeshes | %d |\n"
                "| mesh, CPU seconds per step | %.4f |\n| time per step, last quarter to first | %.2f |\n",
                static_cast<unsigned long long>(seed), taken, steps, refused, report.cells_at_start, least, most, worst, local,
                seconds / std::max(1, taken), growth);
    for (const std::string& line : broken) std::printf("BROKEN: %s\n", line.c_str());
    return broken.empty() ? 0 : 1;
}
