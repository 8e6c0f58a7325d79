// Triangles from files. Points at the same place are found by a sort of the places, with no tolerance: whoever writes a
// closed surface writes each corner the same in all its triangles.

#include "io/triangles.h"

#include <kropla/base/error.h>
#include <kropla/base/index.h>
#include "io/file.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>

namespace kropla {
namespace {

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

FileTriangles joined(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto place = [&](std::size_t i) { return std::tuple(points[i].x, points[i].y, points[i].z); };
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(points[i].x, points[i].y, points[i].z, i); });
    std::vector<std::size_t> first(points.size());  // of the points in the same place
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && place(order[i]) == place(order[i - 1]) ? first[order[i - 1]] : order[i];
    std::vector<int> number(points.size(), -1);
    FileTriangles result;
    for (const auto& corners : triangles) {
        std::array<int, 3> triangle = {};
        for (std::size_t i = 0; i < 3; ++i) {
            int& known = number[first[as_size(corners[i])]];
            if (known < 0) {
                known = static_cast<int>(result.points.size());
                result.points.push_back(points[as_size(corners[i])]);
            }
            triangle[i] = known;
        }
        const auto& [a, b, c] = triangle;
        if (a == b || b == c || c == a) ++result.dropped;
        else result.triangles.push_back(triangle);
    }
    return result;
}

FileTriangles read_triangles(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension != ".stl" && extension != ".obj")
        throw FileError(path.string() + ": what ends in \"" + extension + "\" is not read; a surface is an .stl or .obj file");
    const std::string bytes = read_file(path);
    try {
        return extension == ".stl" ? parse_stl(bytes) : parse_obj(bytes);
    } catch (const FileError& error) {
        throw FileError(path.string() + ": " + error.what());
    }
}

void write_triangles(const std::filesystem::path& path, const std::vector<Vec3>& points,
                     const std::vector<std::array<int, 3>>& triangles, const std::vector<int>& numbers) {
    constexpr int vtk_triangle = 5;
    std::ostringstream text;
    text.precision(17);
    const auto array = [&](const std::string& attributes, const auto& values) {
        text << "<DataArray format=\"ascii\" " << attributes << ">\n";
        values();
        text << "</DataArray>\n";
    };
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         << "<UnstructuredGrid><Piece NumberOfPoints=\"" << points.size() << "\" NumberOfCells=\"" << triangles.size()
         << "\">\n<Points>\n";
    array("type=\"Float64\" NumberOfComponents=\"3\"", [&] {
        for (const Vec3& x : points) text << x.x << ' ' << x.y << ' ' << x.z << '\n';
    });
    text << "</Points>\n<Cells>\n";
    array("type=\"Int64\" Name=\"connectivity\"", [&] {
        for (const auto& [a, b, c] : triangles) text << a << ' ' << b << ' ' << c << '\n';
    });
    array("type=\"Int64\" Name=\"offsets\"", [&] {
        for (std::size_t t = 0; t < triangles.size(); ++t) text << 3 * (t + 1) << '\n';
    });
    array("type=\"UInt8\" Name=\"types\"", [&] {
        for (std::size_t t = 0; t < triangles.size(); ++t) text << vtk_triangle << '\n';
    });
    text << "</Cells>\n<CellData>\n";
    array("type=\"Int32\" Name=\"triangle\"", [&] {
        for (int number : numbers) text << number << '\n';
    });
    text << "</CellData>\n</Piece></UnstructuredGrid>\n</VTKFile>\n";
    write_file(path, text.str());
}

}  // namespace kropla
