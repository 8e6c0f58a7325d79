#pragma once

#include "base/random.h"
#include <kropla/mesh/mesh.h>

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace kropla {

/// A folder for the files of one test, gone with it.
class Folder {
public:
    Folder() : path_(std::filesystem::path(testing::TempDir()) / ("kropla_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// What `action` throws as an `Error`, or nothing.
template <class Error, class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// A cube of n x n x n small cubes of edge 1 mm, six tets each around a diagonal [Kuhn 1960]; inner vertices
/// stand off the grid at random. Tets of the inner small cubes are region 1.
inline Mesh cube_of_tets(int n, std::uint64_t seed = 1) {
    Random random{seed};
    Array<Vertex, Vec3> position;
    const auto coordinate = [&](int i) {
        return 1e-3 * (i == 0 || i == n ? i : i + random.uniform(-0.15, 0.15));
    };
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const double x = coordinate(i), y = coordinate(j), z = coordinate(k);
                position.push_back({x, y, z});
            }
    constexpr std::array<std::array<std::size_t, 3>, 6> ways = {
        // from a corner to the opposite one, along the axes
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    const auto inner = [n](int i) { return i > 0 && i < n - 1; };
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> region;
    for (int cube = 0; cube < n * n * n; ++cube)
        for (std::size_t way = 0; way < ways.size(); ++way) {
            std::array<int, 3> at = {cube % n, cube / n % n, cube / (n * n)};
            region.push_back(Region(inner(at[0]) && inner(at[1]) && inner(at[2]) ? 1 : 0));
            std::array<Vertex, 4> tet;
            for (std::size_t step = 0; step < 4; ++step) {
                tet[step] = Vertex((at[2] * (n + 1) + at[1]) * (n + 1) + at[0]);
                if (step < 3) ++at[ways[way][step]];
            }
            if (way >= 3) std::swap(tet[2], tet[3]);
            tets.push_back(tet);
        }
    return make_mesh(std::move(position), std::move(tets), std::move(region));
}

/// A VTU file in plain text, right or wrong.
struct PlainVtu {
    std::string points = "0 0 0  1 0 0  0 1 0  0 0 1";
    int point_count = 4;
    std::string connectivity = "0 1 2 3", offsets = "4", types = "10";
    int cell_count = 1;
    std::string cell_arrays = "";
};
inline std::string text_of(const PlainVtu& vtu) {
    const auto array = [](const std::string& attributes, const std::string& values) {
        return "<DataArray " + attributes + " format=\"ascii\">" + values + "</DataArray>\n";
    };
    return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
           "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
           "<Piece NumberOfPoints=\"" +
           std::to_string(vtu.point_count) + "\" NumberOfCells=\"" + std::to_string(vtu.cell_count) +
           "\">\n<CellData>" + vtu.cell_arrays + "</CellData>\n<Points>" +
           array("type=\"Float64\" NumberOfComponents=\"3\"", vtu.points) + "</Points>\n<Cells>" +
           array("type=\"Int64\" Name=\"connectivity\"", vtu.connectivity) +
           array("type=\"Int64\" Name=\"offsets\"", vtu.offsets) +
           array("type=\"UInt8\" Name=\"types\"", vtu.types) +
           "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

inline void put(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace kropla
