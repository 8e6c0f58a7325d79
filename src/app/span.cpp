#include "app/span.h"

#include "simulate/cells.h"

#include <algorithm>

namespace kropla {

bool Span::holds(const Span& other) const {
    constexpr double rounding = 1e-13;  // [-] of the largest value: what a transfer may leave beyond bounds
    const double margin = rounding * std::max(std::abs(least), std::abs(most));
    return other.least >= least - margin && other.most <= most + margin;
}

Span span_of(const Mesh& mesh, const Array<Vertex, double>& values, Region region) {
    Span span;
    for (Vertex v : vertices_of(mesh, living_cells(mesh, region))) {
        span.least = std::min(span.least, values[v]);
        span.most = std::max(span.most, values[v]);
    }
    return span;
}

}  // namespace kropla
