// Slabs, cylinders and surfaces that are cut: their keys, and a run.
#include "case/case.h"
#include "case/case_text.h"
#include "run_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kropla {
namespace {

constexpr std::string_view pool_case = R"toml([domain]
min = [-1, -1, 0]
max = [1, 1, 2]
[[body]]
name = "pool"
shape = "slab"
min = [-1, -1, 0]
max = [1, 1, 0.5]
[[body]]
name = "wire"
shape = "cylinder"
from = [0, 0, 1.5]
to = [0, 0, 2]
radius = 0.25
[body.motion]
z = "-0.3*t"
[size]
surface = 0.15
growth = 0.3
far = 0.3
[time]
end = 0.5
steps = 3
)toml";

std::string refused(std::string_view from, std::string_view to) { return refusal(replaced(pool_case, from, to)); }

}  // namespace

TEST(CaseSolids, AreReadAndWritten) {
    const Case given = parse_case(std::string(pool_case), "case.toml");
    const Body &pool = given.domain.bodies[0], &wire = given.domain.bodies[1];
    EXPECT_EQ(reached_faces(pool.shape), 0b011111u);
    EXPECT_NEAR(volume(pool.shape), 2, 1e-14);
    EXPECT_EQ(reached_faces(wire.shape), 0b100000u);
    EXPECT_NEAR(volume(wire.shape), std::numbers::pi * 0.0625 * 0.5, 1e-14);
    EXPECT_EQ(pool.deformation({0.1, 0.2, 0.3}, 0, 1), (Vec3{0.1, 0.2, 0.3}));
    EXPECT_NEAR(wire.deformation({0.1, 0.2, 1.7}, 0, 1).z, 1.4, 1e-15);
    const std::string written = to_toml(given);
    EXPECT_EQ(to_toml(parse_case(written, "again.toml")), written);
}

TEST(CaseSolids, RefusalsNameKeyAndLine) {
    EXPECT_EQ(refused("max = [1, 1, 0.5]", "max = [1, 1, 0]"),
              "case.toml: body[0].max (line 8): its min is not below its max along z: 0 m and 0 m");
    EXPECT_EQ(refused("max = [1, 1, 0.5]", "max = [1, 1, 2]"), "case.toml: body[0].max (line 8): nothing of its surface is in the box");
    EXPECT_EQ(refused("max = [1, 1, 0.5]\n", ""), "case.toml: body[0].max (line 4): is missing; it must be 3 finite numbers [x, y, z]");
    EXPECT_EQ(refused("to = [0, 0, 2]", "to = [0, 0, 1.5]"),
              "case.toml: body[1].to (line 13): its two ends are in one place: (0, 0, 1.5) m");
    EXPECT_EQ(refused("radius = 0.25", "radius = 0.25\ncentre = [0, 0, 0]"),
              "case.toml: body[1].centre (line 15): a cylinder has from, to and radius instead");
    EXPECT_EQ(refused("radius = 0.25", "radius = 0.25\ncut = true"), "case.toml: body[1].cut (line 15): is of other shapes: a cylinder is cut away by itself where it is out of the box");
    EXPECT_EQ(refused("-0.3*t", "0.1 - 0.3*t"),
              "case.toml: body[1].motion.z (line 16): must be 0 at t = 0 for a body that is cut; this one reaches through the wall z max");
    EXPECT_EQ(refused("[body.motion]", "[body.layer]\ncount = 2\n[body.motion]"),
              "case.toml: body[1].layer (line 15): stands on bodies that are wholly in the box; this one reaches through the wall z max");
}

TEST(RunSolids, AWireIsFedTowardsAPool) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(pool_case));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (const std::string& v : columns.at("volume_pool")) EXPECT_NEAR(std::stod(v), 2, 1e-12);
    const double area = std::numbers::pi * 0.0625;
    for (std::size_t step = 0; step < 3; ++step)  // of a polyhedron inscribed, as long as it should be
        EXPECT_NEAR(std::stod(columns.at("volume_wire")[step]) / (area * (0.55 + 0.05 * static_cast<double>(step))), 0.95906, 2e-4);
    for (const std::string& r : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(r), 6);
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
}

/// Runs a.toml, and looks at each row: the volume [m^3] and area [m^2] of the body at that time, the worst aspect ratio, the tets.
template <class Volume, class Area>
void expect_content(const TemporaryFolder& folder, const std::string& body, const Volume& volume, const Area& area, double worst,
                    int most_cells = 1 << 30) {
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (std::size_t step = 0; step < columns.at("time").size(); ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        EXPECT_NEAR(number("volume_" + body), volume(number("time")), 1e-12);
        EXPECT_NEAR(number("area_" + body), area(number("time")), 1e-12);
        EXPECT_LE(number("max_aspect_ratio"), worst);
        EXPECT_LE(number("tets"), most_cells);
    }
}

// Its sharp edges get shorter, at last by more than a triangle; what is left of it stays a box.
TEST(RunSolids, ABlockLeavesThroughACorner) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", R"toml([domain]
min = [-1.5, -1.5, -1.5]
max = [1.5, 1.5, 1.5]
[[body]]
name = "block"
shape = "slab"
min = [-2.5, -2.5, -2.5]
max = [-0.4, -0.3, -0.2]
[body.motion]
x = "-0.3*t"
y = "0.3*t"
z = "-0.2*t"
[size]
surface = 0.2
growth = 0.3
far = 0.8
[time]
end = 2
steps = 10
)toml");
    const auto sides = [](double t) { return Vec3{1.1 - 0.3 * t, 1.2 + 0.3 * t, 1.3 - 0.2 * t}; };
    expect_content(folder, "block", [&](double t) { return sides(t).x * sides(t).y * sides(t).z; },
                   [&](double t) {
                       const auto [x, y, z] = sides(t);
                       return x * y + y * z + z * x;
                   }, 6);
}

/// A prism 2 m high over a polygon of corners on two circles in turn, as OBJ.
std::string prism(int corners, double outer, double inner) {
    std::string points, sides;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners, r = i % 2 == 0 ? outer : inner;
        for (const char* z : {"-1", "1"}) points += fmt::format("v {} {} {}\n", r * std::cos(angle), r * std::sin(angle), z);
        const int low = 2 * i + 1, next = 2 * ((i + 1) % corners) + 1;
        sides += fmt::format("f {0} {2} {3} {1}\nf {4} {5} {6}\nf {7} {8} {9}\n", low, low + 1, next, next + 1, next, low,
                             2 * corners + 1, low + 1, next + 1, 2 * corners + 2);
    }
    return points + "v 0 0 -1\nv 0 0 1\n" + sides;
}

// Edges of 60 degrees as those of 90: none is rounded; and where some of 66 degrees are near each other, cells do not get smaller.
TEST(RunSolids, PrismsKeepTheirEdgesAsTheyComeIn) {
    struct Prism {
        int corners;
        double outer, inner, area, length;
    };
    const double fifth = std::numbers::pi / 5, side = std::sqrt(0.49 + 0.09 - 0.42 * std::cos(fifth));
    for (const auto& [corners, outer, inner, area, length] :
         {Prism{6, 0.7, 0.7, 1.5 * std::sqrt(3) * 0.49, 4.2}, Prism{10, 0.7, 0.3, 5 * 0.21 * std::sin(fifth), 10 * side}}) {
        const TemporaryFolder folder;
        write(folder.path / "prism.obj", prism(corners, outer, inner));
        write(folder.path / "a.toml", R"toml([domain]
min = [-1.5, -1.5, -1]
max = [1.5, 1.5, 1]
[[body]]
name = "prism"
shape = "surface"
file = "prism.obj"
centre = [0, 0, -1.4]
cut = true
[body.motion]
z = "0.6*t"
[size]
surface = 0.3
growth = 0.3
far = 0.6
[time]
end = 0.6
steps = 6
)toml");
        const auto height = [](double t) { return 0.6 + 0.6 * t; };
        expect_content(folder, "prism", [&, area = area](double t) { return area * height(t); },
                       [&, area = area, length = length](double t) { return area + length * height(t); }, 6.5, 1900);
    }
}

constexpr std::string_view plate_case = R"toml([domain]
min = [-1, -1, -0.5]
max = [1, 1, 1.5]
[[body]]
name = "plate"
shape = "slab"
min = [-1, -1, -0.5]
max = [1, 1, 0]
[[body]]
name = "ball"
shape = "sphere"
centre = [0, 0, 0.9]
radius = 0.3
[body.motion]
z = "-0.5*t"
[size]
surface = 0.2
growth = 0.4
far = 0.4
[time]
end = 0.4
steps = 4
[heat.region.surroundings]
conductivity = 0.1
density = 1
specific_heat = 1
initial = 500
[heat.region.plate]
conductivity = 1
density = 10
specific_heat = 1
initial = 400
[heat.region.ball]
conductivity = 1
density = 10
specific_heat = 1
initial = 1000
[heat.face]
z_min = { value = 300 }
[heat.surface.plate]
flux = 50
)toml";
constexpr std::string_view in_a_flow = R"toml([flow.region.surroundings]
density = 1
viscosity = 0.1
[flow.face]
z_max = { pressure = 0 }
)toml";

TEST(RunSolids, APlateIsHeatedAsABallComesDown) {
    for (const bool flows : {false, true}) {
        const TemporaryFolder folder;
        write(folder.path / "a.toml", std::string(plate_case) + std::string(flows ? in_a_flow : ""));
        const Outcome ended = kropla_program(folder, "run a.toml --out d");
        ASSERT_EQ(ended.code, 0) << ended.err;
        const auto columns = lasting_columns(folder.path / "d");
        for (std::size_t step = 0; step < 4; ++step) {
            const auto number = [&](const char* name) { return std::stod(columns.at(name)[step]); };
            EXPECT_NEAR(number("heat_at_surfaces"), 200, 1e-9) << "the plate is 4 m^2 large";
            EXPECT_NEAR(number("energy_error"), 0, 1e-12 * number("energy_integral"));
            EXPECT_GE(number("temperature_min_plate"), 300 - 1e-9);
            EXPECT_LE(number("temperature_max_ball"), 1000 + 1e-9);
            EXPECT_NEAR(number("volume_plate"), 2, 1e-12);
            EXPECT_LE(number("max_aspect_ratio"), 5.6);
        }
    }
}

// A piston comes in through the top, faster and faster, and the gas goes out through the bottom: u = v(t), p = rho a (z - z_min).
TEST(RunSolids, APistonPushesTheGasOut) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", R"toml([domain]
min = [0, 0, 0]
max = [1, 1, 2]
[[body]]
name = "piston"
shape = "slab"
min = [0, 0, 1.5]
max = [1, 1, 2]
[body.motion]
z = "-0.4*t - 0.2*t^2"
[size]
surface = 0.25
growth = 0.3
far = 0.4
[time]
end = 1
steps = 5
[flow]
[flow.region.surroundings]
density = 2
viscosity = 0.01
initial = [0, 0, -0.4]
[flow.face]
x_min = "slip"
x_max = "slip"
y_min = "slip"
y_max = "slip"
z_min = { pressure = 0 }
[heat.region.surroundings]
density = 2
specific_heat = 1000
conductivity = 1e-6
initial = 500
[heat.region.piston]
density = 10
specific_heat = 800
conductivity = 1e-6
initial = 500
)toml");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (std::size_t step = 0; step < 5; ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        const double t = 0.2 * (double(step) + 1), dt = 0.2, speed = 0.4 + 0.4 * t, mean = 0.4 + 0.4 * t - 0.2 * dt;
        EXPECT_NEAR(number("volume_out_z_min"), speed, 1e-10 * speed);
        EXPECT_NEAR(number("volume_out_z_max"), 0, 1e-12);
        EXPECT_NEAR(number("force_z_piston"), 2 * 0.4 * (1.5 - 0.4 * t - 0.2 * t * t), 1e-3) << "of what it accelerates";
        EXPECT_NEAR(number("heat_by_volume"), 0, 1e-6) << "all that goes passes a face";
        EXPECT_NEAR(number("heat_out_z_max"), -10 * 800 * 500 * mean, 1e-9 * 4e6);
        EXPECT_NEAR(number("heat_out_z_min"), 2 * 1000 * 500 * mean, 1e-9 * 4e6);
        EXPECT_NEAR(number("energy_error"), 0, 1e-12 * number("energy_integral"));
        EXPECT_NEAR(number("temperature_min_piston"), 500, 1e-9);
    }
}

constexpr std::string_view fed_wire = R"toml([domain]
min = [-4, -4, 0]
max = [4, 4, 8]
[[body]]
name = "wire"
shape = "cylinder"
from = [0, 0, 6]
to = [0, 0, 8]
radius = 1
[body.motion]
z = "-t"
[size]
surface = 0.4
growth = 0.4
far = 1.5
[time]
end = 2
steps = 6
[heat.region.surroundings]
density = 1
specific_heat = 1000
conductivity = 1e-6
initial = 300
[heat.region.wire]
density = 7000
specific_heat = 800
conductivity = 1e-6
initial = "300 + 100*(z - 6)"
[[species]]
name = "dye"
[species.region.wire]
diffusivity = 1e-9
initial = 1
)toml";

TEST(RunSolids, AWireBringsInWhatItHas) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(fed_wire));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    double volume = 0;
    for (std::size_t step = 0; step < 6; ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        const double came = (double(step) + 1) / 3;  // as warm as the face was: 500 K
        EXPECT_NEAR(number("temperature_mean_wire"), (2 * 400 + came * 500) / (2 + came), 0.052);
        EXPECT_GE(number("temperature_min_wire"), 300 - 1e-9);
        EXPECT_LE(number("temperature_max_wire"), 500 + 1e-9);
        EXPECT_NEAR(number("energy_error"), 0, 1e-12 * number("energy_integral"));
        EXPECT_NEAR(number("dye_integral") / number("volume_wire"), 1, 1e-12);
        if (step == 1) {
            const double displaced = 3 * (number("volume_wire") - volume);  // gas at 300 K, or a little warmed, has to go
            EXPECT_NEAR(number("heat_by_volume"), -1000 * 300 * displaced, 0.005 * 1000 * 300 * displaced);
        }
        volume = number("volume_wire");
    }
}

// Gas that flows in beside the wire would be what its velocity brings through a wall.
TEST(RunSolids, NothingFlowsInBesideAWireThroughAWall) {
    const TemporaryFolder folder;
    const std::string text = std::string(fed_wire.substr(0, fed_wire.find("[heat.region"))) +
                             "[flow.region.surroundings]\ndensity = 1\nviscosity = 0.1\n[flow.face]\nx_min = { pressure = 0 }\n";
    write(folder.path / "a.toml", text);
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (std::size_t step = 0; step < 6; ++step) {
        EXPECT_NEAR(std::stod(columns.at("volume_out_z_max")[step]), 0, 1e-12);
        EXPECT_NEAR(std::stod(columns.at("volume_out_x_min")[step]), std::stod(columns.at("volume_wire")[5]) / 4, 0.0135);
        EXPECT_LE(std::stod(columns.at("max_aspect_ratio")[step]), 6);
    }
    write(folder.path / "closed.toml", replaced(text, "[flow.face]\nx_min = { pressure = 0 }\n", ""));
    const Outcome refused = kropla_program(folder, "run closed.toml --out e");
    EXPECT_EQ(refused.code, 2);
    expect_one_line(refused.err, "m^3/s flow in without a way out at t = 0.333333 s: open a face");
}

// A gas whose density is of the temperature is pushed out by a hot wire; its temperature is what energy and density make of it.
TEST(RunSolids, AHotWireIsFedIntoGasThatExpands) {
    const TemporaryFolder folder;
    std::string text = replaced(fed_wire, "density = 1\n", "density = \"300/T\"\n");
    text = text.substr(0, text.find("[[species]]")) + "[flow.region.surroundings]\ndensity = \"300/T\"\nviscosity = 0.05\n"
                                                      "[flow.face]\nx_min = { pressure = 0 }\n";
    write(folder.path / "a.toml", replaced(replaced(text, "conductivity = 1e-6", "conductivity = 1"), "300 + 100*(z - 6)", "1000"));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (std::size_t step = 0; step < 6; ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        EXPECT_NEAR(number("energy_error"), 0, 1e-12 * number("energy_integral"));
        EXPECT_NEAR(number("mass_error_surroundings"), 0, 1e-12);
        EXPECT_LE(number("temperature_max_wire"), 1000 + 1e-7);
        EXPECT_GT(number("volume_out_x_min"), 1) << "what the wire displaces at the least; the gas is warmed, too";
        const std::string frame = contents(folder.path / "d/frames" / ("0000" + std::to_string(step + 1) + ".vtu"));
        const auto range = frame.find("RangeMin=\"", frame.find("Name=\"temperature\"")) + 10;
        EXPECT_GE(std::stod(frame.substr(range, 20)), 300 - 1e-7) << "of the gas";
    }
}

// A pool covers the floor and a part of the sides; what comes in there is of the region that is there.
TEST(RunSolids, SpeciesComeInThroughFacesThatABodyReaches) {
    constexpr std::string_view text = R"toml([domain]
min = [-1, -1, 0]
max = [1, 1, 2]
[[body]]
name = "pool"
shape = "slab"
min = [-1, -1, 0]
max = [1, 1, 0.5]
[body.motion]
z = "0.1*t"
[size]
surface = 0.3
growth = 0.4
far = 0.5
[time]
end = 2
steps = 2
[[species]]
name = "dye"
[species.region.surroundings]
diffusivity = 1
initial = 1
[species.region.pool]
diffusivity = 1e-3
initial = 2
[species.face]
z_min = { flux = 0.5 }
x_min = { value = 3 }
y_max = { flux = -0.01 }
)toml";
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(text));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (const std::string& error : columns.at("dye_error")) EXPECT_NEAR(std::stod(error), 0, 1e-12 * 9);
    const std::string only_fluxes =
        replaced(replaced(text, "x_min = { value = 3 }\n", ""), "[body.motion]\nz = \"0.1*t\"\n", "");
    write(folder.path / "b.toml", only_fluxes);
    const Outcome again = kropla_program(folder, "run b.toml --out e");
    ASSERT_EQ(again.code, 0) << again.err;
    const double start = 4 * (0.5 * 2 + 1.5), came = 2 * (4 * 0.5 - 4 * 0.01);
    EXPECT_NEAR(std::stod(lasting_columns(folder.path / "e").at("dye_integral")[1]), start + came, 1e-11);
    write(folder.path / "c.toml", replaced(replaced(only_fluxes, "[species.region.surroundings]\ndiffusivity = 1\ninitial = 1\n", ""),
                                           "y_max = { flux = -0.01 }\n", ""));
    EXPECT_EQ(kropla_program(folder, "run c.toml --out f").code, 0) << "the pool reaches faces";
}

/// Before anything is meshed, or with the first mesh. With a prism at hand.
void expect_run_refused(const std::string& text, const std::string& start) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", text);
    write(folder.path / "prism.obj", prism(6, 0.7, 0.7));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.err.find(start), std::string::npos) << ended.err;
}

TEST(RunSolids, ThroughAFaceOnlyUpright) {
    expect_run_refused(replaced(pool_case, "from = [0, 0, 1.5]", "from = [-0.3, 0, 1.5]"),
                       "body \"wire\": at t = 166.667 ms its motion takes it through the wall z max, on which it does not stand upright at (");
    const std::string tilts = "min = [-0.5, -0.5, 0]\nmax = [0.5, 0.5, 0.5]\n[body.motion]\nangle = \"40*t\"\naxis = [1, 0, 0]\n";
    expect_run_refused(replaced(pool_case, "min = [-1, -1, 0]\nmax = [1, 1, 0.5]\n", tilts),
                       "body \"pool\": at t = 166.667 ms its motion takes it through the wall z min, on which it does not stand upright at (");
}

TEST(RunSolids, OtherFacesAreNotReachedNorIsAnyLeft) {
    constexpr std::string_view block = "[domain]\nmin = [0, 0, 0]\nmax = [5, 5, 5]\n[size]\nsurface = 0.3\nfar = 1\n[time]\nend = 1\nsteps = 6\n"
                                       "[[body]]\nname = \"s\"\nshape = \"slab\"\nmin = [1, 1, -1]\nmax = [4, 4, 2]\n"
                                       "[body.motion]\nz = \"4*t\"\n";
    expect_run_refused(std::string(block), "body \"s\": at t = 750 ms it comes to the wall z max, which it does not reach through "
                                           "at the start; its motion is to end before");
    expect_run_refused(replaced(block, "4*t", "-2.5*t"), "body \"s\": at t = 800 ms nothing of its surface is left in the box");
    constexpr std::string_view as_slab = "shape = \"slab\"\nmin = [1, 1, -1]\nmax = [4, 4, 2]\n";
    constexpr std::string_view as_ball = "shape = \"sphere\"\ncentre = [2.5, 2.5, 0]\nradius = 1\ncut = true\n";
    expect_run_refused(replaced(replaced(block, as_slab, as_ball), "z = \"4*t\"", "x = \"2*t\""),
                       "body \"s\": at t = 750 ms it comes to the wall x max");
    constexpr std::string_view as_prism = "shape = \"surface\"\nfile = \"prism.obj\"\ncentre = [2.5, 2.5, 0]\ncut = true\n";
    expect_run_refused(replaced(replaced(block, as_slab, as_prism), "4*t", "2*t"),
                       "body \"s\": at t = 500.002 ms it leaves the wall z min, which it reaches through at the start");
}

TEST(RunSolids, ALineWithTooFewEdgesIsNamed) {
    expect_run_refused("[domain]\nmin = [-2.5, -2.5, 0]\nmax = [2.5, 2.5, 6]\n[[body]]\nname = \"ball\"\nshape = \"sphere\"\n"
                       "centre = [0, 0, 0.99]\nradius = 1\ncut = true\n[size]\nsurface = 0.4\ngrowth = 0.2\nfar = 0.8\n"
                       "[time]\nend = 1\nsteps = 1\n",
                       "body \"ball\": at its target size, 0.4 m there, the line in which it ends on the wall z min has too few edges, at (");
}

}  // namespace kropla
