#pragma once

#include <kropla/mesh/mesh.h>

#include <array>
#include <filesystem>
#include <string>

namespace kropla {

/// The box [0, n0] x [0, n1] x [0, n2] of unit cubes, each divided into six tets around its diagonal; a cube
/// is of the region that `region` gives for its corner of least coordinates.
template <class RegionOf>
Mesh grid_of_cubes(std::array<int, 3> n, RegionOf region) {
    const auto vertex = [&](int i, int j, int k) { return Vertex(i + (n[0] + 1) * (j + (n[1] + 1) * k)); };
    Array<Vertex, Vec3> position;
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i) position.push_back(Vec3{1.0 * i, 1.0 * j, 1.0 * k});
    // From corner to corner along the three axes in any order [Kuhn 1960]; odd orders are turned to be
    // positive.
    constexpr std::array<std::array<int, 3>, 6> orders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> regions;
    for (int cube = 0; cube < n[0] * n[1] * n[2]; ++cube) {
        const std::array<int, 3> start = {cube % n[0], cube / n[0] % n[1], cube / (n[0] * n[1])};
        for (std::size_t order = 0; order < orders.size(); ++order) {
            std::array<int, 3> at = start;
            std::array<Vertex, 4> tet = {vertex(at[0], at[1], at[2])};
            for (std::size_t step = 0; step < 3; ++step) {
                ++at[static_cast<std::size_t>(orders[order][step])];
                tet[step + 1] = vertex(at[0], at[1], at[2]);
            }
            if (order >= 3) std::swap(tet[2], tet[3]);
            tets.push_back(tet);
            regions.push_back(region(start[0], start[1], start[2]));
        }
    }
    return make_mesh(position, tets, regions);
}

struct TinyRun {
    int rows = 5;            // of steps.csv
    bool heat = true;        // frames with a temperature, steps with an energy
    double worst = 8.5;      // R/r of step 3
    std::string steps = {};  // instead of rows: the whole steps.csv
    bool bodies = true;      // bodies.csv is there
    bool flow = false;       // frames with a pressure and a velocity, after the start
};

/// Leaves in `dir`, which is emptied, what a run of a body of two cubes falling through a box of 6 x 6 x 12
/// leaves.
void write_tiny_run(const std::filesystem::path& dir, const TinyRun& run = {});

/// A folder of this name for this test alone.
[[nodiscard]] std::filesystem::path test_folder(const std::string& name);

}  // namespace kropla
