#pragma once

#include "transfer/mass.h"

#include <span>
#include <vector>

namespace kropla {

/// The bounds of each unknown of a block.
struct ValueBounds {
    std::vector<double> least, most;
};

struct Limited {
    double moved = 0;  // the largest change of a value
    double left = 0;   // of the integral, that found no room within the bounds: to be added
};

/// Brings the values of the block's free vertices into their bounds and keeps the integral: what a vertex has
/// too much or too little goes to those next to it that have room, in proportion to their room times their
/// mass; what finds none there, to all of the block in the same way.
Limited limit(const MassBlock& block, const ValueBounds& bounds, std::vector<double>& x);

}  // namespace kropla
