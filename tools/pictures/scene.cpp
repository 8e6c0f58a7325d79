#include "scene.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkColorTransferFunction.h>
#include <vtkCutter.h>
#include <vtkDataArray.h>
#include <vtkExtractCells.h>
#include <vtkFeatureEdges.h>
#include <vtkGeometryFilter.h>
#include <vtkIdList.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPoints.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace kropla::pictures {

namespace {

using Rgb = std::array<unsigned char, 3>;

constexpr Rgb surroundings_colour = {208, 230, 252}, prisms_colour = {124, 196, 164};
constexpr std::array<Rgb, 4> body_colours = {{{255, 150, 40}, {205, 75, 80}, {235, 190, 60}, {160, 90, 140}}};

constexpr std::array<std::uint32_t, 10> inferno = {0x000004, 0x1b0c41, 0x4a0c6b, 0x781c6d, 0xa52c60,
                                                   0xcf4446, 0xed6925, 0xfb9b06, 0xf7d13d, 0xfcffa4};
// Pale green where cells are good, dark red at the limit; even steps of lightness.
constexpr std::array<std::uint32_t, 7> quality = {0xeef6e4, 0xd3e8b4, 0xf7e08a, 0xf6b75c,
                                                  0xec8345, 0xcf4639, 0x8e1c2c};

std::array<double, 3> unpacked(std::uint32_t rgb) {
    return {((rgb >> 16) & 255) / 255.0, ((rgb >> 8) & 255) / 255.0, (rgb & 255) / 255.0};
}

double centroid_y(vtkUnstructuredGrid* grid, vtkIdType cell, vtkIdList* corners) {
    grid->GetCellPoints(cell, corners);
    double sum = 0;
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k) sum += grid->GetPoint(corners->GetId(k))[1];
    return sum / static_cast<double>(corners->GetNumberOfIds());
}

/// A region's tets in its colour; prisms around a body in one of their own, those inside it in a paler shade.
Rgb cell_colour(std::size_t region, bool prism) {
    if (region == 0) return prism ? prisms_colour : surroundings_colour;
    Rgb colour = body_colours[(region - 1) % body_colours.size()];
    for (unsigned char& part : colour)
        if (prism) part = static_cast<unsigned char>((part + 255) / 2);
    return colour;
}

vtkSmartPointer<vtkUnsignedCharArray> cell_colours(vtkCellData* cells) {
    vtkDataArray* region = cells->GetArray("region");
    vtkDataArray* layer = cells->GetArray("layer");
    auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colours->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < region->GetNumberOfTuples(); ++i) {
        const bool prism = layer->GetTuple1(i) > 0;
        colours->InsertNextTypedTuple(cell_colour(static_cast<std::size_t>(region->GetTuple1(i)), prism).data());
    }
    return colours;
}

vtkSmartPointer<vtkActor> flat_actor(vtkPolyDataMapper* mapper, double line_width) {
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty* property = actor->GetProperty();
    property->SetInterpolationToFlat();
    property->SetAmbient(0.45);
    property->SetDiffuse(0.62);
    property->SetSpecular(0);
    property->EdgeVisibilityOn();
    property->SetEdgeColor(0.17, 0.22, 0.30);
    property->SetLineWidth(static_cast<float>(line_width));
    return actor;
}

/// Colours that stand for numbers are not shaded.
void show_true_colours(vtkActor* actor) {
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetAmbient(0);
    actor->GetProperty()->SetDiffuse(1);
}

}  // namespace

vtkSmartPointer<vtkPolyData> opened(vtkUnstructuredGrid* grid, double y) {
    vtkNew<vtkIdList> kept, corners;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
        if (centroid_y(grid, cell, corners) > y) kept->InsertNextId(cell);
    }
    vtkNew<vtkExtractCells> half;
    half->SetInputData(grid);
    half->SetCellList(kept);
    vtkNew<vtkGeometryFilter> facets;
    facets->SetInputConnection(half->GetOutputPort());
    facets->Update();
    return facets->GetOutput();
}

vtkSmartPointer<vtkPolyData> section(vtkUnstructuredGrid* grid, double y) {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(0, y, 0);
    plane->SetNormal(0, 1, 0);
    vtkNew<vtkCutter> cutter;
    cutter->SetInputData(grid);
    cutter->SetCutFunction(plane);
    cutter->GenerateTrianglesOff();
    cutter->Update();
    return cutter->GetOutput();
}

vtkSmartPointer<vtkActor> coloured_by_region(vtkPolyData* facets, double line_width) {
    vtkNew<vtkPolyData> coloured;
    coloured->ShallowCopy(facets);
    coloured->GetCellData()->SetScalars(cell_colours(facets->GetCellData()));
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(coloured);
    mapper->SetScalarModeToUseCellData();
    mapper->SetColorModeToDirectScalars();
    return flat_actor(mapper, line_width);
}

vtkSmartPointer<vtkActor> coloured_by_field(vtkPolyData* facets, const char* name,
                                            vtkScalarsToColors* colours) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(facets);
    mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectColorArray(name);
    mapper->SetLookupTable(colours);
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
    const vtkSmartPointer<vtkActor> actor = flat_actor(mapper, 1.0);
    show_true_colours(actor);
    actor->GetProperty()->EdgeVisibilityOff();
    return actor;
}

vtkSmartPointer<vtkActor> coloured_by_quality(vtkPolyData* facets, vtkScalarsToColors* colours,
                                              double line_width) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(facets);
    mapper->SetScalarModeToUseCellFieldData();
    mapper->SelectColorArray("aspect_ratio");
    mapper->SetLookupTable(colours);
    mapper->UseLookupTableScalarRangeOn();
    const vtkSmartPointer<vtkActor> actor = flat_actor(mapper, line_width);
    show_true_colours(actor);
    return actor;
}

vtkSmartPointer<vtkActor> plain(vtkPolyData* facets, double red, double green, double blue) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(facets);
    mapper->ScalarVisibilityOff();
    const vtkSmartPointer<vtkActor> actor = flat_actor(mapper, 1.0);
    actor->GetProperty()->EdgeVisibilityOff();
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(red, green, blue);
    return actor;
}

vtkSmartPointer<vtkActor> drawn_arrows(std::span<const Arrow> arrows, const CutPlane& plane, double thickness,
                                       double in_front) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> shapes;
    const auto add = [&](const Arrow& arrow, std::initializer_list<Point2> corners) {
        shapes->InsertNextCell(static_cast<int>(corners.size()));
        for (const auto [forth, aside] : corners) {
            const double right = arrow.place.x + forth * arrow.direction.x - aside * arrow.direction.y,
                         up = arrow.place.y + forth * arrow.direction.y + aside * arrow.direction.x;
            const Vec3 p = plane.origin + right * plane.right + up * plane.up;
            shapes->InsertCellPoint(points->InsertNextPoint(p.x, p.y, p.z));
        }
    };
    for (const Arrow& arrow : arrows) {
        const double half = arrow.length / 2, head = std::min(5 * thickness, 0.6 * arrow.length),
                     neck = half - head;
        const double thin = std::min(thickness / 2, 0.15 * head), wide = 0.4 * head;
        add(arrow, {{-half, -thin}, {neck, -thin}, {neck, thin}, {-half, thin}});
        add(arrow, {{neck, -wide}, {half, 0}, {neck, wide}});
    }
    vtkNew<vtkPolyData> all;
    all->SetPoints(points);
    all->SetPolys(shapes);
    vtkSmartPointer<vtkActor> actor = plain(all, 0.05, 0.10, 0.20);
    actor->SetPosition(0, -in_front, 0);
    return actor;
}

vtkSmartPointer<vtkActor> outlines_of_bodies(vtkPolyData* facets, double line_width) {
    vtkDataArray* region = facets->GetCellData()->GetArray("region");
    vtkNew<vtkCellArray> of_bodies;
    vtkNew<vtkIdList> corners;
    for (vtkIdType i = 0; i < facets->GetNumberOfCells(); ++i) {
        if (region->GetTuple1(i) == 0) continue;
        facets->GetCellPoints(i, corners);
        of_bodies->InsertNextCell(corners);
    }
    vtkNew<vtkPolyData> bodies;
    bodies->SetPoints(facets->GetPoints());
    bodies->SetPolys(of_bodies);
    vtkNew<vtkFeatureEdges> rim;
    rim->SetInputData(bodies);
    rim->BoundaryEdgesOn();
    rim->FeatureEdgesOff();
    rim->NonManifoldEdgesOff();
    rim->ManifoldEdgesOff();
    rim->ColoringOff();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(rim->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->SetPosition(0, -0.05 * facets->GetLength(),
                       0);  // in front of the facets; the view knows no perspective
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(0.05, 0.10, 0.20);
    actor->GetProperty()->SetLineWidth(static_cast<float>(line_width));
    return actor;
}

vtkSmartPointer<vtkScalarsToColors> heat_colours(double least, double most) {
    auto colours = vtkSmartPointer<vtkColorTransferFunction>::New();
    for (std::size_t i = 0; i < inferno.size(); ++i) {
        const auto [r, g, b] = unpacked(inferno[i]);
        const double fraction = static_cast<double>(i) / (inferno.size() - 1);
        colours->AddRGBPoint(least + fraction * (most - least), r, g, b);
    }
    return colours;
}

vtkSmartPointer<vtkScalarsToColors> colours_of(const ColourScale& scale) {
    constexpr int steps = 64;
    auto colours = vtkSmartPointer<vtkColorTransferFunction>::New();
    for (int i = 0; i <= steps; ++i) {
        const double fraction = static_cast<double>(i) / steps;
        const auto rgb =
            static_cast<std::uint32_t>(std::stoul(scale.colour(fraction).substr(1), nullptr, 16));
        const auto [r, g, b] = unpacked(rgb);
        colours->AddRGBPoint(scale.least + fraction * (scale.most - scale.least), r, g, b);
    }
    return colours;
}

vtkSmartPointer<vtkScalarsToColors> quality_colours() {
    auto colours = vtkSmartPointer<vtkLookupTable>::New();
    colours->SetNumberOfTableValues(quality.size());
    colours->SetTableRange(3, 3 + static_cast<double>(quality.size()));
    for (std::size_t i = 0; i < quality.size(); ++i) {
        const auto [r, g, b] = unpacked(quality[i]);
        colours->SetTableValue(static_cast<vtkIdType>(i), r, g, b);
    }
    return colours;
}

}  // namespace kropla::pictures
