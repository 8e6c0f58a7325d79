#pragma once

#include "transfer/cluster.h"
#include "transfer/mass.h"
#include "transfer/overlap.h"
#include <kropla/transfer/transfer.h>

#include <array>
#include <vector>

namespace kropla {

/// A vertex that is new, or in a new place, but belongs to an interface or a layer: it gets the old field there.
struct GivenVertex {
    Vertex vertex;
    std::array<Vertex, 4> from;
    std::array<double, 4> weights;
};

/// What a transfer plan knows: what changed, the overlaps of old and new cells, and the systems to be solved.
struct TransferGeometry {
    ChangedCells changed;
    Overlaps overlaps;
    Clusters clusters;
    std::vector<MassBlock> blocks;   // per cluster; empty where another has taken it in
    std::vector<GivenVertex> given;  // ascending
};

}  // namespace kropla
