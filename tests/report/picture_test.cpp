#include "../io/layered.h"
#include "report/picture.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <sstream>

namespace kropla {
namespace {

/// Three cubes side by side, the middle one a body, cut lengthways.
struct CutRow {
    Mesh mesh = grid_of_cubes({3, 1, 1}, [](int i, int, int) { return Region(i == 1 ? 1 : 0); });
    std::vector<CutPolygon> cut = cut_mesh(mesh, plane_across(1, {0, 0.4, 0}));
};

/// The area that the paths of an SVG with this pattern of attributes cover [pixels^2].
double area_of_paths(const std::string& svg, const std::string& attributes) {
    const std::regex path("<path " + attributes + " d=\"([^\"]*)\"");
    double doubled = 0;
    for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it) {
        std::string data = (*it)[1];
        for (char& c : data) c = c == ',' ? ' ' : c;
        std::istringstream polygons(data);
        for (std::string polygon; std::getline(polygons, polygon, 'z');) {
            std::istringstream in(polygon.substr(1));
            std::vector<Point2> p;
            for (Point2 q; in >> q.x >> q.y;) p.push_back(q);
            for (std::size_t i = 0; i < p.size(); ++i) {
                const Point2 a = p[i], b = p[(i + 1) % p.size()];
                doubled -= a.x * b.y - b.x * a.y;  // y points down
            }
        }
    }
    return doubled / 2;
}

TEST(Picture, ShowsEveryRegionInItsColour) {
    const CutRow row;
    const std::string svg = draw_cells(row.cut, extent(row.cut));
    EXPECT_NE(svg.find("viewBox=\"0 0 300 100\""), std::string::npos);
    EXPECT_NEAR(area_of_paths(svg, "class=\"r0\""), 20000, 60);  // coordinates are rounded to 0.1
    EXPECT_NEAR(area_of_paths(svg, "class=\"r1\""), 10000, 60);
}

TEST(Picture, DividesAFieldIntoBandsWithoutGaps) {
    const CutRow row;
    Array<Vertex, double> field(row.mesh.position.size());
    for (const Vertex v : row.mesh.position.indices()) field[v] = row.mesh.position[v].x;
    const std::string svg = draw_field(row.cut, field, {0, 3}, extent(row.cut));
    EXPECT_NEAR(area_of_paths(svg, "fill=\"#[0-9a-f]*\" stroke=\"#[0-9a-f]*\""), 30000, 150);
    const std::regex band("<path fill");
    EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), band), {}), 32);
}

TEST(Picture, ShowsAnEvenFieldInOneColour) {
    const CutRow row;
    Array<Vertex, double> even(row.mesh.position.size(), 1000.0);
    even[Vertex(0)] = std::nextafter(1000.0, 2000.0);  // but for rounding
    const ColourScale scale = scale_over(1000, even[Vertex(0)]);
    const std::string svg = draw_field(row.cut, even, scale, extent(row.cut));
    const std::regex fill("<path fill");
    EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), fill), {}), 1) << svg;
    EXPECT_NE(draw_colour_bar("T [K]", scale).find(">1000<"), std::string::npos);
    for (const ColourScale& still : {scale_over(0, 0), signed_scale(0, 0)}) {
        EXPECT_EQ(still.least, 0);
        EXPECT_EQ(still.most, 1);
    }
    EXPECT_EQ(signed_scale(-2, 1).least, -2);
    EXPECT_EQ(signed_scale(-2, 1).most, 1);
}

TEST(Picture, LeavesOutWhatIsOutsideTheWindow) {
    const CutRow row;
    const std::string svg = draw_cells(row.cut, {{1.1, 0.1}, {1.9, 0.9}});
    EXPECT_NE(svg.find("class=\"r1\""), std::string::npos);
    EXPECT_EQ(svg.find("class=\"r0\""), std::string::npos);
}

TEST(Picture, NarrowsItsWindowUntilFewEnoughAreSeen) {
    const Mesh mesh = grid_of_cubes({20, 1, 20}, [](int, int, int) { return surroundings; });
    const auto cut = cut_mesh(mesh, plane_across(1, {0, 0.4, 0}));
    const CutWindow all = extent(cut), fewer = narrowed(all, cut, {10, 10}, 200);
    EXPECT_GT(fewer.min.x, all.min.x);
    EXPECT_LT(fewer.max.x, all.max.x);
    EXPECT_NEAR(fewer.min.x + fewer.max.x, 20, 1e-9);
    EXPECT_EQ(narrowed(all, cut, {10, 10}, cut.size()).max.x, all.max.x);
}

TEST(Picture, ShowsPrismsInAShadeOfTheirOwn) {
    const Mesh mesh = layered_cube(4, {3, 2});
    const auto cut = cut_mesh(mesh, plane_across(1, {0, 1.9e-3, 0}));
    const std::string svg = draw_cells(cut, extent(cut));
    double pixels = 0, outside = 0;
    for (const char* cells : {"r0", "r1", "p0", "p1"}) {
        const double own = area_of_paths(svg, "class=\"" + std::string(cells) + "\"");
        EXPECT_GT(own, 1000) << cells;
        pixels += own;
    }
    for (const CutPolygon& polygon : cut)
        if (polygon.of_prism && polygon.region == surroundings) outside += area(polygon);
    EXPECT_NEAR(pixels, 300 * 300, 500);
    EXPECT_NEAR(area_of_paths(svg, "class=\"p0\""), outside * (300 / 4e-3) * (300 / 4e-3), 200);
}

}  // namespace
}  // namespace kropla
