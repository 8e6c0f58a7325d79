#include "report/hydrostatic.h"

#include "report/run_files.h"

namespace kropla {

Hydrostatic hydrostatic(std::string_view case_text) {
    const auto gravity = vector_of_case(case_text, "flow", "gravity");
    const auto density = number_of_case(case_text, "flow.region.\"surroundings\"", "density");
    const auto min = vector_of_case(case_text, "domain", "min"),
               max = vector_of_case(case_text, "domain", "max");
    if (!gravity || !density || !min || !max) return {};
    return {*density * *gravity, 0.5 * (*min + *max)};
}

}  // namespace kropla
