#include "sheet.h"

#include <kropla/base/error.h>
#include "report/units.h"

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkImageShiftScale.h>
#include <vtkImageShrink3D.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kropla::pictures {

namespace {

// Everything is drawn this many times larger and averaged: crisp thin lines without the jaggies of one sample
// a pixel.
constexpr int oversampling = 2;

void add_lights(vtkRenderer* renderer) {
    renderer->AutomaticLightCreationOff();
    renderer->RemoveAllLights();
    const std::array<std::array<double, 4>, 2> lights = {{{-0.6, 0.9, 1.0, 0.75}, {0.8, -0.2, 0.8, 0.35}}};
    for (const auto& [x, y, z, intensity] : lights) {
        vtkNew<vtkLight> light;
        light->SetLightTypeToCameraLight();
        light->SetPosition(x, y, z);
        light->SetFocalPoint(0, 0, 0);
        light->SetIntensity(intensity);
        renderer->AddLight(light);
    }
}

/// Rectangles of one colour each, as one thing.
void add_rectangles(Sheet& sheet, const std::vector<std::pair<Place, Colour>>& rectangles) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> quads;
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    for (const auto& [p, colour] : rectangles) {
        const double right = p.left + p.width, bottom = p.top + p.height;
        const std::array<std::array<double, 2>, 4> corners = {
            {{p.left, bottom}, {right, bottom}, {right, p.top}, {p.left, p.top}}};
        quads->InsertNextCell(4);
        for (const auto& [x, y] : corners) {
            quads->InsertCellPoint(
                points->InsertNextPoint(x * oversampling, (sheet.height - y) * oversampling, 0));
        }
        colours->InsertNextTuple3(255 * colour.red, 255 * colour.green, 255 * colour.blue);
    }
    vtkNew<vtkPolyData> shape;
    shape->SetPoints(points);
    shape->SetPolys(quads);
    shape->GetCellData()->SetScalars(colours);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(shape);
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    sheet.words->AddActor2D(actor);
}

}  // namespace

double metres_per_pixel(const View& view) { return view.height / view.place.height; }

Sheet make_sheet(int width, int height) {
    Sheet sheet{width, height, vtkSmartPointer<vtkRenderWindow>::New(), vtkSmartPointer<vtkRenderer>::New()};
    sheet.window->SetOffScreenRendering(1);
    sheet.window->SetMultiSamples(0);  // oversampling does the same, for lines and words too
    sheet.window->SetSize(width * oversampling, height * oversampling);
    sheet.window->SetNumberOfLayers(2);
    vtkNew<vtkRenderer> paper;
    paper->SetBackground(1, 1, 1);
    sheet.window->AddRenderer(paper);
    sheet.words->SetLayer(1);
    sheet.window->AddRenderer(sheet.words);
    return sheet;
}

void add_view(Sheet& sheet, const View& view, std::initializer_list<vtkSmartPointer<vtkActor>> things) {
    const Place& p = view.place;
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1, 1, 1);
    renderer->SetViewport(p.left / sheet.width, 1 - (p.top + p.height) / sheet.height,
                          (p.left + p.width) / sheet.width, 1 - p.top / sheet.height);
    for (const auto& thing : things) renderer->AddActor(thing);
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetFocalPoint(view.x, view.y, view.z);
    // From nearby: drawing is in single precision, relative to the camera.
    camera->SetPosition(view.x, view.y - 2 * view.height, view.z);
    camera->SetViewUp(0, 0, 1);
    camera->SetParallelScale(view.height / 2);
    add_lights(renderer);
    renderer->ResetCameraClippingRange();
    sheet.window->AddRenderer(renderer);
}

void add_text(Sheet& sheet, double x, double y, const std::string& text, const TextStyle& style) {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    vtkTextProperty* property = actor->GetTextProperty();
    property->SetFontFamilyToArial();
    property->SetFontSize(style.size * oversampling);
    property->SetBold(style.bold);
    property->SetColor(style.colour.red, style.colour.green, style.colour.blue);
    property->SetVerticalJustificationToCentered();
    if (style.align == 0) property->SetJustificationToLeft();
    else if (style.align == 1) property->SetJustificationToRight();
    else property->SetJustificationToCentered();
    actor->GetPositionCoordinate()->SetCoordinateSystemToViewport();
    actor->SetPosition(x * oversampling, (sheet.height - y) * oversampling);
    sheet.words->AddActor2D(actor);
}

void add_filled(Sheet& sheet, const Place& place, const Colour& colour) {
    add_rectangles(sheet, {{place, colour}});
}

void add_bands(Sheet& sheet, const Place& p, const std::vector<Colour>& colours) {
    std::vector<std::pair<Place, Colour>> bands;
    const double height = p.height / static_cast<double>(colours.size());
    for (const Colour& colour : colours) {
        const double top = p.top + height * static_cast<double>(bands.size());
        bands.push_back({{p.left, top, p.width, height}, colour});
    }
    add_rectangles(sheet, bands);
}

void add_outline(Sheet& sheet, const Place& p, const Colour& colour, double thickness) {
    add_filled(sheet, {p.left, p.top, p.width, thickness}, colour);
    add_filled(sheet, {p.left, p.top + p.height - thickness, p.width, thickness}, colour);
    add_filled(sheet, {p.left, p.top, thickness, p.height}, colour);
    add_filled(sheet, {p.left + p.width - thickness, p.top, thickness, p.height}, colour);
}

void add_scale_bar(Sheet& sheet, const View& view, double length) {
    const Place& p = view.place;
    const double bar = length / metres_per_pixel(view);
    const double margin = 12, height = 34, width = std::max(bar, 56.0) + 20;
    const Place plate = {p.left + p.width - width - margin, p.top + p.height - height - margin, width,
                         height};
    add_filled(sheet, plate, {1, 1, 1});
    const double middle = plate.left + width / 2;
    add_filled(sheet, {middle - bar / 2, plate.top + height - 9, bar, 3}, {0.1, 0.1, 0.1});
    add_text(sheet, middle, plate.top + 13, with_unit(length, "m"), {.size = 17});
}

/// Maps the levels 0 ... `from` of each colour onto 0 ... `to`, rounded.
vtkNew<vtkImageShiftScale> with_levels(vtkImageAlgorithm* picture, double from, double to) {
    vtkNew<vtkImageShiftScale> levels;
    levels->SetInputConnection(picture->GetOutputPort());
    levels->SetShift(0.5 * from / to);
    levels->SetScale(to / from);
    levels->ClampOverflowOn();
    levels->SetOutputScalarTypeToUnsignedChar();
    return levels;
}

void write_png(Sheet& sheet, const std::filesystem::path& file) {
    sheet.window->Render();
    vtkNew<vtkWindowToImageFilter> picture;
    picture->SetInput(sheet.window);
    picture->SetInputBufferTypeToRGB();
    picture->ReadFrontBufferOff();
    vtkNew<vtkImageShrink3D> smaller;
    smaller->SetInputConnection(picture->GetOutputPort());
    smaller->SetShrinkFactors(oversampling, oversampling, 1);
    smaller->MeanOn();
    const auto fewer_levels = with_levels(smaller, 255, 63);  // not seen, and a smaller file
    const auto full_range = with_levels(fewer_levels, 63, 255);
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(full_range->GetOutputPort());
    writer->SetCompressionLevel(9);
    writer->SetFileName(file.c_str());
    writer->Write();
    if (writer->GetErrorCode() != 0) throw FileError(file.string() + ": cannot be written");
}

}  // namespace kropla::pictures
