#include "io/xml.h"
#include "report/svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace kropla {
namespace {

TEST(Svg, EscapesText) { EXPECT_EQ(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;"); }

TEST(Svg, WritesPixelsShort) {
    EXPECT_EQ(pixels(12.34), "12.3");
    EXPECT_EQ(pixels(-0.04), "0");
    EXPECT_EQ(pixels(-0.26), "-0.3");
    EXPECT_EQ(pixels(7), "7");
}

TEST(Svg, WritesNumbersForReading) {
    EXPECT_EQ(readable(9.8765), "9.877");
    EXPECT_EQ(readable(49481), "49481");
    EXPECT_EQ(readable(0.00012), "0.00012");
    EXPECT_EQ(readable(1.5e9), "1.5e+09");
    EXPECT_EQ(readable_count(49481), "49\u202f481");
    EXPECT_EQ(readable_count(1234567), "1\u202f234\u202f567");
    EXPECT_EQ(readable_count(-481), "-481");
    EXPECT_EQ(readable_time(0.0125), "12.5 ms");
    EXPECT_EQ(readable_time(200), "3 min 20 s");
    EXPECT_EQ(readable_time(0), "0 s");
}

TEST(Svg, InterruptsLinesAtWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Point2> points = {{0, 1}, {2, 3}, {4, nan}, {6, 7}, {8, 9}};
    EXPECT_EQ(line_path(points), "M0,1L2,3M6,7L8,9");
}

TEST(Svg, PutsTicksAtRoundNumbers) {
    EXPECT_EQ(round_ticks(0, 10, 6), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(round_ticks(2.9, 10.4, 5), (std::vector<double>{4, 6, 8, 10}));
    for (const double scale : {1e-9, 1.0, 1e9}) {
        for (const double most : {0.3, 1.0, 1.7, 4.2, 9.9}) {
            const std::vector<double> ticks = round_ticks(0, most * scale, 5);
            EXPECT_GE(ticks.size(), 2U) << most * scale;
            EXPECT_LE(ticks.size(), 5U) << most * scale;
        }
    }
}

TEST(Svg, EndsWithTicksThatNoNumberTellsApart) {
    const double next = std::nextafter(1000.0, 2000.0);
    EXPECT_LE(round_ticks(1000, next, 6).size(), 6U);
    EXPECT_LE(round_ticks(-next, -1000, 6).size(), 6U);
    EXPECT_LE(round_ticks(1000, 1000, 6).size(), 6U);
    EXPECT_LE(round_ticks(1e9, 1e9 + 1e-3, 6).size(), 6U);
}

TEST(Svg, TellsTicksApart) {
    EXPECT_EQ(digits_for(std::vector{0.0, 1.0, 2.0}), 5);
    EXPECT_EQ(digits_for(std::vector{1000.0, 1000.005, 1000.01}), 7);
    EXPECT_FALSE(is_flat(1000, 1000.01));
    EXPECT_TRUE(is_flat(1000, 1000.0001));
    EXPECT_TRUE(is_flat(0, 0));
    EXPECT_FALSE(is_flat(-1e-20, 1e-20));
}

TEST(Svg, ColoursFromBlackToLightYellow) {
    EXPECT_EQ(inferno(0), "#000004");
    EXPECT_EQ(inferno(1), "#fcffa4");
    EXPECT_EQ(inferno(-3), "#000004");
    EXPECT_EQ(inferno(5.0 / 9), "#cf4446");
}

}  // namespace
}  // namespace kropla
