#pragma once

#include "app/step.h"
#include "app/steps_csv.h"
#include <kropla/mesh/quality.h>

#include <cstdint>

namespace kropla {

/// The row of a step: all of its columns are named here and nowhere else. (docs/output.md says what they mean.)
[[nodiscard]] StepRow step_row(std::int64_t step, const StepReport& report, const Mesh& mesh, const QualitySummary& quality,
                               const Case& given);

}  // namespace kropla
