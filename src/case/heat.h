#pragma once

#include "case/case.h"
#include "case/table.h"

namespace kropla {

/// The keys of [heat.face], in the order of the patches.
inline constexpr std::array<std::string_view, 6> face_keys = {"x_min", "x_max", "y_min",
                                                              "y_max", "z_min", "z_max"};

/// The name of a region: "surroundings", or the body's.
[[nodiscard]] std::string region_name(const Domain& domain, std::size_t region);
/// With the mesh goes what is in a rigid body that is wholly in the box.
[[nodiscard]] Carried carried_in(const Domain& domain, std::size_t region);

/// Reads [heat]: [heat.region.NAME] for the surroundings and every body, and [heat.face]. A body's material
/// is carried with it; the surroundings rest, but for making way. Throws CaseError.
[[nodiscard]] HeatOptions read_heat(const CaseTable& table, const Domain& domain, WrittenHeat& written);

}  // namespace kropla
