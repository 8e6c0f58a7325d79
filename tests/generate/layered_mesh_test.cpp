#include <kropla/base/error.h>
#include "generate/domains.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace kropla;

namespace {

using Side = LayerOptions::Side;

Domain with_layers(Domain domain, const LayerOptions& layer) {
    for (Body& body : domain.bodies) body.layer = layer;
    return domain;
}

constexpr LayerOptions thin{3, 0.04, 1.3, Side::outside, {}};  // 0.16 thick, on triangles of 0.4

/// The cube roots of the volumes of tets on a shell, by those of the prisms below: the largest jump either
/// way.
double largest_jump(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    std::map<std::array<Vertex, 3>, double> below;
    for (int i = 0; i < static_cast<int>(layer.triangles.size()); ++i) {
        const Prism last{l, i, layer.count - 1};
        const auto v = prism_vertices(mesh, last);
        std::array<Vertex, 3> key = {v[3], v[4], v[5]};
        std::ranges::sort(key);
        below[key] = prism_volume(prism_corners(mesh, last));
    }
    double jump = 0;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) {
            if (mesh.patch[t][static_cast<std::size_t>(i)] != shell_patch(l) || aspect_ratio(mesh, t) > 10)
                continue;
            auto key = facet_vertices(mesh, {t, i});
            std::ranges::sort(key);
            const double ratio = std::cbrt(volume(mesh, t) / below.at(key));
            jump = std::max({jump, ratio, 1 / ratio});
        }
    return jump;
}

/// Everything that any initial mesh with layers must be; heights as asked if `roomy`.
void expect_layered_mesh(const Domain& domain, const Mesh& mesh, bool roomy) {
    EXPECT_EQ(verify(mesh), "");
    const Vec3 width = domain.box.max - domain.box.min;
    double total = 0;
    for (std::size_t body = 0; body <= domain.bodies.size(); ++body)
        total += region_volume(mesh, Region(body));
    EXPECT_NEAR(total / (width.x * width.y * width.z), 1, 1e-12);
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const PrismLayer& layer = mesh.layers[l];
        const auto body = static_cast<std::size_t>(layer.body.value) - 1;
        const Shape shape = shape_at(domain.bodies[body], 0);
        const LayerOptions& asked = *domain.bodies[body].layer;
        EXPECT_NEAR(region_volume(mesh, layer.body) / volume(shape), 1, 1e-12);
        const Shape larger = through(shape, mesh.position[column_vertex(layer, 0, 0)]);
        for (int column = 0; column < count_columns(layer); ++column) {
            const Vec3& wall = mesh.position[column_vertex(layer, column, 0)];
            EXPECT_NEAR(signed_distance(larger, wall) / shape.semi_axes.x, 0, 1e-12);
        }
        const LayerSummary summary = summarise_layer(mesh, Layer(l));
        EXPECT_GE(summary.min_jacobian, roomy ? 0.58 : 0.19);
        EXPECT_NEAR(summary.min_growth / asked.growth, 1, 1e-13);
        EXPECT_NEAR(summary.max_growth / asked.growth, 1, 1e-13);
        EXPECT_LT(summary.max_first_height / asked.first_height, 1 + 1e-9);
        if (roomy) EXPECT_NEAR(summary.min_first_height / asked.first_height, 1, 1e-13);
        else EXPECT_LT(summary.min_first_height, 0.99 * asked.first_height);
    }
}

double share_of_bad_tets(const Mesh& mesh) {
    int bad = 0;
    for (Tet t : mesh.tets.indices()) bad += aspect_ratio(mesh, t) > 10;
    return static_cast<double>(bad) / count_tets(mesh);
}

std::string error_of(const Domain& domain) {
    try {
        (void)generate_mesh(domain, 1);
    } catch (const DomainError& error) {
        return error.what();
    }
    return {};
}

void expect_error(const Domain& domain, std::initializer_list<const char*> parts) {
    const std::string error = error_of(domain);
    for (const char* part : parts)
        EXPECT_NE(error.find(part), std::string::npos) << part << " not in: " << error;
}

}  // namespace

TEST(LayeredMesh, OfASphereOnEitherSideAndOnBoth) {
    for (Side side : {Side::outside, Side::inside, Side::both}) {
        SCOPED_TRACE("side " + std::to_string(static_cast<int>(side)) + ", seed 1");
        LayerOptions layer = thin;
        layer.side = side;
        const Domain domain = with_layers(small_domain({ball({0, 0, 4}, 1.2)}), layer);
        const Mesh mesh = generate_mesh(domain, 1);
        EXPECT_EQ(mesh.layers.size(), side == Side::both ? 2u : 1u);
        expect_layered_mesh(domain, mesh, true);
        EXPECT_LT(share_of_bad_tets(mesh), 0.0053);
        for (std::size_t l = 0; l < mesh.layers.size(); ++l) EXPECT_LE(largest_jump(mesh, Layer(l)), 2);
    }
}

TEST(LayeredMesh, OfAnEllipsoid) {
    for (Side side : {Side::outside, Side::inside, Side::both}) {
        SCOPED_TRACE("side " + std::to_string(static_cast<int>(side)) + ", seed 2");
        Domain domain = small_domain({turned_ellipsoid({0, 0, 4}, {1.6, 0.8, 0.8})});
        domain.size.surface = 0.3;
        domain = with_layers(domain, {4, 0.02, 1.3, side, {}});
        expect_layered_mesh(domain, generate_mesh(domain, 2), true);
    }
}

TEST(LayeredMesh, WallsAreFinerWhereTheLayerEndsInThinPrisms) {
    const Domain domain = with_layers(small_domain({ball({0, 0, 4}, 0.8)}), {2, 0.01, 1.2, Side::both, {}});
    EXPECT_NEAR(surface_size(snapshot(domain, 0), 0), 0.18, 1e-12);  // 0.4 asked
    const Mesh mesh = generate_mesh(domain, 1);
    expect_layered_mesh(domain, mesh, true);
    for (Layer l : {Layer(0), Layer(1)}) EXPECT_LE(largest_jump(mesh, l), 2);
}

TEST(LayeredMesh, InsideIsThinnedAtSharpEnds) {
    Domain domain = small_domain({turned_ellipsoid({0, 0, 4}, {1.6, 0.8, 0.8})});  // the tips' radius: 0.4
    domain.size.surface = 0.3;
    domain = with_layers(domain, {4, 0.06, 1.3, Side::inside, {}});  // 0.37 thick
    const Mesh mesh = generate_mesh(domain, 2);
    expect_layered_mesh(domain, mesh, false);
    EXPECT_NEAR(summarise_layer(mesh, Layer(0)).min_thickness, 0.2, 0.0012);
}

TEST(LayeredMesh, OfSeveralBodiesSomeWithout) {
    Domain domain =
        with_layers(small_domain({ball({-1.2, -1.2, 2}, 1), turned_ellipsoid({0.5, 0.5, 5}, {1, 1.5, 1.2}),
                                  ball({1.8, -1.6, 1.4}, 0.6)}),
                    {3, 0.02, 1.3, Side::outside, {}});
    domain.bodies[0].layer = std::nullopt;
    domain.bodies[2].layer->side = Side::both;
    const Mesh mesh = generate_mesh(domain, 1);
    ASSERT_EQ(mesh.layers.size(), 3u);
    EXPECT_EQ(mesh.layers[0].body, Region(2));
    EXPECT_EQ(mesh.layers[1].body, Region(3));
    EXPECT_EQ(mesh.layers[1].region, surroundings);
    EXPECT_EQ(mesh.layers[2].region, Region(3));
    expect_layered_mesh(domain, mesh, true);
}

TEST(LayeredMesh, NearWallsAndOtherBodiesIsThinned) {
    const Domain wall = with_layers(small_domain({ball({0, 0, 1.3}, 1)}), thin);  // 0.3 radii
    expect_layered_mesh(wall, generate_mesh(wall, 1), false);
    const Domain miss = with_layers(small_domain({ball({-1.17, 0, 4}, 1), ball({1.17, 0, 4}, 1)}), thin);
    expect_layered_mesh(miss, generate_mesh(miss, 1), false);
}

TEST(LayeredMesh, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const Domain domain = with_layers(small_domain({ball({0, 0, 4}, 1.2)}), thin);
    const Mesh mesh = generate_mesh(domain, 1);
    EXPECT_TRUE(mesh == generate_mesh(domain, 1));
    EXPECT_FALSE(mesh == generate_mesh(domain, 2));
}

TEST(LayeredMesh, RefusesLayersTooThickAndSaysWhatFits) {
    const Domain near = small_domain({ball({0, 0, 1.3}, 1), ball({0, 0, 4}, 1)});
    LayerOptions thick{3, 0.1, 1.25, Side::outside, {}};
    Domain domain = near;
    domain.bodies[0].layer = thick;
    expect_error(domain,
                 {"body \"0\": its layer is 0.381 m thick, too much for the gap of 0.3 m to the wall z min",
                  // a third of 0.3 - 0.15 * 0.4^2
                  "the largest layer that fits is 0.092 m thick, by layer.first_height of at most 0.024 m"});
    domain.bodies[0].layer->first_height = 0.05;  // 0.19: thinned
    EXPECT_EQ(error_of(domain), "");
    domain.bodies[1].layer = LayerOptions{3, 0.15, 1.25, Side::outside, {}};
    expect_error(domain, {"too much for the gap of 0.7 m to body \"1\"",
                          "fits is 0.092 m thick, by layer.first_height of at most 0.024 m"});  // at the wall, too
    Domain touching = small_domain({ball({0, 0, 1.02}, 1)});  // its triangles reach farther than the gap is wide
    touching.bodies[0].layer = LayerOptions{3, 0.1, 1.25, Side::outside, 0.01};
    try {
        check_layers(touching, 0);
        ADD_FAILURE() << "is let pass";
    } catch (const DomainError& error) {
        EXPECT_STREQ(error.what(), "body \"0\": its layer is 0.381 m thick, too much for the gap of 0.02 m to the wall z min; none fits: a "
                                   "smaller size.surface may do, or bodies farther apart");
    }
}

TEST(LayeredMesh, TheLargestLayerThatFitsDoes) {
    Domain domain = with_layers(small_domain({ball({0, 0, 1.6}, 1)}), {3, 0.4, 1.25, Side::outside, {}});
    const std::string error = error_of(domain), key = "first_height of at most ";
    ASSERT_NE(error.find(key), std::string::npos) << error;
    domain.bodies[0].layer->first_height = std::stod(error.substr(error.find(key) + key.size()));
    const LayerSummary summary = summarise_layer(generate_mesh(domain, 1), Layer(0));
    EXPECT_NEAR(summary.min_thickness / summary.max_thickness, 1, 1e-12);  // unsqueezed
    EXPECT_GT(summary.min_thickness, 0.18);                                // of 0.2
}

TEST(LayeredMesh, RefusesLayersTooThickForABodysInside) {
    const Domain domain = with_layers(small_domain({ball({0, 0, 4}, 0.5)}), {3, 0.2, 1.25, Side::inside, {}});
    expect_error(domain, {"its layer inside is 0.762 m thick", "radius of 0.5 m", "fits is 0.25 m"});
}

TEST(LayeredMesh, RefusesGapsBelowTheLeast) {
    Domain domain = with_layers(small_domain({ball({0, 0, 1.3}, 1)}), {2, 0.02, 1.25, Side::outside, 0.31});
    expect_error(domain, {"the gap of 0.3 m to the wall z min is below layer.min_gap = 0.31 m"});
}

TEST(LayeredMesh, RefusesValuesOutOfRange) {
    const Domain one = small_domain({ball({0, 0, 4}, 1)});
    expect_error(with_layers(one, {3, -0.1, 1.25, Side::outside, {}}),
                 {"positive layer.first_height, got -0.1", "fits"});
    expect_error(with_layers(one, {3, 0.1, 0, Side::outside, {}}), {"positive layer.growth, got 0"});
    expect_error(with_layers(one, {0, 0.1, 1, Side::outside, {}}), {"layer.count is below 1"});
    expect_error(with_layers(one, {400, 0.001, 1e3, Side::outside, {}}),
                 {"overflows", "fits is 0.65 m thick, by layer.growth of at most 1"});
}

TEST(LayeredMesh, RefusesMoreLayersThanThereArePatchesFor) {
    Domain domain;
    domain.box = {{0, 0, 0}, {14, 4, 4}};
    domain.size = {0.5, 0.3, 1};
    for (int i = 0; i < 7; ++i)
        domain.bodies.push_back({std::to_string(i), ball({1.0 + 2 * i, 2, 2}, 0.5),
                                 [](double) { return Pose{}; }, LayerOptions{1, 0.02, 1, Side::both, {}}});
    expect_error(domain, {"there are 14 layers, a mesh has 13 at most"});
}
