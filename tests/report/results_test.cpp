#include "report/results.h"

#include "report/results_page.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

/// Two steps of a body that falls by 1 m each and cools, in a box that loses 0.5 W through z min and has a source
/// of 3 W.
constexpr const char* steps_text =
    "step,time [s],dt [s],x_a [m],y_a [m],z_a [m],u_a [m/s],v_a [m/s],w_a [m/s],volume_a [m^3],area_a [m^2],"
    "temperature_min_a [K],temperature_mean_a [K],temperature_max_a [K],heat_from_a [W],"
    "energy_integral [J],energy_transfer_error,energy_before_transfer [J],energy_limited [K],energy_beyond_bounds [K],"
    "heat_out_x_min [W],heat_out_x_max [W],heat_out_y_min [W],heat_out_y_max [W],heat_out_z_min [W],"
    "heat_out_z_max [W],heat_sources [W],heat_at_surfaces [W],heat_held [W],heat_by_volume [W],energy_error [J]\n"
    "1,2,2,0,0,4,0,0,-0.5,8,24,380,390,395,7,105,0,105,0,0,0,0,0,0,0.5,0,3,0,0,0,0\n"
    "2,3,1,1e-16,0,3,1e-16,0,-1,8,24,360,370,394,-9,107.5,0,107.5,0,0,0,0,0,0,0.5,0,3,0,0,0,0\n";
constexpr const char* bodies_text =
    "body,name,x [m],y [m],z [m],temperature_min [K],temperature_mean [K],temperature_max [K]\n1,a,0,0,5,400,400,400\n";

RunFiles files(const std::string& steps = steps_text, const char* bodies = bodies_text) {
    RunFiles run;
    run.steps = parse_table(steps, "steps.csv");
    run.bodies = parse_table(bodies, "bodies.csv");
    return run;
}

TEST(Results, TellWhatCameOutForABody) {
    const RunResults results = results_of(files());
    ASSERT_EQ(results.bodies.size(), 1u);
    const BodyResult& body = results.bodies[0];
    EXPECT_EQ(body.name, "a");
    EXPECT_TRUE(results.start_known);
    EXPECT_EQ(body.start_place, (Vec3{0, 0, 5}));
    EXPECT_EQ(body.place.back().z, 3);
    EXPECT_EQ(body.start_mean, 400);
    EXPECT_EQ(body.least, 360);
    EXPECT_EQ(body.most, 400);  // at the start
    EXPECT_EQ(body.given_off, 2 * 7 - 9);
    EXPECT_TRUE(moves(body));
}

TEST(Results, BalanceTheEnergy) {
    const RunResults results = results_of(files());
    ASSERT_TRUE(results.energy);
    EXPECT_EQ(results.energy->start, 100);  // 105 less 2 s of 3 W - 0.5 W
    EXPECT_EQ(results.energy->faces, -1.5);
    EXPECT_EQ(results.energy->sources, 9);
    EXPECT_EQ(results.energy->error(), 0);
    EXPECT_EQ(results.energy->size, 107.5);
    std::string leaking = steps_text;
    leaking.replace(leaking.find("107.5"), 5, "106.5");  // a transfer that loses 1 J
    EXPECT_EQ(results_of(files(leaking)).energy->error(), -1);
}

TEST(Results, OfOlderRunsAreWhatTheirFilesTell) {
    RunFiles run = files("step,time [s],dt [s],energy_integral [J]\n1,2,2,105\n", "body,semi_axis_1 [m]\n1,1\n");
    const RunResults older = results_of(run);
    EXPECT_TRUE(older.bodies.empty());
    EXPECT_TRUE(older.faces.empty());
    EXPECT_FALSE(older.energy);
    EXPECT_EQ(draw_results(older, ""), "");
    EXPECT_EQ(draw_results(results_of(files("step,time [s],dt [s]\n")), ""), "");  // no step yet
    run = files(steps_text, "body,semi_axis_1 [m]\n1,1\n");
    const RunResults without_start = results_of(run);
    EXPECT_FALSE(without_start.start_known);
    EXPECT_EQ(without_start.bodies[0].start_mean, 390);
}

bool has(const std::string& html, const std::string& part) { return html.find(part) != std::string::npos; }

TEST(ResultsPage, ShowsWhatThereIsAndNothingElse) {
    const std::string html = draw_results(results_of(files()), "<p>pictures</p>");
    for (const char* part : {"<td>a</td><td>400 → 370</td><td>360 … 400</td><td>5 J</td><td>-9 W</td>",
                             "<td>(0.00, 0.00, 5.00) m</td><td>(0.00, 0.00, 3.00) m</td><td>1 m/s</td><td>8 m³</td>",
                             "<td>z min</td><td>500 mW</td><td>1.5 J</td>",
                             "<td>by sources</td><td>9 J</td>",
                             "<td>error of the balance</td><td>none but rounding, 0 of the energy</td>",
                             "Temperature of a [K]", "Heat from a [W]", "Heat out through z min [mW]",
                             "Energy stored since the start [J]", "Displacement of a along z [m]",
                             "Speed of a [m/s]", "time [s]", "<p>pictures</p>"})
        EXPECT_TRUE(has(html, part)) << part << "\n" << html;
    EXPECT_FALSE(has(html, "<td>x min</td>"));
}

/// A body that falls by 1 m in the flow that it makes, in a box that some of it leaves; noise along x and in
/// its spin.
constexpr const char* flow_text =
    "step,time [s],dt [s],x_a [m],y_a [m],z_a [m],u_a [m/s],v_a [m/s],w_a [m/s],volume_a [m^3],area_a [m^2],"
    "spin_x_a [rad/s],spin_y_a [rad/s],spin_z_a [rad/s],force_x_a [N],force_y_a [N],force_z_a [N],"
    "volume_out_x_min [m^3/s],volume_out_x_max [m^3/s],volume_out_y_min [m^3/s],volume_out_y_max [m^3/s],"
    "volume_out_z_min [m^3/s],volume_out_z_max [m^3/s],mass_error_surroundings [kg],courant,flow_passes,"
    "flow_iterations,flow_rounds\n"
    "1,2,2,0,0,4,1e-4,0,-0.5,8,24,1e-3,0,0,0,1e-5,0.02,1e-17,0,0,0,0,0.25,1e-15,0.5,4,30,2\n"
    "2,3,1,0,0,3,1e-4,0,-0.25,8,24,1e-3,0,0,0,1e-5,0.03,1e-17,0,0,0,0,0.5,-1e-15,1.5,6,31,2\n";

RunFiles flow_files(const std::string& steps) {
    RunFiles run = files(steps, "body,name,x [m],y [m],z [m]\n1,a,0,0,5\n");
    run.case_text =
        "[domain]\nmin = [0, 0, 0]\nmax = [2, 2, 4]\n[flow.region.\"surroundings\"]\ndensity = 1.5\n";
    return run;
}

TEST(Results, TellOfAFlow) {
    const RunResults results = results_of(flow_files(flow_text));
    ASSERT_TRUE(results.flow);
    const FlowResult& flow = *results.flow;
    EXPECT_EQ(flow.courant, (std::vector<double>{0.5, 1.5}));
    ASSERT_EQ(flow.faces.size(), 6u);
    EXPECT_EQ(flow.faces[5].total, 1);
    EXPECT_NEAR(flow.flux_size, 2, 1e-6);  // what the body pushes aside
    EXPECT_EQ(flow.mass_missed, 2e-15);
    EXPECT_EQ(flow.mass, 12);
    const BodyResult& body = results.bodies[0];
    EXPECT_EQ(notable_axes(body.velocity), std::vector<int>{2});
    EXPECT_EQ(notable_axes(body.force), std::vector<int>{2});
    EXPECT_FALSE(turns(body));
    EXPECT_FALSE(results_of(files()).flow);
}

TEST(ResultsPage, ShowsAFlowWithoutItsNoise) {
    const std::string html = draw_results(results_of(flow_files(flow_text)), "");
    for (const char* part :
         {"<td>0.25 m/s</td><td>0.5 m/s</td><td>30 mN</td><td>30 mN</td><td>8 m³</td>",
          "<td>z max</td><td>0.5 m³/s</td><td>1 m³</td>", "Force of the flow on a along z [mN]",
          "Flow out through z max", "none but rounding, 2e-16 of the mass"})
        EXPECT_TRUE(has(html, part)) << part << "\n" << html;
    for (const char* part : {"x min", "Spin", "Velocity of a", "along x"})
        EXPECT_FALSE(has(html, part)) << part;
    std::string turning = flow_text;
    for (std::size_t at; (at = turning.find("1e-3")) != std::string::npos;) turning.replace(at, 4, "0.25");
    EXPECT_TRUE(has(draw_results(results_of(flow_files(turning)), ""), "Spin of a about x [rad/s]"));
}

TEST(ResultsPage, ShowsContacts) {
    std::string steps = flow_text;
    steps.insert(steps.find("\n1,"), ",gap_a [m],contact_force_x_a [N],contact_force_y_a [N],contact_force_z_a [N],contacts");
    steps.insert(steps.find("\n2,"), ",0.5,0,0,0,0");
    steps.insert(steps.size() - 1, ",0.25,0,0,3,1");
    const RunResults results = results_of(flow_files(steps));
    EXPECT_EQ(results.bodies[0].gap, (std::vector<double>{0.5, 0.25}));
    const std::string html = draw_results(results, "");
    for (const char* part : {"<td>a</td><td>250 mm</td><td>250 mm</td><td>3 N</td>",
                             "The first touch is in the step that ends at 3 s; there are touches in 1 of 2 steps.",
                             "Gap to what is nearest of a", "Force of contacts on a along z [N]"})
        EXPECT_TRUE(has(html, part)) << part << "\n" << html;
    EXPECT_FALSE(has(draw_results(results_of(flow_files(flow_text)), ""), "Contacts"));
}

TEST(ResultsPage, CallsAnErrorWhatIsOne) {
    std::string leaking = steps_text;
    leaking.replace(leaking.find("107.5"), 5, "106.5");
    const std::string html = draw_results(results_of(files(leaking)), "");
    EXPECT_TRUE(has(html, "<td>error of the balance</td><td>-1 J, 0.009 of the energy</td>")) << html;
}

TEST(ResultsPage, StaysLegibleWithManyBodies) {
    RunResults results = results_of(files());
    results.bodies.assign(40, results.bodies[0]);
    const std::string html = draw_results(results, "");
    EXPECT_TRUE(has(html, "12 of 40 bodies"));
    EXPECT_TRUE(has(html, "line s11\""));
    EXPECT_FALSE(has(html, "line s12\""));
}

}  // namespace
}  // namespace kropla
