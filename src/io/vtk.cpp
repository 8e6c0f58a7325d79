// VTK's XML files of unstructured grids, by VTK itself, from and into memory: the disk is io/file.h's
// business, so that its errors come with the system's reason.
//
// The reader trusts what it reads: sizes are looked at before (io/vtu_text.h), whatever it hands over is
// looked at before use, and what it says of its troubles is caught and becomes a FileError.

#include "io/vtk.h"

#include "base/error.h"
#include "base/tetrahedron.h"
#include "io/file.h"
#include "io/vtu_text.h"
#include "mesh/quality.h"
#include "mesh/topology.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>

namespace kropla {
namespace {

/// While it lives, VTK's messages are not shown; the first error is kept.
class CaughtErrors {
public:
    CaughtErrors() : before_(vtkOutputWindow::GetInstance()) {
        keep_first_->SetClientData(&first_);
        keep_first_->SetCallback([](vtkObject*, unsigned long, void* first, void* text) {
            auto& kept = *static_cast<std::string*>(first);
            if (kept.empty()) kept = static_cast<const char*>(text);
        });
        window_->AddObserver(vtkCommand::ErrorEvent, keep_first_);
        vtkOutputWindow::SetInstance(window_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    }
    ~CaughtErrors() {
        vtkOutputWindow::SetInstance(before_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);  // VTK's default; it cannot be asked
    }
    CaughtErrors(const CaughtErrors&) = delete;
    CaughtErrors& operator=(const CaughtErrors&) = delete;

    /// The first error in one line, without the place in VTK's code that found it; empty: none.
    [[nodiscard]] std::string first() const {
        const std::size_t who = first_.find("): ");
        std::string text = who == std::string::npos ? first_ : first_.substr(who + 3);
        return text.substr(0, text.find('\n'));
    }

private:
    vtkSmartPointer<vtkOutputWindow> before_;
    vtkNew<vtkStringOutputWindow> window_;
    vtkNew<vtkCallbackCommand> keep_first_;
    std::string first_;
};

// ---- writing

template <class VtkArray>
vtkSmartPointer<VtkArray> make_array(const char* name, std::size_t size) {
    auto array = vtkSmartPointer<VtkArray>::New();
    array->SetName(name);
    array->SetNumberOfValues(static_cast<vtkIdType>(size));
    return array;
}

void add_cells(vtkUnstructuredGrid* grid, const Mesh& mesh) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.position.size()));
    for (const Vertex v : mesh.position.indices()) {
        const Vec3& p = mesh.position[v];
        points->SetPoint(v.value, p.x, p.y, p.z);
    }
    grid->SetPoints(points);

    // 64 bits for the offsets' sake: four per cell pass 2^31 before the cells do.
    const auto offsets = make_array<vtkTypeInt64Array>("offsets", mesh.tets.size() + 1);
    const auto connectivity = make_array<vtkTypeInt64Array>("connectivity", 4 * mesh.tets.size());
    vtkIdType next = 0;
    for (const auto& tet : mesh.tets) {
        offsets->SetValue(next / 4, next);
        for (const Vertex v : tet) connectivity->SetValue(next++, v.value);
    }
    offsets->SetValue(next / 4, next);
    vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, connectivity);
    grid->SetCells(VTK_TETRA, cells);
}

double min_dihedral(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    const auto angles = tet_dihedral_angles(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]],
                                            mesh.position[v[3]]);
    return *std::min_element(angles.begin(), angles.end()) * (180 / std::numbers::pi);
}

void add_cell_arrays(vtkUnstructuredGrid* grid, const Mesh& mesh) {
    const auto region = make_array<vtkTypeInt32Array>("region", mesh.tets.size());
    const auto aspect = make_array<vtkDoubleArray>("aspect_ratio", mesh.tets.size());
    const auto dihedral = make_array<vtkDoubleArray>("min_dihedral", mesh.tets.size());
    const auto layer = make_array<vtkTypeInt32Array>("layer", mesh.tets.size());
    dihedral->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), "deg");
    for (const Tet t : mesh.tets.indices()) {
        region->SetValue(t.value, mesh.region[t].value);
        aspect->SetValue(t.value, aspect_ratio(mesh, t));
        dihedral->SetValue(t.value, min_dihedral(mesh, t));
        layer->SetValue(t.value, 0);
    }
    grid->GetCellData()->AddArray(region);
    grid->GetCellData()->AddArray(aspect);
    grid->GetCellData()->AddArray(dihedral);
    grid->GetCellData()->AddArray(layer);
}

void add_field(vtkUnstructuredGrid* grid, const NodalField& field, const Array<Vertex, Vertex>& old_vertex) {
    const auto array = make_array<vtkDoubleArray>(field.name.c_str(), old_vertex.size());
    if (!field.unit.empty()) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit.c_str());
    for (const Vertex v : old_vertex.indices()) array->SetValue(v.value, field.values[old_vertex[v]]);
    grid->GetPointData()->AddArray(array);
}

// ---- reading

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
    throw FileError(path.string() + ": " + what);
}

vtkSmartPointer<vtkUnstructuredGrid> parse(const std::filesystem::path& path, const std::string& bytes) {
    const CaughtErrors errors;
    try {
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->ReadFromInputStringOn();
        reader->SetInputString(bytes);
        reader->Update();
        if (!errors.first().empty()) fail(path, "is damaged: " + errors.first());
        if (reader->GetErrorCode() != 0) fail(path, "is damaged: VTK cannot read it");
        return reader->GetOutput();
    } catch (const std::bad_alloc&) {
        fail(path, "asks for more memory than there is: damaged, or too large");
    } catch (const std::length_error&) {
        fail(path, "asks for more memory than there can be: damaged");
    }
}

Array<Vertex, Vec3> read_positions(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    const vtkIdType count = grid.GetNumberOfPoints();
    if (count > std::numeric_limits<std::int32_t>::max()) fail(path, "has more vertices than 2^31 - 1");
    Array<Vertex, Vec3> position(static_cast<std::size_t>(count));
    for (const Vertex v : position.indices()) {
        std::array<double, 3> p = {};
        grid.GetPoint(v.value, p.data());
        position[v] = {p[0], p[1], p[2]};
        constexpr double largest = 1e30;  // [m] what the exact predicates are good for
        for (const double x : p)
            if (!(std::abs(x) <= largest))
                fail(path,
                     "vertex " + std::to_string(v.value) + " has a coordinate that is not a finite number");
    }
    return position;
}

/// Throws unless the cells are tets and their lists of vertices are in the file.
void check_cells(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    const vtkIdType count = grid.GetNumberOfCells();
    if (count <= 0) fail(path, "has no cells");
    if (count > std::numeric_limits<std::int32_t>::max()) fail(path, "has more cells than 2^31 - 1");
    vtkCellArray& cells = *grid.GetCells();
    if (grid.GetCellTypesArray()->GetNumberOfValues() != count || !cells.IsValid())
        fail(path, "is damaged: its lists of cells do not fit each other");
    for (vtkIdType cell = 0; cell < count; ++cell) {
        const int type = grid.GetCellType(cell);
        if (type != VTK_TETRA)
            fail(path, "cell " + std::to_string(cell) + " is a " +
                           vtkCellTypes::GetClassNameFromTypeId(type) + " (VTK cell type " +
                           std::to_string(type) + "), not a linear tet");
        if (cells.GetCellSize(cell) != 4)
            fail(path, "cell " + std::to_string(cell) + " is a tet of " +
                           std::to_string(cells.GetCellSize(cell)) + " vertices");
    }
}

Array<Tet, std::array<Vertex, 4>> read_tets(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    check_cells(path, grid);
    Array<Tet, std::array<Vertex, 4>> tets(static_cast<std::size_t>(grid.GetNumberOfCells()));
    for (const Tet t : tets.indices()) {
        vtkIdType size = 0;
        const vtkIdType* vertices = nullptr;
        grid.GetCells()->GetCellAtId(t.value, size, vertices);
        for (std::size_t i = 0; i < 4; ++i) {
            if (vertices[i] < 0 || vertices[i] >= grid.GetNumberOfPoints())
                fail(path, "cell " + std::to_string(t.value) + " has vertex " + std::to_string(vertices[i]) +
                               ", which is not among the " + std::to_string(grid.GetNumberOfPoints()));
            tets[t][i] = Vertex(static_cast<std::int32_t>(vertices[i]));
        }
    }
    return tets;
}

Array<Tet, Region> read_regions(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    Array<Tet, Region> region(static_cast<std::size_t>(grid.GetNumberOfCells()), surroundings);
    vtkDataArray* array = grid.GetCellData()->GetArray("region");
    if (array == nullptr) return region;
    if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != grid.GetNumberOfCells())
        fail(path, "the cell array region has not one value per cell");
    for (const Tet t : region.indices()) {
        const double value = array->GetComponent(t.value, 0);
        if (!(value >= 0 && value < std::numeric_limits<std::int32_t>::max()) || value != std::floor(value))
            fail(path, "cell " + std::to_string(t.value) + " has the region " + std::to_string(value) +
                           ", not 0, 1, 2, ...");
        region[t] = Region(static_cast<std::int32_t>(value));
    }
    return region;
}

std::vector<NodalField> read_fields(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    std::vector<NodalField> fields;
    for (int i = 0; i < grid.GetPointData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = grid.GetPointData()->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) continue;
        if (array->GetNumberOfTuples() != grid.GetNumberOfPoints())
            fail(path, std::string("the point array ") + array->GetName() + " has not one value per vertex");
        NodalField& field = fields.emplace_back();
        field.name = array->GetName();
        if (array->HasInformation() && array->GetInformation()->Has(vtkDataArray::UNITS_LABEL()))
            field.unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL());
        field.values.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
        for (const Vertex v : field.values.indices()) field.values[v] = array->GetComponent(v.value, 0);
    }
    return fields;
}

// ---- patches

struct BoundingBox {
    Vec3 min, max;
};

BoundingBox bounding_box(const Mesh& mesh) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BoundingBox box = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Vertex v : mesh.position.indices()) {
        if (!alive(mesh, v)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], mesh.position[v][axis]);
            box.max[axis] = std::max(box.max[axis], mesh.position[v][axis]);
        }
    }
    return box;
}

/// 0 ... 5: x min, x max, y min, y max, z min, z max; 0 also where the facet lies in none.
Patch patch_of(const Mesh& mesh, Facet facet, const BoundingBox& box) {
    const auto vertices = facet_vertices(mesh, facet);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const double plane = (side == 0 ? box.min : box.max)[axis];
            if (std::ranges::all_of(vertices, [&](Vertex v) { return mesh.position[v][axis] == plane; }))
                return Patch(2 * axis + side);
        }
    return Patch(0);
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, std::span<const NodalField> fields) {
    const Compacted compacted = compact(mesh);
    vtkNew<vtkUnstructuredGrid> grid;
    add_cells(grid, compacted.mesh);
    add_cell_arrays(grid, compacted.mesh);
    for (const NodalField& field : fields) add_field(grid, field, compacted.old_vertex);

    const CaughtErrors errors;
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(1);  // the fastest: half the time of zlib's default, a tenth more bytes
    writer->WriteToOutputStringOn();
    if (writer->Write() == 0 || !errors.first().empty()) fail(path, "cannot be written: " + errors.first());
    write_file(path, writer->GetOutputString());
}

Cells read_vtu_cells(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    check_vtu_text(path, bytes);
    const auto grid = parse(path, bytes);
    Cells cells;
    cells.position = read_positions(path, *grid);
    cells.tets = read_tets(path, *grid);
    cells.region = read_regions(path, *grid);
    cells.fields = read_fields(path, *grid);
    return cells;
}

Frame make_frame(Cells cells) {
    Frame frame = {make_mesh(std::move(cells.position), std::move(cells.tets), std::move(cells.region)),
                   std::move(cells.fields)};
    const BoundingBox box = bounding_box(frame.mesh);
    for (const Tet t : frame.mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            if (frame.mesh.neighbour[t][i].exists()) continue;
            frame.mesh.patch[t][i] = patch_of(frame.mesh, {t, corner}, box);
        }
    return frame;
}

Frame read_vtu(const std::filesystem::path& path) {
    Cells cells = read_vtu_cells(path);
    try {
        return make_frame(std::move(cells));
    } catch (const FileError& error) {
        fail(path, error.what());
    }
}

}  // namespace kropla
