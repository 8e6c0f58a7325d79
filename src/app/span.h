#pragma once

#include <kropla/mesh/mesh.h>

#include <cmath>

namespace kropla {

/// The least and the most of a field.
struct Span {
    double least = INFINITY, most = -INFINITY;

    /// Is the other one within it, but for rounding?
    [[nodiscard]] bool holds(const Span& other) const;
};
/// At the vertices of a region, or everywhere.
[[nodiscard]] Span span_of(const Mesh& mesh, const Array<Vertex, double>& values, Region region = {});

}  // namespace kropla
