#include "transfer/kept.h"

#include <kropla/base/error.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace kropla {
namespace {

constexpr double most_lost = 1e-12;  // [-] of the integral of the absolute value: far above rounding

}  // namespace

RegionSums::RegionSums(const TransferPlan& plan) : after_(*plan.after) {
    std::int32_t regions = 0;
    for (Tet t : plan.geometry->changed.come) regions = std::max(regions, plan.after->region[t].value + 1);
    for (Tet t : plan.geometry->changed.gone) regions = std::max(regions, plan.before->region[t].value + 1);
    regions_.resize(static_cast<std::size_t>(regions));
}

void RegionSums::add_old(Region region, double part, double size) {
    Sums& sums = regions_[static_cast<std::size_t>(region.value)];
    sums.before += part;
    sums.size += size;
    ++sums.cells;
}

void RegionSums::add_new(Tet cell, double part) {
    Sums& sums = regions_[static_cast<std::size_t>(after_.region[cell].value)];
    sums.after += part;
    if (!sums.first.exists()) sums.first = cell;
}

void RegionSums::check() const {
    for (std::size_t r = 0; r < regions_.size(); ++r) {
        const Sums& sums = regions_[r];
        // A sum of numbers that underflow is off by the least of them.
        const double least = static_cast<double>(sums.cells) * std::numeric_limits<double>::min();
        if (std::abs(sums.after - sums.before) <= most_lost * sums.size + least) continue;
        const Vec3 x = sums.first.exists() ? centroid(after_, sums.first) : Vec3{};
        char text[240];
        std::snprintf(text, sizeof text,
                      "the integral of a field over region %zu would change by %.2g of it where cells change near "
                      "(%.6g, %.6g, %.6g) m: there is no vertex that could take up the difference",
                      r, (sums.after - sums.before) / sums.size, x.x, x.y, x.z);
        throw TransferError(text);
    }
}

void RegionSums::report(TransferReport& report, std::span<const double> weight) const {
    for (std::size_t r = 0; r < regions_.size(); ++r) {
        if (regions_[r].cells == 0) continue;
        const double w = weight.empty() ? 1 : weight[r];
        report.before += w * regions_[r].before;
        report.after += w * regions_[r].after;
        report.size += std::abs(w) * regions_[r].size;
    }
}

void check_weights(const Mesh& after, const ChangedCells& changed, std::span<const double> weight) {
    if (weight.empty()) return;
    for (Tet t : changed.come) {
        const auto region = static_cast<std::size_t>(after.region[t].value);
        if (region >= weight.size())
            throw FieldError("there are " + std::to_string(weight.size()) + " weights, none for region " +
                             std::to_string(region));
        if (!std::isfinite(weight[region]))
            throw FieldError("the weight of region " + std::to_string(region) + " is " +
                             std::to_string(weight[region]));
    }
}

void check_value(double value, const char* what, std::int32_t slot) {
    if (!std::isfinite(value))
        throw FieldError(what + (" " + std::to_string(slot)) + " has the value " + std::to_string(value));
}

}  // namespace kropla
