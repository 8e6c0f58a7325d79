#pragma once

#include "case/table.h"
#include <kropla/simulate/material.h>

#include <string>

namespace kropla {

struct WrittenProperty {
    Property property;
    std::string written;  // as a TOML value
};

/// Reads a property of a material: a number, an expression of `T`, or a table { T = [..], value = [..] }. An expression
/// is taken as a table of it, around `usual_temperature` [K] as far as it is positive and finite, from 0 to 30,000 K,
/// close enough that straight lines miss it by at most a millionth. Throws CaseError if a value is not positive, at
/// `usual_temperature` or anywhere in a table, or the temperatures of a table do not rise.
[[nodiscard]] WrittenProperty read_property(const CaseTable& table, std::string_view key, double usual_temperature);

}  // namespace kropla
