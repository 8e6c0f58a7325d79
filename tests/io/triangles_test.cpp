// Triangles of STL and OBJ files, whole and broken.
#include "io/triangles.h"

#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace kropla {
namespace {

const std::vector<std::array<std::array<float, 3>, 3>> tetrahedron = {{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                                                                      {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                                                      {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                                      {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

std::string binary(std::uint32_t count) {
    std::string bytes(80, 's');
    bytes.replace(0, 5, "solid");  // as many binary files begin
    bytes.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& triangle : tetrahedron) {
        bytes.append(12, '\0');
        bytes.append(reinterpret_cast<const char*>(&triangle), 36);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string text() {
    std::string s = "solid thing\r\n";
    for (const auto& triangle : tetrahedron) {
        s += " facet normal 0 0 0\n  outer loop\n";
        for (const auto& [x, y, z] : triangle)
            s += "   vertex " + std::to_string(x) + " " + std::to_string(y) + "e0 +" + std::to_string(z) + "\n";
        s += "  endloop\n endfacet\n";
    }
    return s + "endsolid thing\n";
}

std::string refusal(const auto& parse, const std::string& bytes) {
    try {
        (void)parse(bytes);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(Stl, TextAndBinaryAreTheSameWithCornersJoined) {
    for (const std::string& bytes : {binary(4), text()}) {
        const FileTriangles found = parse_stl(bytes);
        EXPECT_EQ(found.points.size(), 4u);
        EXPECT_EQ(found.triangles.size(), 4u);
        EXPECT_EQ(found.dropped, 0u);
        EXPECT_EQ(found.points[1], (Vec3{0, 1, 0}));
    }
}

TEST(Stl, BrokenFilesAreRefusedInWords) {
    EXPECT_EQ(refusal(parse_stl, ""), "is empty");
    EXPECT_EQ(refusal(parse_stl, "hello"), "is no STL file, neither text nor binary");
    EXPECT_EQ(refusal(parse_stl, binary(9)), "is cut off: it says that it has 9 triangles, and has 4");
    EXPECT_EQ(refusal(parse_stl, "solid a\nendsolid a\n"), "has no triangles");
    EXPECT_EQ(refusal(parse_stl, text().substr(0, 300)), "is cut off: after 1 triangles its end is missing");
    EXPECT_EQ(refusal(parse_stl, "solid a\nfacet\nvertex 0 nan 1\n"), "line 3: a vertex has three numbers, which are finite");
    EXPECT_EQ(refusal(parse_stl, "solid a\nfacet\nvertex 0 0 1\nendfacet\n"), "line 4: a facet has three vertices, this one 1");
    std::string bytes = binary(4);
    const float infinite = std::numeric_limits<float>::infinity();
    std::memcpy(bytes.data() + 84 + 50 + 12, &infinite, 4);
    EXPECT_EQ(refusal(parse_stl, bytes), "triangle 1 has a coordinate that is not finite");
}

TEST(Obj, PolygonsAreCutAlsoWhereTheyAreNotConvex) {
    const FileTriangles found = parse_obj("# an L\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nvn 0 0 1\n"
                                          "f 1//1 2//1 \\\n 3//1 4//1 -2//1 -1//1\n");
    ASSERT_EQ(found.triangles.size(), 4u);
    double area = 0;
    for (const auto& [a, b, c] : found.triangles) {
        const auto at = [&](int i) { return found.points[static_cast<std::size_t>(i)]; };
        const Vec3 normal = cross(at(b) - at(a), at(c) - at(a));
        EXPECT_GT(normal.z, 0);
        area += normal.z / 2;
    }
    EXPECT_DOUBLE_EQ(area, 3);
}

TEST(Obj, BrokenFilesAreRefusedInWords) {
    EXPECT_EQ(refusal(parse_obj, "v 0 0 0\n"), "has no faces");
    EXPECT_EQ(refusal(parse_obj, "v 0 0 0\nf 1 1 2\n"), "line 2: a face has the vertex 2, which does not exist: there are 1 above it");
    EXPECT_EQ(refusal(parse_obj, "v 0 0 0\nf 1 1\n"), "line 2: a face has at least three corners, this one 2");
    EXPECT_EQ(refusal(parse_obj, "v 0 0\n"), "line 1: a vertex has three numbers, which are finite");
    EXPECT_EQ(refusal(parse_obj, "v 0 0 0\nf 1 x 1\n"), "line 2: a face has numbers of vertices, not \"x\"");
}

}  // namespace kropla
