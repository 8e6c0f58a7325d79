#include "app/step_row.h"
#include "app/steps_csv.h"
#include <kropla/base/error.h>
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace kropla {
namespace {

StepRow row_of(int step) {
    return {{"step", double(step)}, {"time [s]", step / 3.0}, {"energy_integral [J]", 0.1 + 0.2}, {"error", 1e-17}};
}

std::string header_and_rows(std::initializer_list<int> steps) {
    std::string text = csv_header(row_of(0)) + "\n";
    for (const int step : steps) text += csv_line(row_of(step)) + "\n";
    return text;
}

TEST(StepsTable, HasNamesAndUnits) {
    EXPECT_EQ(csv_header(row_of(1)), "step,time [s],energy_integral [J],error");
    EXPECT_EQ(csv_line({{"a", 21722}, {"b", 1e-300}, {"c", -0.5}}), "21722,1e-300,-0.5");
}

TEST(StepRow, HasTheColumnsThatReadersKnow) {
    Case given;
    given.domain.bodies.resize(1);
    given.domain.bodies[0].name = "a drop, left";
    EXPECT_EQ(csv_header(step_row(1, {}, {}, {}, given)),
              "step,time [s],dt [s],attempts,vertices,tets,prisms,max_aspect_ratio,p999_aspect_ratio,"
              "min_dihedral [deg],max_dihedral [deg],smoothing_sweeps,swaps,splits,collapses,local_remeshes,"
              "largest_ring,global_remeshes,given_up,touched_fraction,kept_vertices,kept_tets,mesh_seconds [s],"
              "simulate_seconds [s],transfer_seconds [s],mesh_cpu_seconds [s],transferred_fraction,"
              "x_a_drop__left [m],y_a_drop__left [m],z_a_drop__left [m],u_a_drop__left [m/s],v_a_drop__left [m/s],"
              "w_a_drop__left [m/s],volume_a_drop__left [m^3],area_a_drop__left [m^2]");
    given.heat.emplace();
    EXPECT_TRUE(csv_header(step_row(1, {}, {}, {}, given))
                    .ends_with(",temperature_min_a_drop__left [K],temperature_mean_a_drop__left [K],"
                               "temperature_max_a_drop__left [K],heat_from_a_drop__left [W],"
                               "energy_integral [J],energy_transfer_error,energy_before_transfer [J],energy_limited [K],"
                               "energy_beyond_bounds [K],heat_out_x_min [W],heat_out_x_max [W],heat_out_y_min [W],"
                               "heat_out_y_max [W],heat_out_z_min [W],heat_out_z_max [W],heat_sources [W],"
                               "heat_at_surfaces [W],heat_held [W],heat_by_volume [W],energy_error [J]"));
}

TEST(StepRow, HasTheFiguresOfTheStep) {
    Case given;
    given.domain.bodies.resize(1);
    given.domain.bodies[0].name = "b";
    given.heat.emplace();
    StepReport report;
    report.mesh.time = 2;
    report.mesh.dt = 0.5;
    report.mesh.changes.swaps = 13;
    report.mesh.contents = {{.before_transfer = 4, .after = -5, .by_transfer = 1}};
    report.mesh.transfer = {{.limited = 6, .beyond = 7}};
    report.heat.surfaces = {{.body = Region(1), .total = -7, .vertices = {}, .density = {}}};
    report.heat.balance.before = 1;
    report.heat.balance.after = 4;
    report.heat.balance.faces = {0, 0, 0, 0, 0, 2};
    report.heat.balance.sources = {0.25, 0.5};
    report.heat.balance.expansion = {0, 0.125};
    report.bodies = {{.place = {1, 2, 3}, .mean = 300}};
    report.velocities = {{4, 5, 6}};
    const StepRow row = step_row(3, report, {}, {.tets = 8, .worst = {}}, given);
    const auto value = [&](std::string_view column) {
        return std::ranges::find(row, column, &Figure::column)->value;
    };
    EXPECT_EQ(value("step"), 3);
    EXPECT_EQ(value("time [s]"), 2);
    EXPECT_EQ(value("swaps"), 13);
    EXPECT_EQ(value("tets"), 8);
    EXPECT_EQ(value("z_b [m]"), 3);
    EXPECT_EQ(value("v_b [m/s]"), 5);
    EXPECT_EQ(value("temperature_mean_b [K]"), 300);
    EXPECT_EQ(value("heat_from_b [W]"), -7);
    EXPECT_TRUE(csv_line(row).ends_with(",-5,0.2,4,6,7,0,0,0,0,0,-4,1.5,0,0,0.25,0.125")) << csv_line(row);
}

TEST(StepsTable, KeepsEveryBitOfANumber) {
    const std::string line = csv_line(row_of(1));
    EXPECT_NE(line.find(",0.3333333333333333,"), std::string::npos) << line;
    EXPECT_NE(line.find(",0.30000000000000004,1e-17"), std::string::npos) << line;
}

TEST(StepsTable, EveryRowIsThereAtOnce) {
    const TemporaryFolder folder;
    StepsTable table(folder.path / "steps.csv", row_of(0));
    EXPECT_EQ(contents(folder.path / "steps.csv"), header_and_rows({}));
    table.append(row_of(1));
    EXPECT_EQ(contents(folder.path / "steps.csv"), header_and_rows({1}));
}

TEST(StepsTable, GoesOnAfterTheStepOfTheCheckpoint) {
    const TemporaryFolder folder;
    const auto file = folder.path / "steps.csv";
    write(file, header_and_rows({1, 2, 3}) + "4,1.33");  // the machine failed while it wrote step 4
    {
        StepsTable table(file, row_of(0), 2);
        EXPECT_EQ(contents(file), header_and_rows({1, 2}));
        table.append(row_of(3));
    }
    EXPECT_EQ(contents(file), header_and_rows({1, 2, 3}));
    StepsTable table(file, row_of(0), 0);
    EXPECT_EQ(contents(file), header_and_rows({}));
}

TEST(StepsTable, RefusesToGoOnWhereItCannot) {
    const TemporaryFolder folder;
    const auto file = folder.path / "steps.csv";
    EXPECT_THROW(StepsTable(file, row_of(0), 2), FileError);  // no such file
    write(file, header_and_rows({1, 2}));
    EXPECT_THROW(StepsTable(file, row_of(0), 3), FileError);  // too short
    EXPECT_THROW(StepsTable(file, StepRow{{"step", 0}}, 2), FileError);      // other columns
    EXPECT_EQ(contents(file), header_and_rows({1, 2}));    // and it is as it was
    write(file, header_and_rows({1}) + csv_line(row_of(2)));
    EXPECT_THROW(StepsTable(file, row_of(0), 2), FileError);  // row 2 has no end
    EXPECT_THROW(StepsTable(folder.path / "none" / "steps.csv", row_of(0)), FileError);
}

}  // namespace
}  // namespace kropla
