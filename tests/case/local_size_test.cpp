// Sizes by expressions of the place.
#include "case/local_size.h"

#include "case/case.h"
#include "case_text.h"
#include <kropla/mesh/topology.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace kropla {
namespace {

constexpr std::string_view two_balls = R"toml([parameters]
fine = 0.05
[domain]
min = [0.0, 0.0, 0.0]
max = [2.0, 1.0, 1.0]
[[body]]
name = "a"
shape = "sphere"
centre = [0.5, 0.5, 0.5]
radius = 0.2
size = "fine + 0.2*(x - 0.3)"
[body.motion]
x = "0.1*t"
[[body]]
name = "b"
shape = "sphere"
centre = [1.5, 0.5, 0.5]
radius = 0.2
[size]
surface = "0.07 + 0.1*abs(z - 0.5)"
growth = 0.3
far = 0.2
[time]
end = 1.0
steps = 4
)toml";

template <class Ask>
std::string refusal_of(const Ask& ask) {
    try {
        ask();
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(LocalSize, IsReadWithTheMostOnTheSurfacesAtTheStart) {
    const Case given = parse_case(std::string(two_balls), "case.toml");
    EXPECT_NEAR(*given.domain.bodies[0].size, 0.13, 0.002);
    EXPECT_NEAR(given.domain.size.surface, 0.09, 0.002);
    const Snapshot at = snapshot(given.domain, 0);
    EXPECT_NEAR(surface_size(at, 0, {0.2, 0.5, 0.5}), 0.05, 1e-15);
    EXPECT_NEAR(surface_size(at, 1, {1.5, 0.5, 1}), 0.09, 0.002);
    EXPECT_NEAR(surface_size(at, 1, {2, 0.5, 0.5}), 0.07, 1e-15);
}

TEST(LocalSize, IsWrittenAsItWasRead) {
    const std::string written = to_toml(parse_case(std::string(two_balls), "case.toml"));
    EXPECT_EQ(to_toml(parse_case(written, "again.toml")), written);
    EXPECT_NE(written.find("size = \"fine + 0.2*(x - 0.3)\"  # = 0.1"), std::string::npos);
    EXPECT_NE(written.find("surface = \"0.07 + 0.1*abs(z - 0.5)\"  # = 0.0"), std::string::npos);
}

TEST(LocalSize, RefusalsNameKeyLineAndPlace) {
    const auto refused = [](std::string_view to) {
        return refusal(replaced(two_balls, "\"fine + 0.2*(x - 0.3)\"", to)).substr(sizeof("case.toml: body[0].size (line 11): ") - 1);
    };
    EXPECT_EQ(refused("\"0.1 - x\""), "must be a positive length everywhere, but is -0.28453 m at (0.38453, 0.38453, 0.38453) m");
    EXPECT_EQ(refused("\"0.1*x/0\""), "must be a positive length everywhere, but is inf m at (0.38453, 0.38453, 0.38453) m");
    EXPECT_EQ(refused("\"0.1 + x*t\""),
              "\"0.1 + x*t\": \"t\" at character 9 is not known; known are x, y, z, fine, pi and functions such as sin, exp, sqrt");
    EXPECT_EQ(refused("\"0.3 + 0*x\""), "must be at most size.far = 0.2, got \"0.3 + 0*x\"");
    EXPECT_EQ(refused("\"-0.3\""), "must be positive, got \"-0.3\" = -0.3");
    const std::string own = replaced(two_balls, "radius = 0.2\n[size]", "radius = 0.2\nsize = 0.1\n[size]");
    EXPECT_EQ(refusal(own), "case.toml: size.surface (line 21): must be a length: there is no body without one of its own, at whose "
                            "places it could be asked for, got \"0.07 + 0.1*abs(z - 0.5)\"");
}

TEST(LocalSize, OnTheWayItIsAskedForWhereTheBodyIs) {
    Case given = parse_case(replaced(two_balls, "fine + 0.2*(x - 0.3)", "0.13 - 0.18*max(x - 0.5, 0)"), "case.toml");
    const Snapshot later = snapshot(given.domain, 1);
    EXPECT_NEAR(surface_size(later, 0, {1, 0.5, 0.5}), 0.13 - 0.18 * 0.3, 1e-15);
    given = parse_case(replaced(two_balls, "fine + 0.2*(x - 0.3)", "0.1*(x < 0.75)"), "case.toml");
    EXPECT_EQ(refusal_of([&] { (void)surface_size(snapshot(given.domain, 1), 0, {1, 0.5, 0.5}); }),
              "case.toml: body[0].size (line 11): must be a positive length everywhere, but is 0 m at (0.8, 0.5, 0.5) m");
}

// The mean edge of the surface on either side, by the size there.
TEST(LocalSize, TheInitialMeshHasIt) {
    const Case given = parse_case(std::string(two_balls), "case.toml");
    const Mesh mesh = initial_mesh(given.domain, 1);
    double sum = 0, count = 0;
    for (const Tet t : all_tets(mesh, Region(1)))
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (mesh.region[n] == Region(1)) continue;
            const auto [a, b, c] = facet_vertices(mesh, {t, corner});
            for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, a}}) {
                const double x = 0.5 * (mesh.position[p].x + mesh.position[q].x);
                sum += distance(mesh.position[p], mesh.position[q]) / (0.05 + 0.2 * (x - 0.3));
                ++count;
            }
        }
    EXPECT_NEAR(sum / count, 1, 0.05);
    EXPECT_NEAR(estimate_tets(given.domain) / count_tets(mesh), 1, 0.2);
}

}  // namespace
}  // namespace kropla
