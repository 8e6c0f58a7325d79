// Problems whose solutions are known (heat_problems.h). Bounds are what is reached and a tenth; docs/validation.md has
// the finer meshes, by `make validate`.
#include "heat_problems.h"
#include "session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace kropla {
namespace {

constexpr double percent = 0.01;

/// Energies are kept and no temperature is beyond those there are, on the way to an error of at most `bound`.
void expect_within(const Outcome& outcome, double bound) {
    for (const Reached& value : outcome.reached) {
        testing::Test::RecordProperty(value.what, std::to_string(value.error()));
        EXPECT_LT(std::abs(value.error()), bound) << value.what << ": " << value.value << " for " << value.exact;
    }
    EXPECT_FALSE(outcome.reached.empty());
    EXPECT_LT(outcome.balance, 1e-12);
    EXPECT_LT(outcome.beyond, 1e-10);
}

TEST(HeatValidation, OnePhaseFreezes) {
    expect_within(one_phase_stefan(petsc().all_ranks(), 0.1, 1), 0.005 * percent);
    expect_within(one_phase_stefan(petsc().all_ranks(), 1, 1), 0.044 * percent);
}

TEST(HeatValidation, TwoPhasesFreeze) {
    const Outcome unit = two_phase_stefan(petsc().all_ranks(), unit_phases, 3);
    expect_within(unit, 0.26 * percent);
    EXPECT_GT(unit.passes, 40);  // a step that went to and fro, until it was made to settle
    EXPECT_LT(unit.passes, 56);
    expect_within(two_phase_stefan(petsc().all_ranks(), iron_phases, 1), 0.38 * percent);
}

TEST(HeatValidation, BallFreezesOutwards) {
    expect_within(freezing_ball(petsc().all_ranks(), 1), 0.022 * percent);
}

TEST(HeatValidation, SphereThatExchangesHeat) {
    expect_within(robin_sphere(petsc().all_ranks(), 1, 1), 0.42 * percent);
}

TEST(HeatValidation, SphereInAMedium) {
    expect_within(sphere_in_like_medium(petsc().all_ranks(), 1), 0.48 * percent);
    expect_within(sphere_in_poor_medium(petsc().all_ranks(), 1), 0.122 * percent);
}

TEST(HeatValidation, SphereThatIsHeated) {
    expect_within(heated_sphere(petsc().all_ranks(), 1), 0.41 * percent);
}

TEST(HeatValidation, SphereThatRadiates) {
    expect_within(radiating_sphere(petsc().all_ranks(), 0, 1), 0.041 * percent);
    expect_within(radiating_sphere(petsc().all_ranks(), 600, 1), 0.04 * percent);
}

TEST(HeatValidation, SourceAtRest) {
    expect_within(resting_source(petsc().all_ranks(), 0.1, 1), 0.58 * percent);
}

TEST(HeatValidation, SourceThatMoves) {
    expect_within(moving_source(petsc().all_ranks(), 0.25, 1), 0.78 * percent);
}

}  // namespace
}  // namespace kropla
