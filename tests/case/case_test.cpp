#include "case/case.h"
#include "case/foresight.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace kropla {
namespace {

void expect_same(const Vec3& a, const Vec3& b) { EXPECT_TRUE(a == b) << a.x << ' ' << a.y << ' ' << a.z; }

void expect_same(const Quantity& a, const Quantity& b) {
    ASSERT_EQ(static_cast<bool>(a), static_cast<bool>(b));
    if (!a) return;
    for (const double t : {0.0, 1e-3, 0.7}) EXPECT_EQ(a({1, 2, 3}, t), b({1, 2, 3}, t));
}

void expect_same(const Body& a, const Body& b) {
    EXPECT_EQ(a.name, b.name);
    expect_same(a.shape.centre, b.shape.centre);
    expect_same(a.shape.semi_axes, b.shape.semi_axes);
    for (std::size_t i = 0; i < 3; ++i) expect_same(a.shape.orientation.axes[i], b.shape.orientation.axes[i]);
    for (const double t : {0.0, 1e-3, 0.7}) expect_same(a.motion(t).displacement, b.motion(t).displacement);
}

void expect_same(const HeatOptions& a, const HeatOptions& b) {
    ASSERT_EQ(a.regions.size(), b.regions.size());
    for (std::size_t r = 0; r < a.regions.size(); ++r) {
        EXPECT_EQ(a.regions[r].material.conductivity, b.regions[r].material.conductivity);
        EXPECT_EQ(a.regions[r].material.density, b.regions[r].material.density);
        EXPECT_EQ(a.regions[r].material.specific_heat, b.regions[r].material.specific_heat);
        EXPECT_EQ(a.regions[r].initial.value, b.regions[r].initial.value);
        EXPECT_EQ(a.regions[r].carried, b.regions[r].carried);
        expect_same(a.regions[r].source, b.regions[r].source);
    }
    for (std::size_t f = 0; f < 6; ++f) {
        EXPECT_EQ(a.faces[f].kind, b.faces[f].kind);
        expect_same(a.faces[f].quantity, b.faces[f].quantity);
    }
}

void expect_same(const Case& a, const Case& b) {
    expect_same(a.domain.box.min, b.domain.box.min);
    expect_same(a.domain.box.max, b.domain.box.max);
    ASSERT_EQ(a.domain.bodies.size(), b.domain.bodies.size());
    for (std::size_t i = 0; i < a.domain.bodies.size(); ++i)
        expect_same(a.domain.bodies[i], b.domain.bodies[i]);
    EXPECT_EQ(a.domain.size.surface, b.domain.size.surface);
    EXPECT_EQ(a.domain.size.growth, b.domain.size.growth);
    EXPECT_EQ(a.domain.size.far, b.domain.size.far);
    EXPECT_EQ(a.quality.max_aspect_ratio, b.quality.max_aspect_ratio);
    ASSERT_EQ(a.quality.paper.has_value(), b.quality.paper.has_value());
    if (a.quality.paper) {
        EXPECT_EQ(a.quality.paper->weights.x1, b.quality.paper->weights.x1);
        EXPECT_EQ(a.quality.paper->weights.x2, b.quality.paper->weights.x2);
    }
    EXPECT_EQ(a.time.end, b.time.end);
    EXPECT_EQ(a.time.steps, b.time.steps);
    ASSERT_EQ(a.heat.has_value(), b.heat.has_value());
    if (a.heat) expect_same(*a.heat, *b.heat);
    EXPECT_EQ(a.output.every, b.output.every);
    EXPECT_EQ(a.random.seed, b.random.seed);
}

TEST(ReadCase, EveryKeyArrives) {
    const Case given = parse_case(full_case, "full.toml");
    expect_same(given.domain.box.min, {-0.004, -0.004, 0});
    ASSERT_EQ(given.domain.bodies.size(), 2u);
    expect_same(given.domain.bodies[0].motion(0.002).displacement,
                {0.0003 * std::sin(4 * 3.14159265358979323846 * 0.002 / 0.01), 0, -0.002});
    expect_same(given.domain.bodies[1].motion(0.002).displacement, {0, 0, 0});
    expect_same(given.domain.bodies[1].shape.semi_axes, {1e-3, 0.8e-3, 0.7e-3});
    EXPECT_FALSE(given.domain.bodies[1].shape.orientation.axes[0] == Vec3(1, 0, 0));  // it was turned
    EXPECT_EQ(given.domain.size.growth, 0.15);
    EXPECT_EQ(given.quality.max_aspect_ratio, 9.5);
    EXPECT_EQ(given.time.steps, 40);
    ASSERT_TRUE(given.heat);
    EXPECT_EQ(given.heat->regions[0].carried, Carried::with_flow);
    EXPECT_EQ(given.heat->regions[1].carried, Carried::with_mesh);
    EXPECT_EQ(given.heat->regions[1].source({1e-3, 0.5, 0.25}, 2), 1e6 * 1e-3 * 2 + 0.5 - 0.25);
    EXPECT_FALSE(given.heat->regions[2].source);
    EXPECT_EQ(given.heat->faces[0].kind, HeatFace::Kind::value);
    EXPECT_EQ(given.heat->faces[0].quantity({}, 1), 300);
    EXPECT_EQ(given.heat->faces[3].kind, HeatFace::Kind::flux);
    EXPECT_EQ(given.heat->faces[3].quantity({}, 0.5), 1e4 * std::sin(0.5));
    EXPECT_EQ(given.heat->faces[1].kind, HeatFace::Kind::insulated);
    EXPECT_EQ(given.output.every, 5);
    EXPECT_EQ(given.random.seed, 9223372036854775807u);
}

TEST(ReadCase, WhatIsLeftOutHasItsDefault) {
    const Case given = parse_case(
        "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[size]\nsurface = 0.1\nfar = 0.2\n"
        "[time]\nend = 1\nsteps = 2\n",
        "least.toml");
    EXPECT_TRUE(given.domain.bodies.empty());
    EXPECT_FALSE(given.heat);
    EXPECT_EQ(given.domain.size.growth, 0.1);
    EXPECT_EQ(given.quality.max_aspect_ratio, 10);
    EXPECT_EQ(given.output.every, 1);
    EXPECT_EQ(given.random.seed, 1u);
    EXPECT_NE(to_toml(given).find("max_aspect_ratio = 10\n"), std::string::npos);
    EXPECT_NE(to_toml(given).find("every = 1\n"), std::string::npos);
}

TEST(ReadCase, TheMethodIsOursOrThePapers) {
    const auto quality = [](const std::string& lines) {
        return parse_case(replaced(full_case, "max_aspect_ratio = 9.5", lines), "case.toml").quality;
    };
    EXPECT_FALSE(quality("max_aspect_ratio = 9.5").paper);
    EXPECT_FALSE(quality("method = \"kropla\"").paper);
    ASSERT_TRUE(quality("method = \"paper\"").paper);
    EXPECT_EQ(quality("method = \"paper\"").paper->weights.x1, PaperMethod{}.weights.x1);
    const auto weighted = quality("method = \"paper\"\nweights = [0, 0.25]").paper;
    ASSERT_TRUE(weighted);
    EXPECT_EQ(weighted->weights.x1, 0);
    EXPECT_EQ(weighted->weights.x2, 0.25);
}

TEST(WriteCase, KeepsTheMethod) {
    for (const std::string method : {"method = \"kropla\"", "method = \"paper\"\nweights = [0.5, 1]"}) {
        const Case given = parse_case(replaced(full_case, "max_aspect_ratio = 9.5", method), "case.toml");
        EXPECT_NE(to_toml(given).find(method), std::string::npos);
        expect_same(parse_case(to_toml(given), "written.toml"), given);
    }
}

TEST(WriteCase, ReadsAsTheSameCaseAgain) {
    const Case given = parse_case(full_case, "full.toml");
    const std::string written = to_toml(given);
    SCOPED_TRACE(written);
    const Case again = parse_case(written, "written.toml");
    expect_same(given, again);
    EXPECT_EQ(to_toml(again), written);
    EXPECT_NE(written.find("x = \"0.0003*sin(4*pi*t/0.01)\""), std::string::npos);  // as the user wrote it
    EXPECT_NE(written.find("y_max = { flux = \"1e4*sin(t)\" }"), std::string::npos);
}

TEST(WriteCase, KeepsEveryBitOfANumber) {
    Case given = parse_case(full_case, "full.toml");
    given.domain.size.surface = 0.1 + 0.2e-16;
    given.domain.size.far = 1.0 / 3.0;
    given.time.end = 123456789.123456789e-300;
    const Case again = parse_case(to_toml(given), "written.toml");
    EXPECT_EQ(again.domain.size.surface, given.domain.size.surface);
    EXPECT_EQ(again.domain.size.far, given.domain.size.far);
    EXPECT_EQ(again.time.end, given.time.end);
}

TEST(Cases, OfTheProjectAreRight) {
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(KROPLA_CASES)) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path().string());
        const Case given = read_case(entry.path());
        EXPECT_TRUE(foresee(given).empty());
        expect_same(given, parse_case(to_toml(given), "written.toml"));
        ++read;
    }
    EXPECT_GE(read, 7);
}

TEST(Cases, TheTwoDropletsPassAtHalfARadius) {
    const Case given = read_case(std::filesystem::path(KROPLA_CASES) / "two_droplets.toml");
    double least = 1;
    for (int i = 0; i <= 1000; ++i) {
        const double t = given.time.end * i / 1000;
        const Shape a = shape_at(given.domain.bodies[0], t), b = shape_at(given.domain.bodies[1], t);
        least = std::min(least, distance(a.centre, b.centre) - a.semi_axes.x - b.semi_axes.x);
    }
    EXPECT_NEAR(least, 0.5 * given.domain.bodies[0].shape.semi_axes.x, 1e-12);
}

TEST(Cases, TheLayeredDropletsPassTheWallAndEachOtherAtThreeTenthsOfARadius) {
    const auto case_named = [](const char* name) { return read_case(std::filesystem::path(KROPLA_CASES) / name); };
    const Case wall = case_named("near_wall.toml"), miss = case_named("near_miss.toml");
    double to_wall = 1, to_other = 1;
    for (int i = 0; i <= 1000; ++i) {
        to_wall = std::min(to_wall, bounds(shape_at(wall.domain.bodies[0], wall.time.end * i / 1000)).min.z);
        const double t = miss.time.end * i / 1000;
        const Shape a = shape_at(miss.domain.bodies[0], t), b = shape_at(miss.domain.bodies[1], t);
        to_other = std::min(to_other, distance(a.centre, b.centre) - a.semi_axes.x - b.semi_axes.x);
    }
    EXPECT_NEAR(to_wall, 0.3e-3, 1e-12);
    EXPECT_NEAR(to_other, 0.3e-3, 1e-12);
    for (const Case& given : {wall, miss, case_named("droplet_layer.toml"), case_named("tumbling.toml")})
        for (const Body& body : given.domain.bodies) EXPECT_TRUE(body.layer);
}

TEST(Estimate, CountsWhatAUniformSizeGives) {
    Domain domain{
        .box = {{0, 0, 0}, {1, 1, 2}}, .bodies = {}, .size = {.surface = 0.1, .growth = 0, .far = 0.1}};
    EXPECT_NEAR(estimate_tets(domain), 2 * 6 * std::sqrt(2.0) / 1e-3,
                1e-6);  // volume by that of a perfect tet
}

// Whatever part of it the grid sees, the integral of 1/h^3 around a sphere is the one in closed form (far
// away the size is so large that it does not count).
TEST(Estimate, SeesSizesFinerThanItsGrid) {
    for (const double surface : {1e-2, 1e-3, 1e-4}) {
        SCOPED_TRACE(surface);
        const double radius = 0.2, growth = 0.5;
        Domain domain{.box = {{-1, -1, -1}, {1, 1, 1}},
                      .bodies = {{"b", {{0, 0, 0}, {radius, radius, radius}, {}}}},
                      .size = {.surface = surface, .growth = growth, .far = 10}};
        double expected =
            0;  // over shells of the ball of radius 1; the corners of the box add less than a percent
        double inner = 0;
        for (int i = 1; i <= 2'000'000; ++i, inner += 5e-7) {
            const double r = inner + 2.5e-7;
            const double h = surface + growth * std::abs(r - radius);
            expected += 4 * 3.14159265358979323846 * r * r * 5e-7 * 6 * std::sqrt(2.0) / (h * h * h);
        }
        EXPECT_NEAR(estimate_tets(domain) / expected, 1, 0.15);
    }
}

// A layer that ends in thin prisms makes its wall finer: as if that size had been asked for.
TEST(Estimate, SeesWallsThatTheirLayerMakesFiner) {
    Domain domain{.box = {{-1, -1, -1}, {1, 1, 1}},
                  .bodies = {{"b", {{0, 0, 0}, {0.2, 0.2, 0.2}, {}}}},
                  .size = {.surface = 0.05, .growth = 0.5, .far = 10}};
    domain.bodies[0].layer = LayerOptions{.count = 1, .first_height = 1e-3};
    const double fine = surface_size(snapshot(domain, 0), 0), seen = estimate_tets(domain);
    ASSERT_LT(fine, 0.02);
    domain.bodies[0].layer.reset();
    domain.size.surface = fine;
    EXPECT_NEAR(seen, estimate_tets(domain), 1e-9 * seen);
}

}  // namespace
}  // namespace kropla
