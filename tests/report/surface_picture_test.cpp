#include "report/surface_picture.h"

#include "report/cuts.h"
#include "tiny_run.h"
#include <kropla/base/vec3.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>

namespace kropla {
namespace {

/// In a row of cubes, those with true are bodies; the box is 5 x 3 x 3.
template <class IsBody>
std::vector<SurfaceTriangle> triangles_of(IsBody is_body) {
    return surface_triangles(grid_of_cubes({5, 3, 3}, [&](int i, int j, int k) { return Region(is_body(i, j, k) ? 1 : 0); }));
}

std::size_t count_paths(const std::string& svg) {  // of polygons
    return static_cast<std::size_t>(std::ranges::count(svg, 'z')) - 1;  // and the name of an axis
}

TEST(SurfacePicture, HasTheTrianglesThatLookTowardsTheViewer) {
    const auto cube = triangles_of([](int i, int j, int k) { return i == 1 && j == 1 && k == 1; });
    ASSERT_EQ(cube.size(), 12u);  // six faces, two triangles each
    for (const SurfaceTriangle& t : cube) {
        const auto& [a, b, c] = t.corners;
        EXPECT_GT(dot(cross(b - a, c - a), (a + b + c) / 3 - Vec3{1.5, 1.5, 1.5}), 0);
    }
    EXPECT_EQ(count_seen(cube), 6u);  // front, right and top
    const std::string svg = draw_surfaces(cube, extent_in_space(cube));
    EXPECT_EQ(count_paths(svg), 6u);
    std::set<std::string> colours;
    const std::regex fill("fill=\"(#[0-9a-f]{6})\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), fill), end; it != end; ++it) colours.insert((*it)[1]);
    EXPECT_EQ(colours.size(), 3u);  // a shade per face
}

TEST(SurfacePicture, LeavesOutWhatIsHidden) {
    // One behind the other, seen from the front, right and above: the far one is seen in part.
    const auto both = triangles_of([](int i, int j, int k) { return i == 1 && j != 1 && k == 1; });
    EXPECT_EQ(count_seen(both), 12u);
    EXPECT_GT(count_paths(draw_surfaces(both, extent_in_space(both))), 6u);
    // A small cube within the shadow of a wall.
    const auto hidden = triangles_of([](int i, int j, int k) { return j == 0 || (i == 2 && j == 2 && k == 0); });
    const auto wall = triangles_of([](int, int j, int) { return j == 0; });
    EXPECT_EQ(count_seen(hidden), count_seen(wall) + 6);
    EXPECT_EQ(count_paths(draw_surfaces(hidden, extent_in_space(hidden))), count_paths(draw_surfaces(wall, extent_in_space(wall))));
}

/// The numbers in the path data of the SVG's polygons, in order of drawing.
std::vector<Point2> middles_of(const std::string& svg) {
    std::vector<Point2> middles;
    const std::regex polygon("M([-0-9.]+),([-0-9.]+) ([-0-9.]+),([-0-9.]+) ([-0-9.]+),([-0-9.]+)z");
    for (std::sregex_iterator it(svg.begin(), svg.end(), polygon), end; it != end; ++it) {
        const auto number = [&](std::size_t i) { return std::stod((*it)[i]); };
        middles.push_back({(number(1) + number(3) + number(5)) / 3, (number(2) + number(4) + number(6)) / 3});
    }
    return middles;
}

TEST(SurfacePicture, PaintsTheFarthestFirst) {
    // Of the top of a block, what is farther away is higher up in the picture and comes first.
    auto top = triangles_of([](int, int, int k) { return k == 0; });
    std::erase_if(top, [](const SurfaceTriangle& t) { return std::ranges::any_of(t.corners, [](const Vec3& x) { return x.z != 1; }); });
    ASSERT_EQ(top.size(), 30u);
    const auto middles = middles_of(draw_surfaces(top, extent_in_space(top)));
    ASSERT_EQ(middles.size(), 30u);
    for (std::size_t i = 1; i < middles.size(); ++i) EXPECT_GE(middles[i].y, middles[i - 1].y - 0.2);
}

TEST(SurfacePicture, StandsInTheReportOfRunsWithBodiesThatDeform) {
    const auto dir = test_folder("surface_picture");
    write_tiny_run(dir);
    EXPECT_EQ(draw_cuts(read_run_files(dir)).mesh.find("in space"), std::string::npos);
    std::ofstream(dir / "case.toml", std::ios::app) << "[body.motion]\nkind = \"field\"\nvelocity = [0, 0, 0]\n";
    const std::string html = draw_cuts(read_run_files(dir)).mesh;
    const std::size_t at = html.find("Surfaces of the bodies, in space"), after = html.find("Whole domain");
    ASSERT_LT(at, after);
    const std::string part = html.substr(at, after - at);
    std::size_t pictures = 0;
    for (std::size_t i = part.find("<svg"); i != std::string::npos; i = part.find("<svg", i + 1)) ++pictures;
    EXPECT_EQ(pictures, 3u);
}

}  // namespace
}  // namespace kropla
