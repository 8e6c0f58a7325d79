// The options of a flow and its state at rest; its step is in flow_step.cpp.
#include <kropla/simulate/flow.h>

#include <kropla/base/error.h>
#include "simulate/cells.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace kropla {
namespace {

void check_positive(const Property& property, const std::string& key) {
    for (std::size_t k = 0; k < property.values().size(); ++k) {
        const double value = property.values()[k];
        if (std::isfinite(value) && value > 0) continue;
        std::ostringstream message;
        message << key << " must be positive, got " << value;
        if (!property.constant()) message << " at " << property.temperatures()[k] << " K";
        throw CaseError(message.str());
    }
}

}  // namespace

void check_flow(const FlowOptions& options, const Mesh& mesh) {
    int flowing = 0;
    std::string expands;  // the key of a density of the temperature
    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        if (!options.regions[r]) continue;
        const std::string key = options.key + ".region." + std::to_string(r);
        check_positive(options.regions[r]->density, key + ".density");
        check_positive(options.regions[r]->viscosity, key + ".viscosity");
        ++flowing;
        if (!options.regions[r]->density.constant()) expands = key + ".density";
    }
    if (flowing == 0) throw CaseError(options.key + ".region: no region is a liquid or gas");
    if (!expands.empty() && flowing > 1)
        throw CaseError(expands + " must be a number where more than one region flows");
    if (!expands.empty() && std::ranges::none_of(options.faces, [](const FlowFace& face) { return face.kind == FlowFace::Kind::open; }))
        throw CaseError(expands + " depends on the temperature, and what expands has no way out: open a face");
    if (!is_finite(options.gravity)) throw CaseError(options.key + ".gravity must be finite");
    if (!(options.tolerance > 0 && options.tolerance < 1))
        throw CaseError(options.key + ".tolerance must be between 0 and 1, got " +
                        std::to_string(options.tolerance));
    if (count_regions(mesh) != options.regions.size())
        throw CaseError(options.key + ".region: the mesh has " + std::to_string(count_regions(mesh)) +
                        " regions, given are " + std::to_string(options.regions.size()));
}

FlowState still_flow(const Mesh& mesh) {
    return {Array<Vertex, Vec3>(mesh.position.size()), Array<Vertex, double>(mesh.position.size(), 0.0)};
}

}  // namespace kropla
