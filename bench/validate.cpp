// Problems with known solutions (tests/simulate/heat_problems.h, flow_known.h, drop_known.h), as fine as the tests
// take them and finer, in tables of heat, of flow and of drops: docs/validation.md.
#include "simulate/drop_known.h"
#include "simulate/flow_known.h"
#include "simulate/heat_problems.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace kropla;

struct Problem {
    std::string name;
    std::function<Outcome(const Ranks&, int fineness)> solve;
};

const std::vector<Problem> heat = {
    {"one phase freezes, Ste 0.1", [](const Ranks& r, int f) { return one_phase_stefan(r, 0.1, f); }},
    {"one phase freezes, Ste 1", [](const Ranks& r, int f) { return one_phase_stefan(r, 1, f); }},
    {"two phases, all properties one", [](const Ranks& r, int f) { return two_phase_stefan(r, unit_phases, f); }},
    {"two phases, like iron", [](const Ranks& r, int f) { return two_phase_stefan(r, iron_phases, f); }},
    {"ball freezes outwards", freezing_ball},
    {"sphere, Bi 1", [](const Ranks& r, int f) { return robin_sphere(r, 1, f); }},
    {"sphere in a like medium", sphere_in_like_medium},
    {"sphere in a poor medium", sphere_in_poor_medium},
    {"sphere, constant flux", heated_sphere},
    {"sphere radiates to 0 K", [](const Ranks& r, int f) { return radiating_sphere(r, 0, f); }},
    {"sphere radiates to 600 K", [](const Ranks& r, int f) { return radiating_sphere(r, 600, f); }},
    {"source at rest", [](const Ranks& r, int f) { return resting_source(r, 0.1, f); }},
    {"source that moves", [](const Ranks& r, int f) { return moving_source(r, 0.25, f); }},
};

const std::vector<Problem> flow = {
    {"sphere in a sphere", drag_in_sphere},
    {"sphere in a cube", drag_in_cube},
    {"sphere to the floor", way_to_floor},
    {"sphere that swings", swinging_sphere},
    {"sphere in a stream, Re 20", [](const Ranks& r, int f) { return sphere_in_stream(r, stream_20, f); }},
    {"sphere in a stream, Re 50", [](const Ranks& r, int f) { return sphere_in_stream(r, stream_50, f); }},
    {"sphere in a stream, Re 100", [](const Ranks& r, int f) { return sphere_in_stream(r, stream_100, f); }},
    {"sphere in a stream, Re 200", [](const Ranks& r, int f) { return sphere_in_stream(r, stream_200, f); }},
};

const std::vector<Problem> drops = {
    {"drop in a sphere, 0.1", [](const Ranks& r, int f) { return drop_in_sphere(r, in_sphere_01, f); }},
    {"drop in a sphere, 1", [](const Ranks& r, int f) { return drop_in_sphere(r, in_sphere_1, f); }},
    {"drop in a sphere, 10", [](const Ranks& r, int f) { return drop_in_sphere(r, in_sphere_10, f); }},
    {"drop in a sphere, 25", [](const Ranks& r, int f) { return drop_in_sphere(r, in_sphere_25, f); }},
    {"drop to the floor, h = 1.5, 0.1", [](const Ranks& r, int f) { return drop_to_floor(r, near_floor_01, f); }},
    {"drop to the floor, h = 1.5, 1", [](const Ranks& r, int f) { return drop_to_floor(r, near_floor_1, f); }},
    {"drop to the floor, h = 1.5, 25", [](const Ranks& r, int f) { return drop_to_floor(r, near_floor_25, f); }},
    {"drop to the floor, h = 2, 0.1", [](const Ranks& r, int f) { return drop_to_floor(r, above_floor_01, f); }},
    {"drop to the floor, h = 2, 1", [](const Ranks& r, int f) { return drop_to_floor(r, above_floor_1, f); }},
    {"drop to the floor, h = 2, 25", [](const Ranks& r, int f) { return drop_to_floor(r, above_floor_25, f); }},
    {"drop in a stream, 1, Re 10", [](const Ranks& r, int f) { return drop_in_stream(r, like_10, f); }},
    {"drop in a stream, 1, Re 50", [](const Ranks& r, int f) { return drop_in_stream(r, like_50, f); }},
    {"drop in a stream, 1, Re 100", [](const Ranks& r, int f) { return drop_in_stream(r, like_100, f); }},
    {"drop in a stream, 10, Re 10", [](const Ranks& r, int f) { return drop_in_stream(r, heavy_10, f); }},
    {"drop in a stream, 10, Re 50", [](const Ranks& r, int f) { return drop_in_stream(r, heavy_50, f); }},
    {"drop in a stream, 10, Re 100", [](const Ranks& r, int f) { return drop_in_stream(r, heavy_100, f); }},
};

void print_rows(const Problem& problem, int fineness, const Outcome& outcome) {
    for (std::size_t k = 0; k < outcome.reached.size(); ++k) {
        const Reached& value = outcome.reached[k];
        const bool first = k == 0;
        std::printf("| %s | %s | %s | %s | %.7g | %.7g | %+.3f %% | %s |\n", first ? problem.name.c_str() : "",
                    first ? std::to_string(fineness).c_str() : "", first ? outcome.mesh.c_str() : "",
                    value.what.c_str(), value.exact, value.value, 100 * value.error(),
                    first ? outcome.steps.c_str() : "");
    }
    std::fflush(stdout);
}

void print_energy(const Outcome& outcome) {
    std::printf("| | | | energy, of a step [-] | 0 | %.0e | | passes: %d |\n", outcome.balance, outcome.passes);
    std::fflush(stdout);
}

/// Of the problems whose names contain what is wanted.
void print_table(const PetscSession& petsc, const std::vector<Problem>& problems, const std::string& wanted,
                 bool with_energy) {
    std::puts("| problem | fineness | mesh | quantity | exact | reached | error | steps |\n"
              "|---|---|---|---|---|---|---|---|");
    for (const Problem& problem : problems) {
        if (problem.name.find(wanted) == std::string::npos) continue;
        for (int fineness : {1, 2}) {
            const Outcome outcome = problem.solve(petsc.all_ranks(), fineness);
            print_rows(problem, fineness, outcome);
            if (with_energy) print_energy(outcome);
        }
    }
}

}  // namespace

/// Of all problems, or of those whose names contain the argument.
int main(int count, char** words) {
    try {
        const PetscSession petsc;
        const std::string wanted = count > 1 ? words[1] : "";
        print_table(petsc, heat, wanted, true);
        std::puts("");
        print_table(petsc, flow, wanted, false);
        std::puts("");
        print_table(petsc, drops, wanted, false);
        return EXIT_SUCCESS;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
