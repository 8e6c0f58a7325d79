// What flows can be asked for beside walls and numbers: viscosities by the temperature, slip, another solver.
#include "flow_problems.h"
#include "session.h"

#include <gtest/gtest.h>
#include <petscsys.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace kropla {
namespace {

using std::numbers::pi;

FlowOptions stokes(FlowOptions options) {
    options.convection = false;
    options.scheme = FlowScheme::steady;
    options.tolerance = 1e-9;
    return options;
}

/// Between plates, the upper one at 1 m/s, of a viscosity of 1 + 2 z [Pa s].
std::pair<double, FlowReport> between_plates(int n) {
    const auto exact = [](const Vec3& x) { return Vec3{std::log(1 + 2 * x.z) / std::log(3.0), 0, 0}; };
    FlowOptions options =
        stokes(fluid(1, 1, velocity_of([exact](const Vec3& x, double) { return exact(x); })));
    options.faces[2].kind = options.faces[3].kind = FlowFace::Kind::slip;
    options.regions[0]->viscosity = Property({300, 400}, {1, 3});
    const Mesh mesh = unit_cube(n);
    Array<Vertex, double> temperature(mesh.position.size());
    for (Vertex v : mesh.position.indices()) temperature[v] = 300 + 100 * mesh.position[v].z;
    FlowState state = still_flow(mesh);
    FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1, temperature);
    return {velocity_error(mesh, state, exact), std::move(report)};
}

TEST(FlowOptions, ViscosityByTheTemperature) {
    const auto [a, coarse] = between_plates(4);
    const auto [b, fine] = between_plates(8);
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b));
    EXPECT_LT(b, 4.1e-4);
    EXPECT_GT(std::log2(a / b), 1.8);
    const double stress = 2 / std::log(3.0);  // [Pa]
    RecordProperty("force", std::to_string(fine.face_force[5].x));
    EXPECT_NEAR(fine.face_force[4].x / stress, 1, 0.14);  // but for edges, of faces across x
    EXPECT_NEAR(fine.face_force[5].x / stress, -1, 0.14);
    Vec3 sum;
    for (const Vec3& force : fine.face_force) sum += force;
    EXPECT_LT(norm(sum), 1e-6);
}

/// Rolls in a box that slips everywhere, kept by a force.
Vec3 rolls(const Vec3& x) {
    return {std::sin(pi * x.x) * std::cos(pi * x.y), -std::cos(pi * x.x) * std::sin(pi * x.y), 0};
}
FlowState find_rolls(const Mesh& mesh, int& iterations) {
    FlowOptions options = stokes(fluid(1, 0.5, {}));
    options.faces.fill({.kind = FlowFace::Kind::slip});
    options.regions[0]->force = velocity_of([](const Vec3& x, double) { return pi * pi * rolls(x); });
    FlowState state = still_flow(mesh);
    iterations = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1).iterations;
    return state;
}

TEST(FlowOptions, SlipOnAllFaces) {
    std::vector<double> errors;
    for (int n : {6, 12}) {
        const Mesh mesh = unit_cube(n);
        int iterations = 0;
        const FlowState state = find_rolls(mesh, iterations);
        errors.push_back(velocity_error(mesh, state, rolls));
        for (Vertex v : mesh.position.indices()) {
            for (int m = 0; m < 3; ++m) {
                const double x = mesh.position[v][m];
                if (x == 0 || x == 1) {
                    EXPECT_EQ(state.velocity[v][m], 0);
                }
            }
        }
    }
    RecordProperty("errors", std::to_string(errors[0]) + " " + std::to_string(errors[1]));
    EXPECT_LT(errors[1], 0.026);
    EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
}

/// An option of PETSc's, while this lives.
class PetscOption {
public:
    PetscOption(std::string name, const char* value) : name_(std::move(name)) {
        PetscOptionsSetValue(nullptr, name_.c_str(), value);
    }
    ~PetscOption() { PetscOptionsClearValue(nullptr, name_.c_str()); }
    PetscOption(const PetscOption&) = delete;
    PetscOption& operator=(const PetscOption&) = delete;

private:
    std::string name_;
};

TEST(FlowOptions, FactorsByMumps) {
    const Mesh mesh = unit_cube(6);
    int by_itself = 0, by_factors = 0;
    const FlowState expected = find_rolls(mesh, by_itself);
    const PetscOption pc("-flow_pc_type", "lu"), factors("-flow_pc_factor_mat_solver_type", "mumps");
    const FlowState found = find_rolls(mesh, by_factors);
    double largest = 0;
    for (Vertex v : mesh.position.indices()) {
        largest = std::max(largest, distance(expected.velocity[v], found.velocity[v]));
        largest = std::max(largest, std::abs(expected.pressure[v] - found.pressure[v]));
    }
    EXPECT_LT(largest, 1e-7);
    EXPECT_GT(by_itself, 5);
    RecordProperty("iterations", std::to_string(by_itself) + " " + std::to_string(by_factors));
    EXPECT_EQ(by_factors, 1);
}

}  // namespace
}  // namespace kropla
