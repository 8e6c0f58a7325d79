#include "adapt/endurance.h"

#include <kropla/base/error.h>
#include "base/random.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/step/initial_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

namespace kropla {
namespace {

constexpr int waves = 4;                                  // per axis
constexpr double slowest = 1.0 / 150, fastest = 1.0 / 25;  // [1 / step]

struct Wave {
    double frequency, phase;  // [1 / step], [rad]
};
using Waves = std::array<std::array<Wave, waves>, 3>;

int count_cells(const Mesh& mesh) { return count_tets(mesh) + count_prisms(mesh); }

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

EnduranceStep taken(const MovingMesh& moving, int step, const StepCost& cost) {
    const Mesh& mesh = moving.reference();
    return {.step = step,
            .cells = count_cells(mesh),
            .attempts = cost.attempts,
            .global_remeshes = cost.changes.global_remeshes,
            .local_remeshes = cost.changes.local_remeshes,
            .cells_touched = cost.cells_touched,
            .worst_aspect_ratio = worst_aspect_ratio(mesh, all_tets(mesh)),
            .cpu_seconds = cost.cpu_seconds};
}

}  // namespace

Motion random_walk(double reach, std::uint64_t seed) {
    Random random{seed};
    Waves all;
    for (auto& axis : all)
        for (Wave& wave : axis)
            wave = {random.uniform(slowest, fastest), random.uniform(0, 2 * std::numbers::pi)};
    return [all, reach](double t) {
        Pose pose;
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0;
            for (const Wave& wave : all[static_cast<std::size_t>(axis)])
                sum += std::sin(2 * std::numbers::pi * wave.frequency * t + wave.phase);
            pose.displacement[axis] = reach * sum / waves;
        }
        return pose;
    };
}

Domain endurance_domain(std::uint64_t seed) {
    constexpr double reach = 1e-3, corner = 1.7e-3, half = 2.8e-3;
    Domain domain;
    domain.box = {{-half, -half, -half}, {half, half, half}};
    domain.size = {.surface = 2e-4, .growth = 0.25, .far = 6e-4};
    Body droplet{"droplet", {{0, 0, 0}, {5e-4, 5e-4, 5e-4}, {}}, random_walk(reach, seed)};
    droplet.layer = LayerOptions{.count = 3, .first_height = 2e-5, .growth = 1.3};
    domain.bodies.push_back(droplet);
    for (const Vec3& sign : {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}})
        domain.bodies.push_back({"fixed", {corner * sign, {4e-4, 4e-4, 4e-4}, {}}});
    return domain;
}

EnduranceReport endure(int steps, std::uint64_t seed, const EnduranceBounds& bounds,
                       const std::function<void(const EnduranceStep&)>& told) {
    const Domain domain = endurance_domain(seed);
    const AdaptOptions options{
        .passing = bounds.worst_aspect_ratio, .floor = bounds.worst_aspect_ratio, .seed = seed};
    MovingMesh moving(domain, initial_mesh(domain, options), 0, options);
    EnduranceReport report;
    report.cells_at_start = count_cells(moving.reference());
    try {
        for (int step = 1; step <= steps; ++step) {
            const StepCost cost = step_to(moving, step);
            report.steps.push_back(taken(moving, step, cost));
            if (told) told(report.steps.back());
        }
    } catch (const FloorError& error) {
        report.stuck = error.what();
    }
    return report;
}

double growth_of(const EnduranceReport& report, double (*work)(const EnduranceStep&)) {
    std::vector<double> values;
    for (const EnduranceStep& step : report.steps) values.push_back(work(step));
    const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
    return median({values.end() - quarter, values.end()}) / median({values.begin(), values.begin() + quarter});
}

std::vector<std::string> broken_bounds(const EnduranceReport& report, const EnduranceBounds& bounds) {
    std::vector<std::string> broken;
    const auto first = [&](const std::string& what, auto&& is_broken, auto&& value) {
        const auto step = std::ranges::find_if(report.steps, is_broken);
        if (step == report.steps.end()) return;
        std::ostringstream line;
        line << what << ", first at step " << step->step << ": " << value(*step);
        broken.push_back(line.str());
    };
    first("worst R/r above the bound", [&](const auto& s) { return s.worst_aspect_ratio > bounds.worst_aspect_ratio; },
          [](const auto& s) { return s.worst_aspect_ratio; });
    first("the whole region remeshed", [](const auto& s) { return s.global_remeshes > 0; },
          [](const auto& s) { return s.global_remeshes; });
    first("number of cells too far from the start's " + std::to_string(report.cells_at_start),
          [&](const auto& s) {
              return std::abs(s.cells - report.cells_at_start) > bounds.count_change * report.cells_at_start;
          },
          [](const auto& s) { return s.cells; });
    if (!report.stuck.empty()) broken.push_back("stuck: " + report.stuck);
    return broken;
}

}  // namespace kropla
