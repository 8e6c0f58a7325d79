#include "frames.h"

#include <kropla/base/error.h>

#include <vtkBoundingBox.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>

namespace kropla::pictures {

namespace {

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file)) throw FileError(file.string() + ": no such file");
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    if (!reader->CanReadFile(file.c_str())) throw FileError(file.string() + ": not a VTU file");
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkUnstructuredGrid* grid = reader->GetOutput();
    if (reader->GetErrorCode() != 0 || grid->GetNumberOfCells() == 0)
        throw FileError(file.string() + ": damaged");
    for (const char* name : {"region", "layer", "aspect_ratio"}) {
        if (grid->GetCellData()->GetArray(name) == nullptr) {
            throw FileError(file.string() + ": has no cell array " + name);
        }
    }
    return grid;
}

/// The bounding box of the cells of region 1; not valid if there is none.
vtkBoundingBox bounds_of_first_body(vtkUnstructuredGrid* grid) {
    vtkBoundingBox bounds;
    vtkDataArray* region = grid->GetCellData()->GetArray("region");
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
        if (region->GetTuple1(cell) != 1) continue;
        std::array<double, 6> b;
        grid->GetCellBounds(cell, b.data());
        bounds.AddBounds(b.data());
    }
    return bounds;
}

}  // namespace

std::vector<SeriesEntry> frames_of_run(const std::filesystem::path& dir) {
    std::vector<SeriesEntry> entries = read_pvd(dir / "frames.pvd");
    if (entries.empty()) throw FileError((dir / "frames.pvd").string() + ": names no frame");
    std::ranges::sort(entries, {}, &SeriesEntry::time);
    return entries;
}

RunFrame read_run_frame(const std::filesystem::path& dir, const SeriesEntry& entry) {
    RunFrame frame{.time = entry.time,
                   .grid = read_grid(dir / entry.file),
                   .min = {},
                   .max = {},
                   .centre = {},
                   .radius = 0};
    const double* b = frame.grid->GetBounds();
    frame.min = {b[0], b[2], b[4]};
    frame.max = {b[1], b[3], b[5]};
    frame.centre = 0.5 * (frame.min + frame.max);
    frame.radius = 0.125 * (frame.max.x - frame.min.x);
    if (const vtkBoundingBox body = bounds_of_first_body(frame.grid); body.IsValid()) {
        std::array<double, 3> centre;
        body.GetCenter(centre.data());
        frame.centre = {centre[0], centre[1], centre[2]};
        frame.radius = 0.5 * body.GetMaxLength();
    }
    return frame;
}

bool has_field(const RunFrame& frame, const char* name) {
    return frame.grid->GetPointData()->GetArray(name) != nullptr;
}

std::vector<SeriesEntry> evenly(const std::vector<SeriesEntry>& entries, std::size_t count) {
    if (entries.size() <= count) return entries;
    std::vector<SeriesEntry> chosen;
    for (std::size_t i = 0; i < count; ++i) {
        chosen.push_back(entries[(i * (entries.size() - 1) + (count - 1) / 2) / (count - 1)]);
    }
    return chosen;
}

}  // namespace kropla::pictures
