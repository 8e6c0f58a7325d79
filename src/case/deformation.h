#pragma once

#include "case/expression.h"
#include <kropla/domain/domain.h>

#include <array>
#include <string>

namespace kropla {

/// Where a velocity [m/s], of x, y, z and t, takes a place. `what` names it in errors: body[0].motion.velocity.
/// The deformation throws CaseError if the velocity is no finite number where it is asked for.
[[nodiscard]] Deformation deformation_by(const std::array<Expression, 3>& velocity, const std::string& what);

}  // namespace kropla
