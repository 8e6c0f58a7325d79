// kropla-pictures RUN_DIR OUT_DIR: pictures of a run, like figures 2, 3, 5 and 6 of the paper, as PNG files.
// It draws by VTK, which needs a screen: tools/draw-pictures gives it one in memory.

#include <kropla/base/error.h>
#include "flow.h"
#include "frames.h"
#include "layout.h"
#include "report/units.h"
#include "scene.h"
#include "sheet.h"

#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <vector>

namespace kropla::pictures {

namespace {

constexpr Colour window_colour = {0.75, 0.10, 0.15};
constexpr Colour faint = {0.40, 0.44, 0.50};

std::string thousands(vtkIdType n) {
    std::string digits = std::to_string(n);
    for (std::ptrdiff_t i = std::ssize(digits) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), 1, ' ');
    return digits;
}

/// A view of the neighbourhood of the first body: `radii` of its radii from the middle to the upper edge.
View around_body(const RunFrame& frame, const Place& place, double radii) {
    return {place, frame.centre.x, frame.centre.y, frame.centre.z, 2 * radii * frame.radius};
}

/// Where `inner` lies in `outer`, on the sheet.
Place window_in(const View& outer, const View& inner) {
    const double scale = metres_per_pixel(outer);
    const double width = inner.place.width * metres_per_pixel(inner) / scale, height = inner.height / scale;
    return {outer.place.left + outer.place.width / 2 + (inner.x - outer.x) / scale - width / 2,
            outer.place.top + outer.place.height / 2 - (inner.z - outer.z) / scale - height / 2, width,
            height};
}

void add_mesh_view(Sheet& sheet, const View& view, const RunFrame& frame, double line_width) {
    add_view(sheet, view, {coloured_by_region(opened(frame.grid, frame.centre.y), line_width)});
    add_outline(sheet, view.place, border_colour, 1.5);
}

/// "72 562 tetrahedra and 1 812 prisms"
std::string cell_count(vtkUnstructuredGrid* grid) {
    vtkIdType prisms = 0;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
        if (grid->GetCellType(cell) == VTK_WEDGE) ++prisms;
    const std::string tets = fmt::format("{} tetrahedra", thousands(grid->GetNumberOfCells() - prisms));
    return prisms == 0 ? tets : fmt::format("{} and {} prisms", tets, thousands(prisms));
}

/// The initial mesh: the whole box and, beside it, the droplet's neighbourhood. As the paper's figures 2b,
/// 3b, 6a, 6b.
void draw_initial_mesh(const RunFrame& frame, const std::filesystem::path& file) {
    Sheet sheet = make_sheet(1600, 1130);
    const View box = whole_box(frame, {20, 20, 510, 1020});
    const double left = box.place.left + box.place.width + 30;
    const View near = around_body(frame, {left, 20, 1580 - left, 1020}, 2);
    add_mesh_view(sheet, box, frame, 1.6);
    add_mesh_view(sheet, near, frame, 2.6);
    add_outline(sheet, window_in(box, near), window_colour, 3);
    add_outline(sheet, near.place, window_colour, 3);
    add_scale_bar(sheet, box, bar_length(box));
    add_scale_bar(sheet, near, bar_length(near));
    add_text(sheet, box.place.left + box.place.width / 2, 1065, "The box, cut open",
             {.size = 24, .bold = true});
    add_text(sheet, box.place.left + box.place.width / 2, 1098,
             cell_count(frame.grid),
             {.size = 20, .colour = faint});
    add_text(sheet, left + near.place.width / 2, 1065, "Around the droplet", {.size = 24, .bold = true});
    add_text(sheet, left + near.place.width / 2, 1098,
             "whole cells; the droplet is a region of the same mesh", {.size = 20, .colour = faint});
    write_png(sheet, file);
}

/// Ten positions of the droplet with its neighbourhood. As the paper's figure 6c.
void draw_positions(const std::vector<RunFrame>& frames, const std::filesystem::path& file) {
    constexpr int columns = 5;
    constexpr double side = 306, gap = 14, caption = 40;
    const int rows = static_cast<int>(frames.size() + columns - 1) / columns;
    Sheet sheet = make_sheet(1600, static_cast<int>(gap + rows * (side + caption + gap)));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double left = 7 + static_cast<double>(i % columns) * (side + gap);
        const double top = gap + static_cast<double>(i / columns) * (side + caption + gap);
        const View view = around_body(frames[i], {left, top, side, side}, 1.6);
        add_mesh_view(sheet, view, frames[i], 1.8);
        const double moved = distance(frames[i].centre, frames.front().centre);
        add_text(sheet, left + side / 2, top + side + caption / 2 + 2,
                 fmt::format("{}    moved {}", time_label(frames[i].time), with_unit(moved, "m", 3)), {.size = 20});
        if (i + 1 == frames.size()) add_scale_bar(sheet, view, bar_length(view));
    }
    write_png(sheet, file);
}

void draw_boxes(const std::vector<RunFrame>& frames, const std::filesystem::path& file) {
    Sheet sheet = boxes_side_by_side(frames, 0, [](Sheet& s, const View& view, const RunFrame& frame) {
        add_mesh_view(s, view, frame, 1.4);
    });
    write_png(sheet, file);
}

void draw_temperature(const std::vector<RunFrame>& frames, const std::filesystem::path& file) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const RunFrame& frame : frames) {
        const double* range = frame.grid->GetPointData()->GetArray("temperature")->GetRange();
        least = std::min(least, range[0]);
        most = std::max(most, range[1]);
    }
    const ColourScale scale = scale_over(least, most);
    const auto colours = heat_colours(scale.least, scale.most);
    Sheet sheet = boxes_side_by_side(frames, 130, [&](Sheet& s, const View& view, const RunFrame& frame) {
        add_view(s, view, {coloured_by_field(section(frame.grid, frame.centre.y), "temperature", colours)});
    });
    const double height = sheet.height - 70;
    add_text(sheet, 1500, 30, "T [K]", {.size = 22, .bold = true});
    add_colour_bar(sheet, {1482, 60, 30, height - 50}, colours, scale.least, scale.most);
    write_png(sheet, file);
}

/// The cells around the droplet coloured by their aspect ratio.
void draw_quality(const std::vector<RunFrame>& frames, const std::filesystem::path& file) {
    constexpr double gap = 16, side = 470;
    const auto colours = quality_colours();
    Sheet sheet = make_sheet(1600, 560);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double left = gap + static_cast<double>(i) * (side + gap);
        const View view = around_body(frames[i], {left, gap, side, side}, 2);
        const auto facets = opened(frames[i].grid, frames[i].centre.y);
        add_view(sheet, view, {coloured_by_quality(facets, colours, 1.6), outlines_of_bodies(facets, 6)});
        add_outline(sheet, view.place, border_colour, 1.5);
        add_text(sheet, left + side / 2, gap + side + 32, time_label(frames[i].time), {.size = 24});
    }
    add_text(sheet, 1510, 30, "R/r", {.size = 24, .bold = true});
    add_colour_bar(sheet, {1484, 60, 30, 400}, colours, 3, 10);
    add_text(sheet, 1525, 490, "3 is perfect", {.size = 18, .colour = faint});
    write_png(sheet, file);
}

std::vector<RunFrame> read_evenly(const std::filesystem::path& dir, std::size_t count) {
    std::vector<RunFrame> frames;
    for (const SeriesEntry& entry : evenly(frames_of_run(dir), count))
        frames.push_back(read_run_frame(dir, entry));
    return frames;
}

void draw_all(const std::filesystem::path& dir, const std::filesystem::path& out) {
    std::filesystem::create_directories(out);
    const std::vector<RunFrame> ten = read_evenly(dir, 10);
    draw_initial_mesh(ten.front(), out / "initial-mesh.png");
    draw_positions(ten, out / "positions.png");
    const std::vector<RunFrame> three = read_evenly(dir, 3);
    draw_boxes(three, out / "whole-box.png");
    draw_quality(three, out / "quality.png");
    if (has_field(ten.front(), "temperature")) draw_temperature(read_evenly(dir, 4), out / "temperature.png");
    if (has_field(ten.front(), "velocity")) draw_flow(dir, out / "velocity.png", out / "pressure.png");
}

}  // namespace

}  // namespace kropla::pictures

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("usage: kropla-pictures RUN_DIR OUT_DIR\n", stderr);
        return 2;
    }
    try {
        kropla::pictures::draw_all(argv[1], argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "kropla-pictures: %s\n", error.what());
        return 5;
    }
    return 0;
}
