#include "base/random.h"
#include "meshes.h"
#include "session.h"
#include "simulate/elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr Vec3 middle{0.5, 0.5, 0.5};
constexpr Region body{1};

/// The largest distance from the middle along an axis: 0.5 on the box, 0.25 on the outermost shell.
double distance_from_middle(const Vec3& x) {
    return std::max({std::abs(x.x - 0.5), std::abs(x.y - 0.5), std::abs(x.z - 0.5)});
}

/// The unit cube with a body, two prisms around it of 0.0375 each and two inside it of 0.021.
Mesh cube_with_layers(int n) {
    const Mesh outside = with_layer(unit_cube_with_body(n), middle, surroundings, 2, 0.3);
    return with_layer(outside, middle, body, 2, 0.24);
}

Array<Vertex, char> vertices_of_walls(const Mesh& mesh) {
    Array<Vertex, char> on_wall(mesh.position.size(), 0);
    for (const PrismLayer& layer : mesh.layers)
        for (int c = 0; c < count_columns(layer); ++c) on_wall[column_vertex(layer, c, 0)] = 1;
    return on_wall;
}

/// Every column as many times its height.
void squeeze(Mesh& mesh, double factor) {
    for (const PrismLayer& layer : mesh.layers)
        for (int column = 0; column < count_columns(layer); ++column) {
            const Vec3 wall = mesh.position[column_vertex(layer, column, 0)];
            for (int k = 1; k <= layer.count; ++k) {
                Vec3& x = mesh.position[column_vertex(layer, column, k)];
                x = wall + factor * (x - wall);
            }
        }
}

/// Moves each vertex that is on no wall by up to `amount` along each axis, those on the box along it.
void shake(Mesh& mesh, double amount, std::uint64_t seed) {
    Random random{seed};
    const auto on_wall = vertices_of_walls(mesh);
    for (Vertex v : mesh.position.indices())
        for (int axis = 0; axis < 3; ++axis) {
            const double shaken = random.uniform(-amount, amount), at = mesh.position[v][axis];
            if (!on_wall[v] && at != 0 && at != 1) mesh.position[v][axis] += shaken;
        }
}

/// The body with its layers turned about z and shifted, what is around following.
void move_body(Mesh& mesh, const Mesh& start, const Vec3& shift, double angle) {
    for (Vertex v : mesh.position.indices()) {
        const Vec3 r = mesh.position[v] - middle;
        const double s = std::clamp((0.5 - distance_from_middle(start.position[v])) / 0.25, 0.0, 1.0);
        const double c = std::cos(s * angle), d = std::sin(s * angle);
        mesh.position[v] = middle + Vec3{c * r.x - d * r.y, d * r.x + c * r.y, r.z} + s * shift;
    }
}

struct Motion {
    double squeezed;  // [-] columns at the end of the run to those at its start
    double shaken;    // [m]
};

Mesh position_of_step(const Mesh& start, const Motion& motion, int step) {
    const double s = std::sin(1.3 * step);
    Mesh mesh = start;
    squeeze(mesh, 1 + (motion.squeezed - 1) * step / 5);
    move_body(mesh, start, {0.06 * s, -0.03 * step / 4.0, 0.08 * s * s}, 0.05 * step);
    shake(mesh, motion.shaken, 100u + unsigned(step));
    return mesh;
}

/// Steel in argon, in metres and seconds that suit the unit cube.
HeatOptions droplet_in_gas() {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0] = {.material = {.conductivity = 60, .density = 1.6, .specific_heat = 520},
                          .carried = Carried::with_flow, .initial = 300};
    options.regions[1] = {.material = {.conductivity = 3e4, .density = 7000, .specific_heat = 800},
                          .carried = Carried::with_mesh, .initial = 2500};
    return options;
}

// The layers rigid; squeezed; squeezed, and every vertex moves.
constexpr Motion motions[] = {{1, 0}, {0.4, 0}, {0.6, 0.004}};

testing::Message to_text(const Motion& motion) {
    return testing::Message() << "squeezed to " << motion.squeezed << ", shaken by " << motion.shaken;
}

TEST(HeatLayer, ThePartsFillTheCube) {
    const Mesh mesh = position_of_step(cube_with_layers(8), motions[2], 3);
    const Cells cells = living_cells(mesh);
    ASSERT_EQ(cells.prisms.size(), 2u * 2 * 192);  // 192 triangles on the body
    double volume = 0;
    for_each_cell(cells, [&](const auto& cell) {
        for (const auto& point : cell_points(corners(mesh, cell))) {
            EXPECT_GT(point.volume, 0);
            volume += point.volume;
        }
    });
    EXPECT_NEAR(volume, 1, 1e-13);
    const RegionSurface gas = region_surface(mesh, surroundings), steel = region_surface(mesh, body);
    EXPECT_EQ(gas.interface.size(), 192u);
    EXPECT_EQ(steel.interface.size(), 192u);
    EXPECT_EQ(gas.outer.size(), 6u * 64 * 2);
    EXPECT_EQ(steel.outer.size(), 0u);
}

TEST(HeatLayer, LinearTemperaturesAreExactOnDistortedPrisms) {
    Mesh mesh = cube_with_layers(4);
    shake(mesh, 0.006, 17);
    const auto linear = [](const Vec3& x, double) { return 3 + 2 * x.x - 5 * x.y + 7 * x.z; };
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.faces.fill({HeatFace::Kind::value, linear});
    NodalField field = initial_temperature(mesh, options);
    step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 1e13);  // the steady state
    for (Vertex v : mesh.position.indices())
        EXPECT_NEAR(field.values[v], linear(mesh.position[v], 0), 1e-10) << "seed 17, vertex " << v.value;
}

TEST(HeatLayer, ConstantStateIsKept) {
    const Mesh start = cube_with_layers(8);
    HeatOptions options = droplet_in_gas();
    options.regions[0].initial = options.regions[1].initial = 300;
    for (const Motion& motion : motions) {
        SCOPED_TRACE(to_text(motion));
        NodalField field = initial_temperature(start, options);
        Mesh before = position_of_step(start, motion, 0);
        for (int step = 1; step <= 5; ++step) {
            const Mesh current = position_of_step(start, motion, step);
            const auto report =
                step_heat(petsc().all_ranks(), before, current, options, field, 0.1 * step, 0.1);
            EXPECT_GT(report.potential_iterations, 0);  // the body did push gas
            EXPECT_LT(largest_difference(current, field, 300) / 300, 1e-12) << "step " << step;
            before = current;
        }
    }
}

TEST(HeatLayer, EnergyIsConserved) {
    const Mesh start = cube_with_layers(8);
    const HeatOptions options = droplet_in_gas();
    for (const Motion& motion : motions) {
        SCOPED_TRACE(to_text(motion));
        Mesh before = position_of_step(start, motion, 0);
        NodalField field = initial_temperature(before, options);
        const double begin = energy(before, options, field.values),
                     of_gas = energy(before, options, field.values, surroundings);
        for (int step = 1; step <= 5; ++step) {
            const Mesh current = position_of_step(start, motion, step);
            const double of_body = energy(before, options, field.values, body);
            const auto report =
                step_heat(petsc().all_ranks(), before, current, options, field, 0.1 * step, 0.1);
            EXPECT_NEAR(energy(current, options, field.values) / begin, 1, 1e-11) << "step " << step;
            const double lost = of_body - energy(current, options, field.values, body);
            EXPECT_NEAR(report.surfaces.at(0).total * 0.1, lost, 1e-11 * begin) << "step " << step;
            before = current;
        }
        const double gas = energy(before, options, field.values, surroundings);
        EXPECT_GT(gas, 1.5 * of_gas);  // heat did flow
        EXPECT_NEAR(gas + energy(before, options, field.values, body), energy(before, options, field.values),
                    1e-12 * begin);
    }
}

TEST(HeatLayer, BodyWinsAtItsSurface) {
    const Mesh mesh = cube_with_layers(4);
    const NodalField field = initial_temperature(mesh, droplet_in_gas());
    const auto of_body = vertices_of(mesh, body);
    EXPECT_EQ(std::ranges::count(of_body, 1), 27 + 2 * 26);  // the grid's; two more per column
    for (Vertex v : mesh.position.indices()) EXPECT_EQ(field.values[v], of_body[v] ? 2500 : 300);
}

// A hot wall heats the gas at rest around it while the layer is squeezed: temperatures stay between the two.
TEST(HeatLayer, NoTemperatureBeyondThoseAtTheStart) {
    const Mesh start = cube_with_layers(8);
    const HeatOptions options = droplet_in_gas();
    Mesh before = position_of_step(start, motions[1], 0);
    NodalField field = initial_temperature(before, options);
    for (int step = 1; step <= 5; ++step) {
        const Mesh current = position_of_step(start, motions[1], step);
        step_heat(petsc().all_ranks(), before, current, options, field, 0.1 * step, 0.1);
        before = current;
    }
    double least = 2500, largest = 300;
    for (Vertex v : before.position.indices()) {
        least = std::min(least, field.values[v]);
        largest = std::max(largest, field.values[v]);
    }
    RecordProperty("range", std::to_string(least) + " " + std::to_string(largest));
    EXPECT_GT(least, 300 - 22);  // 1 % of the jump
    EXPECT_LT(largest, 2500 + 22);
}

// A body with layers at rest, the vertices around its wall and inside it swinging, with T given and the
// source that it needs.
double manufactured_error(int n, int steps) {
    const double end = 0.2, k = 0.2;
    const auto exact = [](const Vec3& x, double t) {
        return std::sin(x.x + x.y + t) + std::cos(x.y - x.z + 2 * t);
    };
    const auto source = [k](const Vec3& x, double t) {
        const double a = x.x + x.y + t, b = x.y - x.z + 2 * t;
        return std::cos(a) - 2 * std::sin(b) + 2 * k * (std::sin(a) + std::cos(b));
    };
    const HeatRegion region{.material = {.conductivity = k}, .source = source};
    HeatOptions options{.regions = {region, region}};
    options.faces.fill({HeatFace::Kind::value, exact});
    const Mesh start = with_layer(
        with_layer(unit_cube_with_body(n), middle, surroundings, n / 4, 0.36), middle, body, n / 4, 0.3);
    const auto at = [&](double t) {
        Mesh mesh = start;
        for (Vec3& x : mesh.position) {
            const double off_wall = distance_from_middle(x) - 0.16;
            const double bump = off_wall * std::sin(pi * x.x) * std::sin(pi * x.y) * std::sin(pi * x.z);
            x += 0.3 * std::sin(2 * pi * t) * bump * Vec3{1, -0.5, 0.7};
        }
        return mesh;
    };
    Mesh before = at(0);
    NodalField field = initial_temperature(before, options);
    for (Vertex v : before.position.indices()) field.values[v] = exact(before.position[v], 0);
    for (int step = 0; step < steps; ++step) {
        const Mesh current = at((step + 1) * end / steps);
        step_heat(petsc().all_ranks(), before, current, options, field, step * end / steps, end / steps);
        before = current;
    }
    return l2_error(before, field, [&](const Vec3& x) { return exact(x, end); });
}

TEST(HeatLayer, ManufacturedSolutionIsOfSecondOrder) {
    const double a = manufactured_error(4, 6), b = manufactured_error(8, 24), c = manufactured_error(12, 54);
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c));
    EXPECT_GT(std::log(a / b) / std::log(8.0 / 4), 1.9);  // dt as h^2: the order in space
    EXPECT_GT(std::log(b / c) / std::log(12.0 / 8), 1.9);
}

TEST(HeatLayer, TwoRanksFindWhatOneDoes) {
    if (petsc().all_ranks().count == 1) GTEST_SKIP() << "under mpirun only";
    const Mesh start = cube_with_layers(8);
    const HeatOptions options = droplet_in_gas();
    const Mesh before = position_of_step(start, motions[2], 0);
    const Mesh current = position_of_step(start, motions[2], 1);
    NodalField together = initial_temperature(before, options), alone = together;
    step_heat(petsc().all_ranks(), before, current, options, together, 0, 0.1);
    step_heat(petsc().this_rank(), before, current, options, alone, 0, 0.1);
    double largest = 0;
    for (Vertex v : current.position.indices())
        largest = std::max(largest, std::abs(together.values[v] - alone.values[v]));
    EXPECT_LT(largest, 1e-9 * 2500);  // both to 1e-12 in the norm over all vertices
    EXPECT_GT(largest_difference(current, together, 300), 1000);
}

}  // namespace
}  // namespace kropla
