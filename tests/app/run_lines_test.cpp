#include "app/run_lines.h"

#include <kropla/io/pvd.h>
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

/// What a run of one step leaves, with these columns beside those of each run.
void write_run(const TemporaryFolder& folder, const std::string& names, const std::string& cells) {
    write(folder.path / "case.toml", "");
    write(folder.path / "steps.csv", "step,time [s],dt [s],attempts,max_aspect_ratio,mesh_seconds,simulate_seconds,"
                                     "transfer_seconds" + names + "\n1,0.25,0.25,1,5.04,0,0,0" + cells + "\n");
    write_pvd(folder.path / "frames.pvd", {});
}

std::string body_names(const std::string& name) {
    std::string text;
    for (const char* column : {"x_", "y_", "z_", "u_", "v_", "w_"}) text += "," + (column + name) + " [m]";
    return text + ",volume_" + name + " [m^3]";
}

TEST(ClosingLines, SayOfManyBodiesTheFirstTwo) {
    const TemporaryFolder folder;
    write_run(folder, body_names("a") + body_names("b") + body_names("c"),
              ",0.001,2,0,0,0,0,1,0,0,5e-6,0,0,0,1e-18,0,0,0,0,0,0,1e-18");
    const std::string where = folder.path.string();
    EXPECT_EQ(closing_lines(folder.path, 75),
              (std::vector<std::string>{"done: 1 step to 250 ms in 1:15, worst R/r 5.0",
                                        "a: still at (0.00, 2.00, 0.00) m", "b: still at (0.00, 0.00, 5.00) um",
                                        "and 1 body more",
                                        "see " + where + "/report.html, or paraview " + where + "/frames.pvd"}));
}

TEST(ClosingLines, SayInAFlowHowFastABodyGoes) {
    const TemporaryFolder folder;
    std::string names = body_names("a");
    for (const char* axis : {"x", "y", "z"})
        for (const char* quantity : {"spin", "force"})
            names += std::string(",") + quantity + "_" + axis + "_a [N]";
    write_run(folder, names, ",0,0,0.0123,0,0,-0.0954,1e-6,0,0,0,0,0,0");
    write(folder.path / "bodies.csv", "body,name,x [m],y [m],z [m]\n1,ball,0,0,0.1275\n");
    EXPECT_EQ(closing_lines(folder.path, 75)[1], "ball: now at (0, 0, 12) mm, going at 95.4 mm/s");
}

TEST(ClosingLines, TellWhereTheEnergyCameFrom) {
    const TemporaryFolder folder;
    write_run(folder,
              ",energy_integral [J],energy_before_transfer [J],heat_out_x_min [W],heat_out_x_max [W],"
              "heat_out_y_min [W],heat_out_y_max [W],heat_out_z_min [W],heat_out_z_max [W],heat_sources [W],"
              "heat_at_surfaces [W],heat_held [W],heat_by_volume [W],energy_error [J]",
              ",63.25,63.25,-8,0,0,0,0,0,2,-1,0,1,0");
    EXPECT_EQ(closing_lines(folder.path, 1)[1],
              "energy: 63.2 J stored, 2 J in through faces, 500 mJ in by sources, 250 mJ out at surfaces of bodies, "
              "250 mJ in as volumes change, balanced to the last digit");
}

}  // namespace
}  // namespace kropla
