// VTK's XML files of unstructured grids, by VTK itself into memory: the disk is io/file.h's business, so that its
// errors come with the system's reason.

#include <kropla/io/vtk.h>

#include "base/tetrahedron.h"
#include "io/file.h"
#include "io/vtk_inside.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kropla {
namespace {

template <class VtkArray>
vtkSmartPointer<VtkArray> make_array(const char* name, std::size_t size) {
    auto array = vtkSmartPointer<VtkArray>::New();
    array->SetName(name);
    array->SetNumberOfValues(static_cast<vtkIdType>(size));
    return array;
}

/// Cells of all kinds, one after another, as VTK wants them.
class CellLists {
public:
    CellLists(std::size_t cells, std::size_t corners)
        : offsets_(make_array<vtkTypeInt64Array>("offsets", cells + 1)),
          connectivity_(make_array<vtkTypeInt64Array>("connectivity", corners)),
          types_(make_array<vtkUnsignedCharArray>("types", cells)) {}

    void add(unsigned char type, std::span<const Vertex> vertices) {
        types_->SetValue(cell_, type);
        offsets_->SetValue(cell_++, next_);
        for (const Vertex v : vertices) connectivity_->SetValue(next_++, v.value);
    }
    void add_prism(const std::array<Vertex, 6>& ours) {
        std::array<Vertex, 6> vertices;
        for (std::size_t i = 0; i < 6; ++i) vertices[i] = ours[wedge_corners[i]];
        add(VTK_WEDGE, vertices);
    }
    void give_to(vtkUnstructuredGrid* grid) {
        offsets_->SetValue(cell_, next_);
        vtkNew<vtkCellArray> array;
        array->SetData(offsets_, connectivity_);
        grid->SetCells(types_, array);
    }

private:
    // 64 bits for the offsets' sake: four per cell pass 2^31 before the cells do.
    vtkSmartPointer<vtkTypeInt64Array> offsets_, connectivity_;
    vtkSmartPointer<vtkUnsignedCharArray> types_;
    vtkIdType cell_ = 0, next_ = 0;
};

void add_points(vtkUnstructuredGrid* grid, const Array<Vertex, Vec3>& position) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(position.size()));
    for (const Vertex v : position.indices()) {
        const Vec3& p = position[v];
        points->SetPoint(v.value, p.x, p.y, p.z);
    }
    grid->SetPoints(points);
}

void add_cells(vtkUnstructuredGrid* grid, const Mesh& mesh) {
    add_points(grid, mesh.position);
    const std::vector<Prism> prisms = all_prisms(mesh);
    CellLists lists(mesh.tets.size() + prisms.size(), 4 * mesh.tets.size() + 6 * prisms.size());
    for (const auto& tet : mesh.tets) lists.add(VTK_TETRA, tet);
    for (const Prism& prism : prisms) lists.add_prism(prism_vertices(mesh, prism));
    lists.give_to(grid);
}

void add_cells(vtkUnstructuredGrid* grid, const FileCells& cells) {
    add_points(grid, cells.position);
    std::size_t corners = 4 * cells.tets.size() + 6 * cells.prisms.size();
    for (const PatchFacet& facet : cells.facets) corners += facet.vertices[3].exists() ? 4u : 3u;
    CellLists lists(cells.tets.size() + cells.prisms.size() + cells.facets.size(), corners);
    for (const auto& tet : cells.tets) lists.add(VTK_TETRA, tet);
    for (const LoosePrism& prism : cells.prisms) lists.add_prism(prism.vertices);
    for (const PatchFacet& facet : cells.facets) {
        const bool quad = facet.vertices[3].exists();
        lists.add(quad ? VTK_QUAD : VTK_TRIANGLE, std::span(facet.vertices).first(quad ? 4 : 3));
    }
    lists.give_to(grid);
}

double min_dihedral(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return tet_dihedral_range(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]).least *
           (180 / std::numbers::pi);
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

constexpr int none = -1;  // the region of a cell of a surface, and the patch of one of volume

/// Region, layer and patch of each cell.
void add_cell_arrays(vtkUnstructuredGrid* grid, const FileCells& cells) {
    const std::size_t count = cells.tets.size() + cells.prisms.size() + cells.facets.size();
    const auto region = make_array<vtkTypeInt32Array>("region", count);
    const auto layer = make_array<vtkTypeInt32Array>("layer", count);
    const auto patch = make_array<vtkTypeInt32Array>(patch_array, count);
    vtkIdType cell = 0;
    const auto add = [&](int of_region, int of_layer, int of_patch) {
        region->SetValue(cell, of_region);
        layer->SetValue(cell, of_layer);
        patch->SetValue(cell++, of_patch);
    };
    for (const Region r : cells.region) add(r.value, 0, none);
    for (const LoosePrism& prism : cells.prisms) add(prism.region.value, prism.layer, none);
    for (const PatchFacet& facet : cells.facets) add(none, 0, facet.patch);
    grid->GetCellData()->AddArray(region);
    grid->GetCellData()->AddArray(layer);
    grid->GetCellData()->AddArray(patch);
}

void add_names(vtkUnstructuredGrid* grid, const char* array_name, const Names& names) {
    if (names.empty()) return;
    const vtkNew<vtkStringArray> array;
    array->SetName(array_name);
    for (const auto& [number, name] : names) array->InsertNextValue(std::to_string(number) + ' ' + name);
    grid->GetFieldData()->AddArray(array);
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

void add_field(vtkUnstructuredGrid* grid, const CellField& field) {
    const auto array = make_array<vtkDoubleArray>(field.name.c_str(), field.values.size());
    array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit.c_str());
    for (std::size_t i = 0; i < field.values.size(); ++i) array->SetValue(static_cast<vtkIdType>(i), field.values[i]);
    grid->GetCellData()->AddArray(array);
}

void write_grid(const std::filesystem::path& path, vtkUnstructuredGrid* grid, const Watch* watch) {
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

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, std::span<const NodalField> fields,
               const Watch* watch, std::span<const NodalVectorField> vectors, std::span<const CellField> of_cells) {
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
    for (const CellField& field : of_cells) add_field(grid, field);
    write_grid(path, grid, watch);
}

void write_vtu(const std::filesystem::path& path, const FileCells& cells, const Watch* watch) {
    vtkNew<vtkUnstructuredGrid> grid;
    add_cells(grid, cells);
    add_cell_arrays(grid, cells);
    add_names(grid, region_names_array, cells.region_names);
    add_names(grid, patch_names_array, cells.patch_names);
    Array<Vertex, Vertex> same;
    for (const Vertex v : cells.position.indices()) same.push_back(v);
    for (const NodalField& field : cells.fields) add_field(grid, field, same);
    for (const NodalVectorField& field : cells.vectors) add_field(grid, field, same);
    heed(watch);
    write_grid(path, grid, watch);
}

}  // namespace kropla
