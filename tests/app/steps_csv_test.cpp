#include "app/steps_csv.h"
#include "base/error.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

const std::vector<FieldBalance> energy = {{.field = "energy", .unit = "J", .value_unit = "K"}};

StepRow row_of(int step) {
    StepRow row;
    row.step = step;
    row.time = step / 3.0;
    row.tets = 1000 + step;
    row.fields = {{.field = "energy", .unit = "J", .value_unit = "K", .integral = 0.1 + 0.2, .transfer_error = 1e-17}};
    return row;
}

std::string header_and_rows(std::initializer_list<int> steps) {
    std::string text = csv_header(energy) + "\n";
    for (const int step : steps) text += csv_line(row_of(step)) + "\n";
    return text;
}

TEST(StepsTable, HasNamesAndUnits) {
    EXPECT_EQ(csv_header(energy),
              "step,time [s],dt [s],attempts,vertices,tets,prisms,max_aspect_ratio,p999_aspect_ratio,"
              "min_dihedral [deg],max_dihedral [deg],smoothing_sweeps,swaps,splits,collapses,local_remeshes,"
              "largest_ring,global_remeshes,touched_fraction,kept_vertices,kept_tets,mesh_seconds [s],"
              "simulate_seconds [s],transfer_seconds [s],mesh_cpu_seconds [s],transferred_fraction,"
              "energy_integral [J],energy_transfer_error,energy_before_transfer [J],energy_limited [K],"
              "energy_beyond_bounds [K]");
}

TEST(StepsTable, RowsFitTheHeader) {
    const std::string header = csv_header(energy), line = csv_line(row_of(7));
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(header, ','));
    // 1, 2, 3, ... in the order of the header
    const StepRow row = {.step = 1,
                         .time = 2,
                         .dt = 3,
                         .attempts = 4,
                         .vertices = 5,
                         .tets = 6,
                         .prisms = 7,
                         .max_aspect_ratio = 8,
                         .p999_aspect_ratio = 9,
                         .min_dihedral = 10,
                         .max_dihedral = 11,
                         .smoothing_sweeps = 12,
                         .swaps = 13,
                         .splits = 14,
                         .collapses = 15,
                         .local_remeshes = 16,
                         .largest_ring = 17,
                         .global_remeshes = 18,
                         .touched_fraction = 19,
                         .kept_vertices = 20,
                         .kept_tets = 21,
                         .mesh_seconds = 22,
                         .simulate_seconds = 23,
                         .transfer_seconds = 24,
                         .mesh_cpu_seconds = 25,
                         .transferred_fraction = 26,
                         .fields = {{"energy", "J", "K", 27, 28, 29, 30, 31}}};
    EXPECT_EQ(csv_line(row),
              "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31");
}

TEST(StepsTable, TellsWhatLeavesEachBody) {
    const FieldBalance two{.field = "energy", .unit = "J", .value_unit = "K", .from_bodies = {0.5, -7}};
    EXPECT_TRUE(csv_header({two}).ends_with(
        "energy_beyond_bounds [K],energy_from_body_1 [J/s],energy_from_body_2 [J/s]"));
    EXPECT_TRUE(csv_line({.fields = {two}}).ends_with(",0,0,0,0,0,0.5,-7"));
}

TEST(StepsTable, KeepsEveryBitOfANumber) {
    const std::string line = csv_line(row_of(1));
    EXPECT_NE(line.find(",0.3333333333333333,"), std::string::npos) << line;
    EXPECT_NE(line.find(",0.30000000000000004,1e-17"), std::string::npos) << line;
}

TEST(StepsTable, EveryRowIsThereAtOnce) {
    const TemporaryFolder folder;
    StepsTable table(folder.path / "steps.csv", energy);
    EXPECT_EQ(contents(folder.path / "steps.csv"), header_and_rows({}));
    table.append(row_of(1));
    EXPECT_EQ(contents(folder.path / "steps.csv"), header_and_rows({1}));
}

TEST(StepsTable, GoesOnAfterTheStepOfTheCheckpoint) {
    const TemporaryFolder folder;
    const auto file = folder.path / "steps.csv";
    write(file, header_and_rows({1, 2, 3}) + "4,1.33");  // the machine failed while it wrote step 4
    {
        StepsTable table(file, energy, 2);
        EXPECT_EQ(contents(file), header_and_rows({1, 2}));
        table.append(row_of(3));
    }
    EXPECT_EQ(contents(file), header_and_rows({1, 2, 3}));
    StepsTable table(file, energy, 0);
    EXPECT_EQ(contents(file), header_and_rows({}));
}

TEST(StepsTable, RefusesToGoOnWhereItCannot) {
    const TemporaryFolder folder;
    const auto file = folder.path / "steps.csv";
    EXPECT_THROW(StepsTable(file, energy, 2), FileError);  // no such file
    write(file, header_and_rows({1, 2}));
    EXPECT_THROW(StepsTable(file, energy, 3), FileError);  // too short
    EXPECT_THROW(StepsTable(file, {}, 2), FileError);      // other columns
    EXPECT_EQ(contents(file), header_and_rows({1, 2}));    // and it is as it was
    write(file, header_and_rows({1}) + csv_line(row_of(2)));
    EXPECT_THROW(StepsTable(file, energy, 2), FileError);  // row 2 has no end
    EXPECT_THROW(StepsTable(folder.path / "none" / "steps.csv", energy), FileError);
}

}  // namespace
}  // namespace kropla
