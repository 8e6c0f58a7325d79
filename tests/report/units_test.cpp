#include "report/units.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

TEST(Units, SuitTheSize) {
    EXPECT_EQ(with_unit(0.0123456, "W"), "12.35 mW");
    EXPECT_EQ(with_unit(-63200, "J", 3), "-63.2 kJ");
    EXPECT_EQ(with_unit(2e-4, "m"), "200 µm");
    EXPECT_EQ(with_unit(0.8, "m/s"), "0.8 m/s");
    EXPECT_EQ(with_unit(0.08, "m/s"), "80 mm/s");
    EXPECT_EQ(with_unit(4.18879e-9, "m^3"), "4.189 mm³");
    EXPECT_EQ(with_unit(20, "m^3"), "20 m³");
    EXPECT_EQ(with_unit(0.5, "m^3/s"), "0.5 m³/s");
    EXPECT_EQ(with_unit(1.767e-6, "m^3"), "1.767 cm³");
    EXPECT_EQ(with_unit(3e-10, "m^3/s"), "0.3 mm³/s");
    EXPECT_EQ(with_unit(1.94e-2, "N", 3), "19.4 mN");
    EXPECT_EQ(with_unit(1507, "Pa", 3), "1.51 kPa");
    EXPECT_EQ(with_unit(12000, "m"), "12000 m");
    EXPECT_EQ(with_unit(3e-18, "J"), "3e-06 pJ");
}

TEST(Units, StayWhereThereIsNothingToScale) {
    EXPECT_EQ(with_unit(0, "J"), "0 J");
    EXPECT_EQ(with_unit(-0.0, "W"), "0 W");
    EXPECT_EQ(with_unit(2391.4, "K"), "2391 K");
    EXPECT_EQ(with_unit(0.25, ""), "0.25");
    EXPECT_EQ(with_unit(3, "m^2"), "3 m²");
}

TEST(Units, DigitsTellValuesApart) {
    const auto both = [](double a, double b) {
        const int decimals = decimals_to_tell(a, b);
        return fixed(a, decimals) + " " + fixed(b, decimals);
    };
    EXPECT_EQ(both(2400, 2391.2), "2400 2391");
    EXPECT_EQ(both(2400, 2399.58), "2400.00 2399.58");
    EXPECT_EQ(both(300, 300 + 1e-12), "300 300");
    EXPECT_EQ(both(0, 0), "0 0");
    EXPECT_EQ(fixed(-1e-9, 2), "0.00");
    EXPECT_EQ(fixed(-0.006, 2), "-0.01");
}

TEST(Units, OfAPlaceAreOne) {
    EXPECT_EQ(place_with_unit({-1e-20, 1.3e-8, 0.003}, 0.013), "(0.0, 0.0, 3.0) mm");
    EXPECT_EQ(place_with_unit({2e-4, 0, 1e-5}, 2e-4), "(200, 0, 10) µm");
}

}  // namespace
}  // namespace kropla
