#include "flow.h"

#include "frames.h"
#include "io/file.h"
#include "layout.h"
#include "report/arrows.h"
#include "report/hydrostatic.h"
#include "report/solids.h"
#include "report/units.h"
#include "scene.h"
#include "sheet.h"

#include <kropla/io/vtk.h>

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkExtractCells.h>
#include <vtkGeometryFilter.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla::pictures {
namespace {

constexpr const char* shown = "shown";
constexpr double arrows_across = 15;  // a box
constexpr double least_arrow = 0.2;   // of the largest: shorter ones are but dots

/// A frame of a flow, cut through the first body.
struct FlowFrame {
    RunFrame run;
    Frame frame;  // the same, as the report has it
    std::vector<bool> solid;
    vtkSmartPointer<vtkPolyData> whole, flowing, bodies;  // parts of the section
};

const Array<Vertex, Vec3>& velocity_of(const FlowFrame& f) {
    return std::ranges::find(f.frame.vectors, "velocity", &NodalVectorField::name)->values;
}

/// The cells of the section that are solid, or those that are not.
vtkSmartPointer<vtkPolyData> part(vtkPolyData* cut, const std::vector<bool>& solid, bool wanted) {
    vtkDataArray* region = cut->GetCellData()->GetArray("region");
    vtkNew<vtkIdList> kept;
    for (vtkIdType cell = 0; cell < cut->GetNumberOfCells(); ++cell)
        if (solid[static_cast<std::size_t>(region->GetTuple1(cell))] == wanted) kept->InsertNextId(cell);
    vtkNew<vtkExtractCells> cells;
    cells->SetInputData(cut);
    cells->SetCellList(kept);
    vtkNew<vtkGeometryFilter> facets;
    facets->SetInputConnection(cells->GetOutputPort());
    facets->Update();
    return facets->GetOutput();
}

/// As `section`; with liquid bodies in parts that do not share points, so that the pressure of each is its own.
vtkSmartPointer<vtkPolyData> parted_section(vtkUnstructuredGrid* grid, double y) {
    if (!grid->GetPointData()->HasArray("pressure_within")) return section(grid, y);
    vtkDataArray* region = grid->GetCellData()->GetArray("region");
    vtkNew<vtkAppendPolyData> parts;
    for (const bool inside : {false, true}) {
        vtkNew<vtkIdList> kept;
        for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
            if ((region->GetTuple1(cell) > 0) == inside) kept->InsertNextId(cell);
        vtkNew<vtkExtractCells> cells;
        cells->SetInputData(grid);
        cells->SetCellList(kept);
        cells->Update();
        vtkSmartPointer<vtkPolyData> cut = section(cells->GetOutput(), y);
        if (inside) {
            vtkNew<vtkDoubleArray> within;
            within->DeepCopy(cut->GetPointData()->GetArray("pressure_within"));
            within->SetName("pressure");
            cut->GetPointData()->RemoveArray("pressure");
            cut->GetPointData()->AddArray(within);
        }
        parts->AddInputData(cut);
    }
    parts->Update();
    return parts->GetOutput();
}

/// Nothing if it does not flow.
std::vector<FlowFrame> read_flow_frames(const std::filesystem::path& dir) {
    constexpr std::size_t count = 4;
    std::vector<SeriesEntry> entries = evenly(frames_of_run(dir), count + 1);
    if (entries.size() > count) entries.erase(entries.begin());  // the start, where little flows
    std::vector<FlowFrame> frames;
    for (const SeriesEntry& entry : entries) {
        FlowFrame f{.run = read_run_frame(dir, entry), .frame = read_vtu(dir / entry.file), .solid = {},
                    .whole = {}, .flowing = {}, .bodies = {}};
        const auto pressure = std::ranges::find(f.frame.fields, "pressure", &NodalField::name);
        const auto velocity = std::ranges::find(f.frame.vectors, "velocity", &NodalVectorField::name);
        if (pressure == f.frame.fields.end() || velocity == f.frame.vectors.end()) continue;
        if (std::ranges::all_of(velocity->values, [](const Vec3& u) { return squared_norm(u) == 0; }))
            continue;
        f.solid = solid_regions(f.frame.mesh, pressure->values);
        f.whole = parted_section(f.run.grid, f.run.centre.y);
        f.flowing = part(f.whole, f.solid, false);
        f.bodies = part(f.whole, f.solid, true);
        frames.push_back(std::move(f));
    }
    return frames;
}

/// Gives the points of what flows the array `shown`, in the unit that suits all frames. Returns its range and
/// the unit.
template <class Value>
std::pair<ColourScale, std::string> show(const std::vector<FlowFrame>& frames, const char* si, Value value) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::vector<vtkSmartPointer<vtkDoubleArray>> arrays;
    for (const FlowFrame& f : frames) {
        auto& array = arrays.emplace_back(vtkSmartPointer<vtkDoubleArray>::New());
        array->SetName(shown);
        for (vtkIdType p = 0; p < f.flowing->GetNumberOfPoints(); ++p) {
            array->InsertNextValue(value(f.flowing, p));
            least = std::min(least, array->GetValue(p));
            most = std::max(most, array->GetValue(p));
        }
        f.flowing->GetPointData()->AddArray(array);
    }
    const ScaledUnit unit = unit_for(std::max(std::abs(least), std::abs(most)), si);
    for (const auto& array : arrays)
        for (vtkIdType p = 0; p < array->GetNumberOfTuples(); ++p)
            array->SetValue(p, array->GetValue(p) * unit.scale);
    return {{least * unit.scale, most * unit.scale}, unit.name};
}

std::vector<Arrow> arrows_of(const FlowFrame& f, const CutPlane& plane, double most) {
    std::vector<CutPolygon> flowing, bodies;
    for (const CutPolygon& polygon : cut_mesh(f.frame.mesh, plane))
        (f.solid[static_cast<std::size_t>(polygon.region.value)] ? bodies : flowing).push_back(polygon);
    const double spacing = (f.run.max.x - f.run.min.x) / arrows_across;
    std::vector<Arrow> all =
        arrows(flowing, bodies, plane, velocity_of(f), {.spacing = spacing, .most = most});
    std::erase_if(all, [&](const Arrow& arrow) { return arrow.length < least_arrow * spacing; });
    return all;
}

void draw(const std::vector<FlowFrame>& frames, const std::filesystem::path& file, const ColourScale& scale,
          const std::array<std::string, 2>& title, double most_of_arrows) {
    const auto colours = colours_of(scale);
    std::vector<RunFrame> runs;
    for (const FlowFrame& f : frames) runs.push_back(f.run);
    std::size_t i = 0;
    Sheet sheet = boxes_side_by_side(runs, 150, [&](Sheet& s, const View& view, const RunFrame& run) {
        const FlowFrame& f = frames[i++];
        const CutPlane plane = plane_across(1, run.centre);
        const double front = 0.02 * view.height, thin = 1.2 * metres_per_pixel(view);
        const auto lines = most_of_arrows > 0 ? arrows_of(f, plane, most_of_arrows) : std::vector<Arrow>{};
        add_view(s, view, {coloured_by_field(f.flowing, shown, colours), plain(f.bodies, 0.60, 0.64, 0.68),
                           outlines_of_bodies(f.whole, 4), drawn_arrows(lines, plane, thin, front)});
        add_outline(s, view.place, border_colour, 1.5);
    });
    const double height = sheet.height - 70;
    add_text(sheet, 1455, 30, title[0], {.size = 22, .align = 0, .bold = true});
    add_text(sheet, 1455, 58, title[1], {.size = 18, .align = 0});
    add_colour_bar(sheet, {1462, 82, 30, height - 72}, colours, scale.least, scale.most);
    write_png(sheet, file);
}

}  // namespace

void draw_flow(const std::filesystem::path& run, const std::filesystem::path& velocity_file,
               const std::filesystem::path& pressure_file) {
    const std::vector<FlowFrame> frames = read_flow_frames(run);
    if (frames.empty()) return;
    double most = 0;
    auto [speeds, speed_unit] = show(frames, "m/s", [&](vtkPolyData* cut, vtkIdType p) {
        const double* u = cut->GetPointData()->GetArray("velocity")->GetTuple3(p);
        const double speed = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
        most = std::max(most, speed);
        return speed;
    });
    speeds = scale_over(0, speeds.most, light_blues);
    draw(frames, velocity_file, speeds, {"speed", "[" + speed_unit + "]"}, most);

    const std::filesystem::path case_file = run / "case.toml";
    const Hydrostatic at_rest = hydrostatic(std::filesystem::exists(case_file) ? read_file(case_file) : "");
    auto [pressures, pressure_unit] = show(frames, "Pa", [&](vtkPolyData* cut, vtkIdType p) {
        const double* x = cut->GetPoint(p);
        return cut->GetPointData()->GetArray("pressure")->GetTuple1(p) -
               pressure_at(at_rest, {x[0], x[1], x[2]});
    });
    draw(frames, pressure_file, signed_scale(pressures.least, pressures.most),
         {"p [" + pressure_unit + "]", is_there(at_rest) ? "less that at rest" : ""}, 0);
}

}  // namespace kropla::pictures
