#pragma once

#include <vtkActor.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace kropla::pictures {

struct Colour {
    double red, green, blue;  // 0 ... 1
};

/// A rectangle of a sheet [pixels], from its upper left corner.
struct Place {
    double left, top, width, height;
};

/// A picture being laid out: views and words on white. Lengths in pixels of the finished picture, from its
/// upper left.
struct Sheet {
    int width, height;
    vtkSmartPointer<vtkRenderWindow> window;
    vtkSmartPointer<vtkRenderer> words;  // above all views, covers the sheet
};

/// A view of the world along +y: x to the right, z upwards, without perspective.
struct View {
    Place place;
    double x, y, z;  // [m] the point in the middle of the place
    double height;   // [m] that the place shows from bottom to top
};
[[nodiscard]] double metres_per_pixel(const View& view);

[[nodiscard]] Sheet make_sheet(int width, int height);

/// Draws the things as `view` sees them.
void add_view(Sheet& sheet, const View& view, std::initializer_list<vtkSmartPointer<vtkActor>> things);

struct TextStyle {
    int size = 22;       // [pixels]
    double align = 0.5;  // 0: begins at the place, 0.5: centred, 1: ends there
    bool bold = false;
    Colour colour = {0.13, 0.16, 0.20};
};
/// Writes one line, its middle at height `y`.
void add_text(Sheet& sheet, double x, double y, const std::string& text, const TextStyle& style = {});

/// A rectangle drawn by its outline.
void add_outline(Sheet& sheet, const Place& place, const Colour& colour, double thickness);
void add_filled(Sheet& sheet, const Place& place, const Colour& colour);

/// A place divided into bands of the same height, coloured from the top.
void add_bands(Sheet& sheet, const Place& place, const std::vector<Colour>& colours);

/// A bar of the given length [m] with its length written beside it, in the lower right corner of a view.
void add_scale_bar(Sheet& sheet, const View& view, double length);

/// Draws the sheet and writes it as PNG. Throws FileError if the file cannot be written.
void write_png(Sheet& sheet, const std::filesystem::path& file);

}  // namespace kropla::pictures
