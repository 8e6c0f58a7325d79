// VTK's XML files of unstructured grids, by VTK itself from memory: the disk is io/file.h's business, so that its
// errors come with the system's reason.
//
// The reader trusts what it reads: sizes are looked at before (io/vtu_text.h), whatever it hands over is
// looked at before use, and what it says of its troubles is caught and becomes a FileError.

#include <kropla/io/vtk.h>

#include "io/file.h"
#include "io/vtk_inside.h"
#include "io/vtu_text.h"
#include <kropla/mesh/topology.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>

namespace kropla {
namespace {

vtkSmartPointer<vtkUnstructuredGrid> parse(const std::filesystem::path& path, const std::string& bytes, const VtuText& text) {
    const CaughtErrors errors;
    try {
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->ReadFromInputStringOn();
        reader->SetInputString(bytes);
        for (const std::string& name : text.of_points) reader->GetPointDataArraySelection()->DisableArray(name.c_str());
        for (const std::string& name : text.of_cells) reader->GetCellDataArraySelection()->DisableArray(name.c_str());
        reader->Update();
        if (!errors.first().empty()) fail(path, "is damaged: " + errors.first());
        const bool lost = text.cells > 0 && reader->GetOutput()->GetNumberOfCells() == 0;
        if (reader->GetErrorCode() != 0 || lost) fail(path, "is damaged: VTK cannot read it");
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

bool has_volume(int type) { return !has_no_volume(type); }
bool is_facet(int type) { return type == VTK_TRIANGLE || type == VTK_QUAD; }

/// A cell array of whole numbers 0, 1, ... where the cell's type is of those asked for, else 0; nothing if there is none.
std::optional<std::vector<std::int32_t>> read_numbers(const std::filesystem::path& path,
                                                      vtkUnstructuredGrid& grid, const std::string& name,
                                                      bool (*asked_for)(int type)) {
    vtkDataArray* array = grid.GetCellData()->GetArray(name.c_str());
    if (array == nullptr) return {};
    if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != grid.GetNumberOfCells())
        fail(path, "the cell array " + name + " has not one value per cell");
    std::vector<std::int32_t> numbers;
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        const double value = asked_for(grid.GetCellType(cell)) ? array->GetComponent(cell, 0) : 0;
        if (!(value >= 0 && value < std::numeric_limits<std::int32_t>::max()) || value != std::floor(value))
            fail(path, cell_name(cell) + " has the " + name + " " + std::to_string(value) + ", not 0, 1, 2, ...");
        numbers.push_back(static_cast<std::int32_t>(value));
    }
    return numbers;
}

LoosePrism read_prism(const std::filesystem::path& path, vtkUnstructuredGrid& grid, vtkIdType cell, Region region,
                      const std::optional<std::vector<std::int32_t>>& layers) {
    const auto vertices = read_vertices<6>(path, grid, cell);
    LoosePrism prism{.cell = static_cast<int>(cell), .vertices = {}, .region = region, .layer = 0};
    if (layers) prism.layer = (*layers)[static_cast<std::size_t>(cell)];
    for (std::size_t i = 0; i < 6; ++i) prism.vertices[wedge_corners[i]] = vertices[i];
    return prism;
}

/// Whether the cell is a facet whose patch is told.
bool read_facet(const std::filesystem::path& path, vtkUnstructuredGrid& grid, vtkIdType cell,
                const std::optional<std::vector<std::int32_t>>& patches, FileCells& cells) {
    const int type = grid.GetCellType(cell);
    if (!patches || !is_facet(type)) return false;
    PatchFacet facet{.vertices = {}, .patch = (*patches)[static_cast<std::size_t>(cell)]};
    if (type == VTK_QUAD) facet.vertices = read_vertices<4>(path, grid, cell);
    else std::ranges::copy(read_vertices<3>(path, grid, cell), facet.vertices.begin());
    cells.facets.push_back(facet);
    return true;
}

/// From an array of texts, "3 rotor", of the whole file: of their bytes, each text with a zero at its end.
Names read_names(vtkUnstructuredGrid& grid, const char* array_name) {
    Names names;
    std::string texts;
    auto* const bytes = vtkUnsignedCharArray::SafeDownCast(grid.GetFieldData()->GetAbstractArray(array_name));
    for (vtkIdType i = 0; bytes != nullptr && i < bytes->GetNumberOfValues(); ++i)
        texts += static_cast<char>(bytes->GetValue(i));
    for (std::size_t at = 0, end = texts.find('\0'); end != std::string::npos; at = end + 1, end = texts.find('\0', at)) {
        const std::string text = texts.substr(at, end - at);
        int number = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error == std::errc() && rest != text.data() + text.size() && *rest == ' ') names[number] = rest + 1;
    }
    return names;
}

void read_cells(const std::filesystem::path& path, vtkUnstructuredGrid& grid, FileCells& cells) {
    check_cells(path, grid);
    const auto regions = read_numbers(path, grid, "region", has_volume);
    const auto patches = read_numbers(path, grid, patch_array, is_facet);
    std::optional<std::vector<std::int32_t>> layers;  // "layer" may mean something else where there are no prisms
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        const Region region = regions ? Region((*regions)[static_cast<std::size_t>(cell)]) : surroundings;
        if (grid.GetCellType(cell) == VTK_TETRA) {
            cells.tets.push_back(read_vertices<4>(path, grid, cell));
            cells.region.push_back(region);
        } else if (has_no_volume(grid.GetCellType(cell))) {
            if (!read_facet(path, grid, cell, patches, cells)) ++cells.passed_over;
        } else {
            if (!layers) layers = read_numbers(path, grid, "layer", has_volume);
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

FileCells read_vtu_cells(const std::filesystem::path& path, const Watch* watch) {
    std::string bytes = read_file(path);
    const VtuText text = check_vtu_text(path, bytes);
    heed(watch);
    const auto grid = parse(path, bytes, text);
    heed(watch);
    FileCells cells;
    cells.position = read_positions(path, *grid);
    read_cells(path, *grid, cells);
    cells.region_names = read_names(*grid, region_names_array);
    cells.patch_names = read_names(*grid, patch_names_array);
    cells.fields = read_fields<NodalField>(path, *grid);
    cells.vectors = read_fields<NodalVectorField>(path, *grid);
    heed(watch);
    return cells;
}

Frame make_frame(FileCells cells) {
    number_layers(cells);
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
    FileCells cells = read_vtu_cells(path, watch);
    try {
        return make_frame(std::move(cells));
    } catch (const FileError& error) {
        fail(path, error.what());
    }
}

}  // namespace kropla
