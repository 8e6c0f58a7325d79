// STL, as 3D Systems' "StereoLithography Interface Specification" (1988) has it: binary, 80 bytes of anything, the number
// of triangles, and for each 50 bytes, little endian; or text. Many binary files begin with "solid" like text, so that a
// file is binary if its length is that of so many triangles.

#include "io/triangles.h"

#include <kropla/base/error.h>
#include "io/words_of_text.h"

#include <bit>
#include <cstdint>
#include <string>

namespace kropla {
namespace {

constexpr std::size_t head = 84, per_triangle = 50, normal = 12;  // bytes

std::uint32_t whole_number(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

FileTriangles parse_binary(std::string_view bytes) {
    const std::size_t count = whole_number(bytes, head - 4);
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    points.reserve(3 * count);
    for (std::size_t t = 0; t < count; ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            Vec3 x;
            for (std::size_t axis = 0; axis < 3; ++axis)
                x[static_cast<int>(axis)] = std::bit_cast<float>(
                    whole_number(bytes, head + per_triangle * t + normal + 12 * corner + 4 * axis));
            if (!is_finite(x))
                throw FileError("triangle " + std::to_string(t) + " has a coordinate that is not finite");
            points.push_back(x + Vec3{});  // no -0
        }
        const int first = static_cast<int>(3 * t);
        triangles.push_back({first, first + 1, first + 2});
    }
    return joined(points, triangles);
}

FileTriangles parse_text(std::string_view text) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::size_t line_number = 0;
    bool in_facet = false, has_ended = false;
    const auto refuse = [&](const std::string& what) {
        throw FileError("line " + std::to_string(line_number) + ": " + what);
    };
    while (!text.empty()) {
        std::string_view line = take_line(text);
        ++line_number;
        const std::string_view word = take_word(line);
        if (word == "facet") {
            if (in_facet) refuse("a facet begins before the one above has its end");
            in_facet = true;
        } else if (word == "vertex") {
            Vec3 x;
            for (int axis = 0; axis < 3; ++axis)
                if (!is_number(take_word(line), x[axis])) refuse("a vertex has three numbers, which are finite");
            points.push_back(x + Vec3{});
        } else if (word == "endfacet") {
            const std::size_t had = 3 * triangles.size();
            if (points.size() != had + 3) refuse("a facet has three vertices, this one " + std::to_string(points.size() - had));
            const int first = static_cast<int>(had);
            triangles.push_back({first, first + 1, first + 2});
            in_facet = false;
        } else if (word == "endsolid") {
            has_ended = true;
        }
    }
    if (in_facet || (!has_ended && !triangles.empty()))
        throw FileError("is cut off: after " + std::to_string(triangles.size()) + " triangles its end is missing");
    return joined(points, triangles);
}

/// What is neither: text begins so.
bool may_be_text(std::string_view bytes) {
    std::string_view rest = bytes.substr(0, 4096);
    return take_word(rest) == "solid" && bytes.substr(0, 4096).find('\0') == std::string_view::npos;
}

}  // namespace

FileTriangles parse_stl(std::string_view bytes) {
    const bool has_head = bytes.size() >= head;
    const std::size_t count = has_head ? whole_number(bytes, head - 4) : 0;
    if (has_head && bytes.size() == head + per_triangle * count) {
        if (count == 0) throw FileError("has no triangles");
        return parse_binary(bytes);
    }
    if (may_be_text(bytes)) {
        FileTriangles found = parse_text(bytes);
        if (found.triangles.empty() && found.dropped == 0) throw FileError("has no triangles");
        return found;
    }
    if (bytes.empty()) throw FileError("is empty");
    if (has_head && bytes.size() > head + per_triangle * count && count > 0) return parse_binary(bytes);  // padded
    const std::size_t had = has_head ? (bytes.size() - head) / per_triangle : 0;
    constexpr std::size_t most = 1u << 30;  // a number beyond is none of triangles
    if (had > 0 && count < most)
        throw FileError("is cut off: it says that it has " + std::to_string(count) + " triangles, and has " + std::to_string(had));
    throw FileError("is no STL file, neither text nor binary");
}

}  // namespace kropla
