// A limiter for projections, by redistribution:
//   [Farrell, Piggott, Pain, Gorman, Wilson 2009] Conservative interpolation between unstructured meshes via
//   supermesh
//     construction. CMAME 198: bounded by spreading the excess of lumped mass to neighbours with room.
// Changed: an excess goes out in proportion to room times mass, so that one pass takes all there is room for;
// what is left goes to the whole block, where one pass again is enough if a solution exists at all.

#include "transfer/limit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

class Spreading {
public:
    Spreading(const MassBlock& block, const ValueBounds& bounds, std::vector<double>& x)
        : block_(block), bounds_(bounds), x_(x) {}

    /// How far `i` is from its bound in the direction of `excess`, signed as it.
    [[nodiscard]] double room(std::size_t i, double excess) const {
        return excess > 0 ? std::max(0.0, bounds_.most[i] - x_[i]) : std::min(0.0, bounds_.least[i] - x_[i]);
    }

    /// Gives `excess` of the integral to the vertices, as far as they have room. Returns what is left of it.
    double give(double excess, std::span<const std::int32_t> to) {
        double capacity = 0;
        for (std::int32_t i : to) capacity += block_.mass[as_size(i)] * room(as_size(i), excess);
        if (capacity == 0) return excess;
        const double share = std::min(1.0, excess / capacity);
        for (std::int32_t i : to) x_[as_size(i)] += share * room(as_size(i), excess);
        return share < 1 ? 0 : excess - capacity;
    }

private:
    const MassBlock& block_;
    const ValueBounds& bounds_;
    std::vector<double>& x_;
};

}  // namespace

Limited limit(const MassBlock& block, const ValueBounds& bounds, std::vector<double>& x) {
    const std::vector<double> unlimited = x;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] < bounds.least[i] || x[i] > bounds.most[i]) out.push_back(i);
    if (out.empty()) return {};
    std::vector<double> excess;
    for (std::size_t i : out) {
        x[i] = std::clamp(x[i], bounds.least[i], bounds.most[i]);
        excess.push_back(block.mass[i] * (unlimited[i] - x[i]));
    }
    Spreading spreading(block, bounds, x);
    Limited result;
    for (std::size_t k = 0; k < out.size(); ++k)
        result.left += spreading.give(excess[k], block.rows.columns(out[k]));
    if (result.left != 0) {
        std::vector<std::int32_t> all(x.size());
        std::iota(all.begin(), all.end(), 0);
        result.left = spreading.give(result.left, all);
    }
    for (std::size_t i = 0; i < x.size(); ++i)
        result.moved = std::max(result.moved, std::abs(x[i] - unlimited[i]));
    return result;
}

}  // namespace kropla
