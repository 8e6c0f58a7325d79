#pragma once

#include "transfer/changed.h"
#include <kropla/transfer/transfer.h>

#include <span>
#include <vector>

namespace kropla {

/// The points nearest to these places on the interfaces between regions that the old cells have: in a cell beside it, with
/// no weight for the corner across. No cell if there is no interface.
[[nodiscard]] std::vector<Location> nearest_on_interface(const Mesh& before, const ChangedCells& changed,
                                                         std::span<const Vec3> places);

}  // namespace kropla
