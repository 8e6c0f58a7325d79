#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace kropla {

/// Triangles of a file, by the numbers of their corners among the points; each place is one point.
struct FileTriangles {
    std::vector<Vec3> points;  // in the file's unit
    std::vector<std::array<int, 3>> triangles;
    std::size_t dropped = 0;  // triangles with two corners in one place: without them the rest is as closed as with them
};

/// What an STL file holds, ASCII or binary, told apart by what it is and not by its first word; its normals are not
/// looked at. Throws FileError, without the file's name, if it is neither, is cut off (with the number of triangles
/// that it says and that it has), holds no triangles or a coordinate that is not finite (with the triangle or line).
[[nodiscard]] FileTriangles parse_stl(std::string_view bytes);

/// What an OBJ file holds: its vertices and faces; the rest of it is passed over. Polygons are cut into triangles, also
/// those that are not convex. Throws FileError, without the file's name but with the line, if a vertex or face cannot
/// be read, or a face has fewer than three corners or one that does not exist.
[[nodiscard]] FileTriangles parse_obj(std::string_view text);

/// Reads either by the extension of its name. Throws FileError, naming the file, also for any other extension.
[[nodiscard]] FileTriangles read_triangles(const std::filesystem::path& path);

/// Points at the same place, to the bit, become one; triangles that have lost a corner by it are dropped.
[[nodiscard]] FileTriangles joined(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles);

/// Writes triangles as a VTU file, their numbers as the cell array "triangle". Throws FileError as write_vtu.
void write_triangles(const std::filesystem::path& path, const std::vector<Vec3>& points,
                     const std::vector<std::array<int, 3>>& triangles, const std::vector<int>& numbers);

}  // namespace kropla
