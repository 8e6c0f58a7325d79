#include "meshes.h"
#include "session.h"
#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace kropla {
namespace {

HeatOptions one_region() {
    return {.regions = {HeatRegion{.material = {.conductivity = 2, .density = 3, .specific_heat = 5},
                                   .initial = 10}}};
}

Quantity always(double value) {
    return [value](const Vec3&, double) { return value; };
}

/// What CaseError says of a step with these options; empty if there is none.
std::string complaint(const HeatOptions& options, double dt = 1, const Mesh& mesh = unit_cube(2)) {
    NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 4.0)};
    const NodalField untouched = field;
    try {
        step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, dt);
    } catch (const CaseError& error) {
        EXPECT_EQ(field.values, untouched.values);
        return error.what();
    }
    return "";
}

TEST(HeatCase, SaysWhatIsWrong) {
    HeatOptions options = one_region();
    EXPECT_EQ(complaint(options), "");
    options.regions[0].material.conductivity = -1;
    EXPECT_EQ(complaint(options), "heat.region.surroundings.conductivity must be positive, got -1");
    options = one_region();
    options.regions[0].material.density = 0;
    EXPECT_EQ(complaint(options), "heat.region.surroundings.density must be positive, got 0");
    options = one_region();
    options.regions.push_back({.material = {.specific_heat = std::nan("")}});
    EXPECT_EQ(complaint(options), "heat.region.(body 1).specific_heat must be positive, got nan");
    options = one_region();
    options.regions[0].initial = INFINITY;
    EXPECT_EQ(complaint(options), "heat.region.surroundings.initial must be finite, got inf");
    EXPECT_EQ(complaint(one_region(), 1, unit_cube_with_body(4)),
              "heat: the mesh has 2 regions, materials are given for 1");
    EXPECT_EQ(complaint(one_region(), 0), "heat: the step must be positive, got 0.000000 s");
}

TEST(HeatCase, SaysWhatIsWrongWithQuantities) {
    HeatOptions options = one_region();
    options.faces[3].kind = HeatFace::Kind::value;
    EXPECT_EQ(complaint(options), "heat.face.y_max.value is not given");
    options.faces[3].kind = HeatFace::Kind::flux;
    EXPECT_EQ(complaint(options), "heat.face.y_max.flux is not given");
    options.faces[3].quantity = always(std::nan(""));
    EXPECT_NE(complaint(options).find("heat.face.y_max.flux is nan at ("), std::string::npos);
    options.faces[3].kind = HeatFace::Kind::value;
    EXPECT_NE(complaint(options).find("heat.face.y_max.value is nan at ("), std::string::npos);
    options = one_region();
    options.regions[0].source = always(INFINITY);
    EXPECT_NE(complaint(options).find("heat.region.surroundings.source is inf at ("), std::string::npos);
}

TEST(HeatCase, BodyWinsAtItsSurface) {
    const Mesh mesh = unit_cube_with_body(4);
    HeatOptions options = one_region();
    options.regions.push_back({.initial = 20});
    const NodalField field = initial_temperature(mesh, options);
    const auto of_body = vertices_of(mesh, Region(1));
    for (Vertex v : mesh.position.indices()) EXPECT_EQ(field.values[v], of_body[v] ? 20 : 10);
    EXPECT_EQ(field.name, "temperature");
    EXPECT_EQ(field.unit, "K");
}

TEST(HeatCase, FluxAndSourceBringTheirEnergy) {
    const Mesh mesh = unit_cube(5);
    HeatOptions options = one_region();
    options.faces[0] = {HeatFace::Kind::flux, always(7)};
    options.faces[5] = {HeatFace::Kind::flux, [](const Vec3& x, double t) { return -3 * x.x * t; }};
    options.regions[0].source = [](const Vec3& x, double t) { return 4 * x.z + t; };
    NodalField field = initial_temperature(mesh, options);
    const double begin = energy(mesh, options, field.values);
    EXPECT_NEAR(begin, 150, 1e-12 * 150);
    step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 0.5);
    EXPECT_NEAR(energy(mesh, options, field.values) - begin, 0.5 * (7 - 3 * 0.5 * 0.25 + 4 * 0.5 + 0.25), 1e-9);
}

TEST(HeatCase, ValuesHoldOnTheirFaces) {
    const Mesh mesh = unit_cube(4);
    HeatOptions options = one_region();
    const auto linear = [](const Vec3& x, double t) { return 2 * x.x - 3 * x.y + x.z + 5 * t; };
    options.faces[0] = {HeatFace::Kind::value, linear};
    options.faces[4] = {HeatFace::Kind::value, always(6)};
    NodalField field = initial_temperature(mesh, options);
    step_heat(petsc().all_ranks(), mesh, mesh, options, field, 1, 0.5);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 x = mesh.position[v];
        if (x.x != 0 && x.z != 0) continue;
        const double expected = x.x == 0 ? linear(x, 1.5) : 6;  // on their edge the first face wins
        EXPECT_NEAR(field.values[v], expected, 1e-9);
    }
}

TEST(HeatCase, SolverSaysWhyItGaveUp) {
    const Mesh mesh = unit_cube(6);
    HeatOptions options = one_region();
    options.faces[0] = {HeatFace::Kind::value, always(6)};
    NodalField field = initial_temperature(mesh, options);
    const NodalField untouched = field;
    check(PetscOptionsSetValue(nullptr, "-ksp_max_it", "1"));
    std::string said;
    try {
        step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 1e6);
    } catch (const SolverError& error) {
        said = error.what();
    }
    check(PetscOptionsClearValue(nullptr, "-ksp_max_it"));
    EXPECT_EQ(said.find("the heat solver did not converge: DIVERGED_ITS after 1 iterations, backward error "), 0u)
        << said;
    EXPECT_EQ(field.values, untouched.values);
}

// Bounds: 4 K at the start, 6 and 7 K at faces, until a source or a flux takes one of them away.
TEST(HeatCase, KnowsWhichTemperaturesItAllows) {
    const Mesh mesh = unit_cube(4);
    const auto extremes = [&](const HeatOptions& options) {
        NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 4.0)};
        return step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 0.1).extremes;
    };
    HeatOptions options = one_region();
    options.faces[0] = {HeatFace::Kind::value, always(6)};
    options.faces[4] = {HeatFace::Kind::value, [](const Vec3& x, double) { return 6 + x.y; }};
    const HeatExtremes plain = extremes(options);
    EXPECT_EQ(plain.lower, 4);
    EXPECT_EQ(plain.upper, 7);
    EXPECT_NEAR(plain.most.value, 7, 1e-12);
    EXPECT_EQ(plain.most.place.y, 1);
    EXPECT_EQ(plain.most.place.z, 0);
    EXPECT_GE(plain.least.value, 4 - 1e-12);
    options.regions[0].source = [](const Vec3&, double t) { return t < 0.05 ? -1.0 : 0.0; };
    EXPECT_EQ(extremes(options).lower, -INFINITY);
    EXPECT_EQ(extremes(options).upper, 7);
    options.faces[3] = {HeatFace::Kind::flux, always(1)};
    EXPECT_EQ(extremes(options).upper, INFINITY);
}

TEST(HeatCase, FreeSlotsOfTheMeshAreOfNoMatter) {
    Mesh mesh = unit_cube_with_body(4);
    Array<Tet, std::array<Vertex, 4>> kept;
    Array<Tet, Region> regions;
    for (Tet t : mesh.tets.indices()) {
        if (mesh.region[t] == Region(1))
            continue;  // the body is a hole now, the vertex in its middle a free slot
        kept.push_back(mesh.tets[t]);
        regions.push_back(surroundings);
    }
    mesh = make_mesh(mesh.position, kept, regions);
    ASSERT_EQ(mesh.free_vertices.size(), 1u);
    const HeatOptions options = one_region();
    NodalField field = initial_temperature(mesh, options);
    step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 1);
    EXPECT_LT(largest_difference(mesh, field, 10), 1e-11);
}

}  // namespace
}  // namespace kropla
