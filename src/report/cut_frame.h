#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/vtk.h>
#include "report/picture.h"
#include "report/run_files.h"

#include <span>
#include <string>
#include <vector>

namespace kropla {

/// Where the first body is; without one, the middle of the mesh.
struct Spot {
    Vec3 centre;    // [m]
    double radius;  // [m] half the body's greatest extent; 0 without a body
};

/// A frame, ready to be drawn.
struct CutFrame {
    double time;
    Frame frame;
    Spot spot;
    CutPlane plane;
    std::vector<CutPolygon> cut;
};

/// The axis along which the first body moves least; y, unless another is clearly better.
[[nodiscard]] int axis_across_path(const std::vector<CutFrame>& frames);
/// Start, middle and end of a run, cut across that axis through the first body's centre. Throws FileError,
/// Interrupted.
[[nodiscard]] std::vector<CutFrame> read_cuts(const RunFiles& run, const Watch* watch);

/// The window with all of the cut, or with the first body and what is around it; smaller where there are too
/// many cells to draw. Coordinates on the cut have their origin at the body's centre.
[[nodiscard]] CutWindow whole(const CutFrame& f);
[[nodiscard]] CutWindow magnified(const CutFrame& f);

/// "t = 640 ms · 100 × 160 mm"
[[nodiscard]] std::string caption(const CutFrame& f, const CutWindow& window);

/// A row of pictures, one per frame; `draw` makes the SVG of a frame in a window, `window` chooses it.
template <class Window, class Draw>
std::string row(const std::string& title, std::span<const CutFrame> frames, Window window, Draw draw) {
    std::string html = "<h3>" + title + "</h3><div class=\"pictures\">";
    for (const CutFrame& f : frames) {
        const CutWindow seen = window(f);
        html += "<figure class=\"card\">" + draw(f, seen) + caption(f, seen) + "</figure>";
    }
    return html + "</div>";
}

/// Nothing if there is none.
[[nodiscard]] const NodalField* field_named(const CutFrame& f, const std::string& name);

}  // namespace kropla
