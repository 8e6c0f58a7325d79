// Flows whose forces are known (flow_known.h, drop_known.h). Bounds are what is reached and a tenth; docs/validation.md has
// the finer meshes, by `make validate`.
#include "drop_known.h"
#include "flow_known.h"
#include "session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>

namespace kropla {
namespace {

/// One bound [%] for each value.
void expect_within(const Outcome& outcome, std::initializer_list<double> bounds) {
    ASSERT_EQ(outcome.reached.size(), bounds.size());
    const double* bound = bounds.begin();
    for (const Reached& value : outcome.reached) {
        testing::Test::RecordProperty(value.what, std::to_string(value.error()));
        EXPECT_LT(100 * std::abs(value.error()), *bound++)
            << value.what << ": " << value.value << " for " << value.exact;
    }
}

TEST(FlowValidation, SphereInASphere) { expect_within(drag_in_sphere(petsc().all_ranks(), 1), {1.87}); }

TEST(FlowValidation, SphereInACube) { expect_within(drag_in_cube(petsc().all_ranks(), 1), {1.94}); }

// With cells as large as the gap is in the end; and it jumps, as layers are made anew in a gap that narrows.
TEST(FlowValidation, SphereThatMovesToTheFloor) {
    expect_within(way_to_floor(petsc().all_ranks(), 1), {1.85, 1.26, 4.36, 1.03, 3.47});
}

TEST(FlowValidation, SphereThatSwings) {
    expect_within(swinging_sphere(petsc().all_ranks(), 1), {3.71, 1.31});
}

TEST(FlowValidation, SphereInAStream) {
    expect_within(sphere_in_stream(petsc().all_ranks(), stream_20, 1), {3.29, 2.74});
}

TEST(FlowValidation, DropInASphere) { expect_within(drop_in_sphere(petsc().all_ranks(), in_sphere_1, 1), {0.58}); }

TEST(FlowValidation, DropBeforeAFloor) { expect_within(drop_to_floor(petsc().all_ranks(), near_floor_1, 1), {0.96}); }

TEST(FlowValidation, DropInAStream) {
    expect_within(drop_in_stream(petsc().all_ranks(), heavy_50, 1), {1.85, 13.9});
}

}  // namespace
}  // namespace kropla
