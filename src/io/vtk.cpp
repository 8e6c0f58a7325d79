// VTK's XML files of unstructured grids, by VTK itself, from and into memory: the disk is io/file.h's
// business, so that its errors come with the system's reason.
//
// The reader trusts what it reads: sizes are looked at before (io/vtu_text.h), whatever it hands over is
// looked at before use, and what it says of its troubles is caught and becomes a FileError.

#include <kropla/io/vtk.h>

#include <kropla/base/error.h>
#include "base/tetrahedron.h"
#include "io/file.h"
#include "io/vtu_text.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

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
#include <optional>
#include <stdexcept>

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

/// VTK's wedge has its first triangle turned outwards, ours inwards: which of our corners each of VTK's is, and
/// the other way round. See the page of vtkWedge in VTK's documentation.
constexpr std::array<std::size_t, 6> wedge_corners = {0, 2, 1, 3, 5, 4};

/// Has one of VTK's algorithms ask the watch as often as it tells how far it is. It ends, not done, if the watch says
/// stop; the watch is to outlive it.
void let_stop(vtkAlgorithm* algorithm, const Watch* watch) {
    if (watch == nullptr) return;
    vtkNew<vtkCallbackCommand> ask;
    ask->SetClientData(const_cast<Watch*>(watch));
    ask->SetCallback([](vtkObject* working, unsigned long, void* asked, void*) {
        if (static_cast<const Watch*>(asked)->stop) static_cast<vtkAlgorithm*>(working)->SetAbortExecute(1);
    });
    algorithm->AddObserver(vtkCommand::ProgressEvent, ask);
}

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
    const std::vector<Prism> prisms = all_prisms(mesh);
    const std::size_t cells = mesh.tets.size() + prisms.size();
    const auto offsets = make_array<vtkTypeInt64Array>("offsets", cells + 1);
    const auto connectivity =
        make_array<vtkTypeInt64Array>("connectivity", 4 * mesh.tets.size() + 6 * prisms.size());
    const auto types = make_array<vtkUnsignedCharArray>("types", cells);
    vtkIdType cell = 0, next = 0;
    for (const auto& tet : mesh.tets) {
        types->SetValue(cell, VTK_TETRA);
        offsets->SetValue(cell++, next);
        for (const Vertex v : tet) connectivity->SetValue(next++, v.value);
    }
    for (const Prism& prism : prisms) {
        types->SetValue(cell, VTK_WEDGE);
        offsets->SetValue(cell++, next);
        const auto vertices = prism_vertices(mesh, prism);
        for (const std::size_t corner : wedge_corners) connectivity->SetValue(next++, vertices[corner].value);
    }
    offsets->SetValue(cell, next);
    vtkNew<vtkCellArray> array;
    array->SetData(offsets, connectivity);
    grid->SetCells(types, array);
}

double min_dihedral(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    const auto angles = tet_dihedral_angles(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]],
                                            mesh.position[v[3]]);
    return *std::min_element(angles.begin(), angles.end()) * (180 / std::numbers::pi);
}

/// As an aspect ratio: 3 is perfect, infinity turned over.
double aspect_ratio(const std::array<Vec3, 6>& corners) {
    const double jacobian = scaled_corner_jacobian(corners);
    return jacobian > 0 ? 3 / jacobian : std::numeric_limits<double>::infinity();
}

/// Between the facets at each corner, each the plane of two of the three edges there [deg].
double min_dihedral(const std::array<Vec3, 6>& x) {
    double largest_cosine = -1;
    for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t base = i < 3 ? 0 : 3, k = i % 3;
        const std::array<Vec3, 3> edges = {x[base + (k + 1) % 3] - x[i], x[base + (k + 2) % 3] - x[i],
                                           x[(i + 3) % 6] - x[i]};
        for (std::size_t e = 0; e < 3; ++e) {  // the facets on either side of this edge
            const Vec3 n = cross(edges[e], edges[(e + 1) % 3]), m = cross(edges[e], edges[(e + 2) % 3]);
            const double size = norm(n) * norm(m);
            largest_cosine = std::max(largest_cosine, size > 0 ? dot(n, m) / size : 1.0);
        }
    }
    return std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * (180 / std::numbers::pi);
}

/// What is said of one cell.
struct CellFigures {
    Region region;
    int layer;
    double aspect_ratio, min_dihedral;
};

std::vector<CellFigures> figures_of(const Mesh& mesh) {
    std::vector<CellFigures> figures;
    for (const Tet t : mesh.tets.indices())
        figures.push_back({mesh.region[t], 0, aspect_ratio(mesh, t), min_dihedral(mesh, t)});
    for (const Prism& prism : all_prisms(mesh)) {
        const auto corners = prism_corners(mesh, prism);
        figures.push_back({layer_of(mesh, prism.layer).region, prism.k + 1, aspect_ratio(corners),
                           min_dihedral(corners)});
    }
    return figures;
}

void add_cell_arrays(vtkUnstructuredGrid* grid, const Mesh& mesh) {
    const std::vector<CellFigures> figures = figures_of(mesh);
    const auto region = make_array<vtkTypeInt32Array>("region", figures.size());
    const auto aspect = make_array<vtkDoubleArray>("aspect_ratio", figures.size());
    const auto dihedral = make_array<vtkDoubleArray>("min_dihedral", figures.size());
    const auto layer = make_array<vtkTypeInt32Array>("layer", figures.size());
    dihedral->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), "deg");
    for (std::size_t i = 0; i < figures.size(); ++i) {
        const auto cell = static_cast<vtkIdType>(i);
        region->SetValue(cell, figures[i].region.value);
        aspect->SetValue(cell, figures[i].aspect_ratio);
        dihedral->SetValue(cell, figures[i].min_dihedral);
        layer->SetValue(cell, figures[i].layer);
    }
    grid->GetCellData()->AddArray(region);
    grid->GetCellData()->AddArray(aspect);
    grid->GetCellData()->AddArray(dihedral);
    grid->GetCellData()->AddArray(layer);
}

void put(vtkDoubleArray* array, vtkIdType place, double value) { array->SetValue(place, value); }
void put(vtkDoubleArray* array, vtkIdType place, const Vec3& value) { array->SetTuple3(place, value.x, value.y, value.z); }

template <class Field>
void add_field(vtkUnstructuredGrid* grid, const Field& field, const Array<Vertex, Vertex>& old_vertex) {
    const vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(std::is_same_v<Field, NodalVectorField> ? 3 : 1);
    array->SetNumberOfTuples(static_cast<vtkIdType>(old_vertex.size()));
    if (!field.unit.empty()) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit.c_str());
    for (const Vertex v : old_vertex.indices()) put(array, v.value, field.values[old_vertex[v]]);
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

std::string cell_name(vtkIdType cell) { return "cell " + std::to_string(cell); }

/// Of a surface, a line or a point, of straight or bent edges.
bool has_no_volume(int type) {
    return (type >= VTK_VERTEX && type <= VTK_QUAD) || (type >= VTK_QUADRATIC_EDGE && type <= VTK_QUADRATIC_QUAD);
}

/// Throws unless the cells that have volume are tets and prisms and their lists of vertices are in the file.
void check_cells(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    const vtkIdType count = grid.GetNumberOfCells();
    if (count <= 0) fail(path, "has no cells");
    if (count > std::numeric_limits<std::int32_t>::max()) fail(path, "has more cells than 2^31 - 1");
    vtkCellArray& cells = *grid.GetCells();
    if (grid.GetCellTypesArray()->GetNumberOfValues() != count || !cells.IsValid())
        fail(path, "is damaged: its lists of cells do not fit each other");
    for (vtkIdType cell = 0; cell < count; ++cell) {
        const int type = grid.GetCellType(cell);
        if (has_no_volume(type)) continue;
        if (type != VTK_TETRA && type != VTK_WEDGE)
            fail(path, cell_name(cell) + " is a " + vtkCellTypes::GetClassNameFromTypeId(type) +
                           " (VTK cell type " + std::to_string(type) + "), not a linear tet or prism");
        if (cells.GetCellSize(cell) != (type == VTK_TETRA ? 4 : 6))
            fail(path, cell_name(cell) + (type == VTK_TETRA ? " is a tet of " : " is a prism of ") +
                           std::to_string(cells.GetCellSize(cell)) + " vertices");
    }
}

template <std::size_t N>
std::array<Vertex, N> read_vertices(const std::filesystem::path& path, vtkUnstructuredGrid& grid, vtkIdType cell) {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid.GetCells()->GetCellAtId(cell, size, ids);
    std::array<Vertex, N> vertices;
    for (std::size_t i = 0; i < N; ++i) {
        if (ids[i] < 0 || ids[i] >= grid.GetNumberOfPoints())
            fail(path, cell_name(cell) + " has vertex " + std::to_string(ids[i]) + ", which is not among the " +
                           std::to_string(grid.GetNumberOfPoints()));
        vertices[i] = Vertex(static_cast<std::int32_t>(ids[i]));
    }
    return vertices;
}

/// A cell array of whole numbers 0, 1, ...; nothing if there is none.
std::optional<std::vector<std::int32_t>> read_numbers(const std::filesystem::path& path,
                                                      vtkUnstructuredGrid& grid, const std::string& name) {
    vtkDataArray* array = grid.GetCellData()->GetArray(name.c_str());
    if (array == nullptr) return {};
    if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != grid.GetNumberOfCells())
        fail(path, "the cell array " + name + " has not one value per cell");
    std::vector<std::int32_t> numbers;
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        const double value = array->GetComponent(cell, 0);
        if (!(value >= 0 && value < std::numeric_limits<std::int32_t>::max()) || value != std::floor(value))
            fail(path, cell_name(cell) + " has the " + name + " " + std::to_string(value) + ", not 0, 1, 2, ...");
        numbers.push_back(static_cast<std::int32_t>(value));
    }
    return numbers;
}

LoosePrism read_prism(const std::filesystem::path& path, vtkUnstructuredGrid& grid, vtkIdType cell, Region region,
                      const std::optional<std::vector<std::int32_t>>& layers) {
    if (!layers)
        fail(path, cell_name(cell) + " is a prism, but there is no cell array layer to say of which layer");
    const int layer = (*layers)[static_cast<std::size_t>(cell)];
    if (layer < 1) fail(path, cell_name(cell) + " is a prism of layer 0, not 1, 2, ... from the wall");
    const auto vertices = read_vertices<6>(path, grid, cell);
    LoosePrism prism{.cell = static_cast<int>(cell), .vertices = {}, .region = region, .layer = layer};
    for (std::size_t i = 0; i < 6; ++i) prism.vertices[wedge_corners[i]] = vertices[i];
    return prism;
}

void read_cells(const std::filesystem::path& path, vtkUnstructuredGrid& grid, FileCells& cells) {
    check_cells(path, grid);
    const auto regions = read_numbers(path, grid, "region");
    std::optional<std::vector<std::int32_t>> layers;  // "layer" may mean something else where there are no prisms
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        const Region region = regions ? Region((*regions)[static_cast<std::size_t>(cell)]) : surroundings;
        if (grid.GetCellType(cell) == VTK_TETRA) {
            cells.tets.push_back(read_vertices<4>(path, grid, cell));
            cells.region.push_back(region);
        } else if (has_no_volume(grid.GetCellType(cell))) {
            ++cells.passed_over;
        } else {
            if (!layers) layers = read_numbers(path, grid, "layer");
            cells.prisms.push_back(read_prism(path, grid, cell, region, layers));
        }
    }
    if (cells.tets.empty()) fail(path, "has no tets");
}

void take(vtkDataArray* array, Vertex v, double& value) { value = array->GetComponent(v.value, 0); }
void take(vtkDataArray* array, Vertex v, Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) value[axis] = array->GetComponent(v.value, axis);
}

/// The point arrays of one component, or of three.
template <class Field>
std::vector<Field> read_fields(const std::filesystem::path& path, vtkUnstructuredGrid& grid) {
    constexpr int components = std::is_same_v<Field, NodalVectorField> ? 3 : 1;
    std::vector<Field> fields;
    for (int i = 0; i < grid.GetPointData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = grid.GetPointData()->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != components)
            continue;
        if (array->GetNumberOfTuples() != grid.GetNumberOfPoints())
            fail(path, std::string("the point array ") + array->GetName() + " has not one value per vertex");
        Field& field = fields.emplace_back();
        field.name = array->GetName();
        if (array->HasInformation() && array->GetInformation()->Has(vtkDataArray::UNITS_LABEL()))
            field.unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL());
        field.values.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
        for (const Vertex v : field.values.indices()) take(array, v, field.values[v]);
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

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, std::span<const NodalField> fields,
               const Watch* watch, std::span<const NodalVectorField> vectors) {
    heed(watch);
    const Compacted compacted = compact(mesh);
    heed(watch);
    vtkNew<vtkUnstructuredGrid> grid;
    add_cells(grid, compacted.mesh);
    heed(watch);
    add_cell_arrays(grid, compacted.mesh);
    heed(watch);
    for (const NodalField& field : fields) add_field(grid, field, compacted.old_vertex);
    for (const NodalVectorField& field : vectors) add_field(grid, field, compacted.old_vertex);

    const CaughtErrors errors;
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(1);  // the fastest: half the time of zlib's default, a tenth more bytes
    writer->WriteToOutputStringOn();
    let_stop(writer, watch);
    const int written = writer->Write();
    heed(watch);
    if (written == 0 || !errors.first().empty()) fail(path, "cannot be written: " + errors.first());
    write_file(path, writer->GetOutputString(), watch);
}

namespace {

FileCells read_heeding(const std::filesystem::path& path, const Watch* watch) {
    const std::string bytes = read_file(path);
    check_vtu_text(path, bytes);
    heed(watch);
    const auto grid = parse(path, bytes);
    heed(watch);
    FileCells cells;
    cells.position = read_positions(path, *grid);
    read_cells(path, *grid, cells);
    cells.fields = read_fields<NodalField>(path, *grid);
    cells.vectors = read_fields<NodalVectorField>(path, *grid);
    heed(watch);
    return cells;
}

}  // namespace

FileCells read_vtu_cells(const std::filesystem::path& path) { return read_heeding(path, nullptr); }

Frame make_frame(FileCells cells) {
    const auto mesh = [&] {
        try {
            return make_mesh(std::move(cells.position), std::move(cells.tets), std::move(cells.region));
        } catch (const std::invalid_argument& error) {  // the arrays are a file's
            throw FileError(error.what());
        }
    };
    Frame frame = {mesh(), std::move(cells.fields), std::move(cells.vectors)};
    const BoundingBox box = bounding_box(frame.mesh);
    for (const Tet t : frame.mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            if (frame.mesh.neighbour[t][i].exists()) continue;
            frame.mesh.patch[t][i] = patch_of(frame.mesh, {t, corner}, box);
        }
    if (!cells.prisms.empty()) attach_layers(frame.mesh, cells.prisms);
    return frame;
}

Frame read_vtu(const std::filesystem::path& path, const Watch* watch) {
    FileCells cells = read_heeding(path, watch);
    try {
        return make_frame(std::move(cells));
    } catch (const FileError& error) {
        fail(path, error.what());
    }
}

}  // namespace kropla
