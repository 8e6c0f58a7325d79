#pragma once

#include "case/table.h"
#include <kropla/domain/domain.h>

#include <span>
#include <string_view>
#include <vector>

namespace kropla {

/// Is the key's value an expression of the place, x, y or z, rather than a length?
[[nodiscard]] bool is_of_place(const CaseTable& table, std::string_view key);

/// Places all over the shape's surface, the same for the same shape.
[[nodiscard]] std::vector<Vec3> places_on(const Shape& shape);

/// A size that differs from place to place.
struct PlacedSize {
    LocalSize size;
    double most;  // [m] at the places of the surfaces
};
/// The expression of the place that stands there, and the most that it is on the surfaces of these shapes. Throws CaseError,
/// naming the place, where it is no length. So does the size, when it is asked for at such a place.
[[nodiscard]] PlacedSize read_placed_size(const CaseTable& table, std::string_view key, std::span<const Shape> shapes);

}  // namespace kropla
