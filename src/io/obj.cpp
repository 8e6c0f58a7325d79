// OBJ, as Wavefront's "Object Files (.obj)" has it: `v x y z`, `f i j k ...` with numbers from 1, or from the end if
// negative, each perhaps with those of texture and normal after slashes. Polygons are cut by ears [Meisters 1975,
// "Polygons have ears"] in the plane of their mean normal.

#include "io/triangles.h"

#include <kropla/base/error.h>
#include <kropla/base/index.h>
#include "io/words_of_text.h"

#include <string>

namespace kropla {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Of a polygon that need not be flat [Newell, in Sutherland, Sproull, Schumacker 1974].
Vec3 normal_of(const std::vector<Vec3>& points, const std::vector<int>& polygon) {
    Vec3 sum;
    const Vec3& origin = points[as_size(polygon[0])];
    for (std::size_t i = 0; i + 1 < polygon.size(); ++i)
        sum += cross(points[as_size(polygon[i])] - origin, points[as_size(polygon[i + 1])] - origin);
    return sum;
}

/// Is the corner of the polygon one that can be cut off: convex, and no other corner within it?
bool is_ear(const std::vector<Vec3>& points, const std::vector<int>& polygon, std::size_t corner, const Vec3& normal) {
    const std::size_t n = polygon.size();
    const auto place = [&](std::size_t i) { return points[as_size(polygon[i % n])]; };
    const Vec3 a = place(corner + n - 1), b = place(corner), c = place(corner + 1);
    const auto is_left = [&](const Vec3& p, const Vec3& q, const Vec3& x) { return dot(cross(q - p, x - p), normal) > 0; };
    if (!is_left(a, b, c)) return false;
    for (std::size_t i = 2; i + 1 < n; ++i) {
        const Vec3 x = place(corner + i);
        if (x != a && x != b && x != c && !is_left(b, a, x) && !is_left(c, b, x) && !is_left(a, c, x)) return false;
    }
    return true;
}

void cut(const std::vector<Vec3>& points, std::vector<int> polygon, Triangles& triangles) {
    const Vec3 normal = normal_of(points, polygon);
    while (polygon.size() > 3) {
        std::size_t corner = 0;
        while (corner < polygon.size() && !is_ear(points, polygon, corner, normal)) ++corner;
        if (corner == polygon.size()) corner = 0;  // none, of a polygon that meets itself: what comes is looked at later
        const std::size_t n = polygon.size();
        triangles.push_back({polygon[(corner + n - 1) % n], polygon[corner], polygon[(corner + 1) % n]});
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(corner));
    }
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
}

class Reader {
public:
    void read(std::string_view text) {
        while (!text.empty()) {
            std::string line(take_line(text));
            ++line_;
            while (line.ends_with('\\') && !text.empty()) {
                line.back() = ' ';
                line += take_line(text);
                ++line_;
            }
            read_line(std::string_view(line).substr(0, line.find('#')));
        }
    }
    [[nodiscard]] FileTriangles result() const { return joined(points_, triangles_); }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw FileError("line " + std::to_string(line_) + ": " + what);
    }
    void read_line(std::string_view line) {
        const std::string_view word = take_word(line);
        if (word == "v") read_vertex(line);
        else if (word == "f") read_face(line);
    }
    void read_vertex(std::string_view line) {
        Vec3 x;
        for (int axis = 0; axis < 3; ++axis)
            if (!is_number(take_word(line), x[axis])) refuse("a vertex has three numbers, which are finite");
        points_.push_back(x + Vec3{});
    }
    void read_face(std::string_view line) {
        std::vector<int> polygon;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            double number = 0;
            const std::string_view index = word.substr(0, word.find('/'));
            if (!is_number(index, number) || number != std::floor(number))
                refuse("a face has numbers of vertices, not \"" + std::string(word) + "\"");
            const double at = number < 0 ? static_cast<double>(points_.size()) + number : number - 1;
            if (number == 0 || at < 0 || at >= static_cast<double>(points_.size()))
                refuse("a face has the vertex " + std::string(index) + ", which does not exist: there are " +
                       std::to_string(points_.size()) + " above it");
            polygon.push_back(static_cast<int>(at));
        }
        if (polygon.size() < 3) refuse("a face has at least three corners, this one " + std::to_string(polygon.size()));
        cut(points_, std::move(polygon), triangles_);
    }

    std::vector<Vec3> points_;
    Triangles triangles_;
    std::size_t line_ = 0;
};

}  // namespace

FileTriangles parse_obj(std::string_view text) {
    Reader reader;
    reader.read(text);
    FileTriangles found = reader.result();
    if (found.triangles.empty()) throw FileError("has no faces");
    return found;
}

}  // namespace kropla
