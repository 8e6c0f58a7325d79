#include "report/chart.h"

#include <gtest/gtest.h>

#include <limits>
#include <regex>

namespace kropla {
namespace {

std::ptrdiff_t count(const std::string& text, const std::string& what) {
    const std::regex pattern(what);
    return std::distance(std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator());
}

Chart chart_of(std::vector<double> values, Chart::Marks marks = Chart::Marks::lines) {
    Chart chart{"Cells & more", "s", {}, "t [s]", {{"first", values}, {"second", values}}, marks};
    for (std::size_t i = 0; i < values.size(); ++i) chart.x.push_back(static_cast<double>(i));
    return chart;
}

TEST(Chart, ShowsEachSeriesTheLimitAndTheValues) {
    Chart chart = chart_of({1, 2, 4});
    chart.limit = 5;
    const std::string html = draw_chart(chart);
    EXPECT_EQ(count(html, "class=\"line s[01]\""), 2);
    EXPECT_EQ(count(html, "<path class=\"limit\""), 1);
    EXPECT_EQ(count(html, "<title>"), 3);
    EXPECT_NE(html.find("Cells &amp; more [s]"), std::string::npos);
    EXPECT_NE(html.find("second: 4 s"), std::string::npos);
}

TEST(Chart, StacksColumns) {
    const std::string html = draw_chart(chart_of({1, 0, 4}, Chart::Marks::columns));
    std::smatch path;
    ASSERT_TRUE(std::regex_search(html, path, std::regex("class=\"column s1\" d=\"([^\"]*)\"")));
    EXPECT_EQ(count(path[1], "M"), 2);  // a column of no height is left out
}

TEST(Chart, DrawsManyRowsTogether) {
    std::vector<double> values(5000, 1.0);
    values[4321] = 99;
    const std::string html = draw_chart(chart_of(values));
    EXPECT_LE(count(html, "<title>"), 400);
    EXPECT_NE(html.find("first: 99 s"), std::string::npos);  // the peak is not lost
}

TEST(Chart, BearsEmptyConstantSingleAndNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    for (const auto& values : {std::vector<double>{}, {0, 0, 0}, {7}, {nan, infinity, 1}, {nan, nan}}) {
        for (const auto marks : {Chart::Marks::lines, Chart::Marks::columns}) {
            const std::string html = draw_chart(chart_of(values, marks));
            EXPECT_EQ(count(html, "d=\"[^\"]*(nan|inf)"), 0) << html;
            EXPECT_EQ(count(html, "</figure>"), 1);
        }
    }
}

}  // namespace
}  // namespace kropla
