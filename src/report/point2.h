#pragma once

namespace kropla {

/// A point of a plane: of a cut [m], or of a drawing [pixels].
struct Point2 {
    double x = 0, y = 0;
    bool operator==(const Point2&) const = default;
};

}  // namespace kropla
