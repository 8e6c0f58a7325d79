#pragma once

#include "simulate/cells.h"
#include <kropla/simulate/heat.h>

#include <vector>

namespace kropla {

/// Where something acts on a region from outside.
struct Origin {
    enum class Kind { face, surface, held } kind;  // held: a region is, or begins with what it has
    std::size_t number;  // of the face, or the region
};

/// A vertex at a boundary, and what comes in or is exchanged there over its share of the area.
struct BoundaryShare {
    Vertex vertex;
    Origin origin;
    double flux = 0;         // [W] in, in the mean over the step
    double coefficient = 0;  // [W/K]
    double radiation = 0;    // [W/K^4] the share of sigma times emissivity
    double ambient = 0;      // [K]

    /// [W] out, at this temperature; and how it rises with it [W/K].
    [[nodiscard]] double given(double temperature) const;
    [[nodiscard]] double slope(double temperature) const;
    [[nodiscard]] bool exchanges() const { return coefficient > 0 || radiation > 0; }
};

struct FixedValue {
    Vertex vertex;
    double value;  // [K]
    Origin origin;
};

/// What acts on a step from outside. The same on all ranks: if a quantity is not finite, all of them throw.
struct HeatConditions {
    Array<Region, Array<Vertex, double>> source;  // its mean over the step at the region's vertices [W/m^3], or empty
    std::vector<BoundaryShare> shares;
    std::vector<FixedValue> fixed;  // at the step's end; each vertex once
};

/// Of the step from t to t + dt; if one region alone is stepped, at its vertices. Throws CaseError if a quantity is not
/// finite, or out of its range, or a power has no place to go.
[[nodiscard]] HeatConditions heat_conditions(const Mesh& before, const Mesh& current, const HeatOptions& options, Region only,
                                             double t, double dt, const Watch* watch);

}  // namespace kropla
