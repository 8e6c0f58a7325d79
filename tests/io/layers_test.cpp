// Prism layers in files: as VTK sees them, and back.

#include <kropla/base/error.h>
#include <kropla/io/checkpoint.h>
#include <kropla/io/vtk.h>
#include "layered.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWedge.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>

namespace kropla {
namespace {

const std::vector<LayerPlan> plans = {{3, 0}, {0, 2}, {4, 2, 1.0}, {1, 1}};

std::string name_of(const LayerPlan& plan) {
    return std::to_string(plan.outside) + " outside, " + std::to_string(plan.inside) + " inside";
}

Frame there_and_back(const Mesh& mesh) {
    const Folder folder;
    write_vtu(folder / "a.vtu", mesh);
    return read_vtu(folder / "a.vtu");
}

TEST(LayersInFiles, TheMeshesHereAreRight) {
    for (const LayerPlan& plan : plans) {
        SCOPED_TRACE(name_of(plan));
        const Mesh mesh = layered_cube(4, plan);
        EXPECT_EQ(verify(mesh), "");
        double tets = 0;
        for (const Tet t : mesh.tets.indices()) tets += volume(mesh, t);
        EXPECT_NEAR(tets + total_prism_volume(mesh), 64e-9, 1e-12 * 64e-9);
    }
}

TEST(LayersInFiles, ComeBackPrismByPrism) {
    for (const LayerPlan& plan : plans) {
        SCOPED_TRACE(name_of(plan));
        const Mesh mesh = layered_cube(4, plan), read = there_and_back(mesh).mesh;
        ASSERT_EQ(read.layers.size(), mesh.layers.size());
        EXPECT_EQ(read.position, mesh.position);
        EXPECT_EQ(read.patch, mesh.patch);
        EXPECT_EQ(read.layer_at, mesh.layer_at);
        EXPECT_TRUE(read.free_vertices.empty());
        EXPECT_EQ(verify(read), "");
        for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
            EXPECT_EQ(read.layers[l].region, mesh.layers[l].region);
            EXPECT_EQ(read.layers[l].body, mesh.layers[l].body);
            EXPECT_EQ(read.layers[l].count, mesh.layers[l].count);
            EXPECT_EQ(count_columns(read.layers[l]), count_columns(mesh.layers[l]));
        }
        const auto prisms = all_prisms(mesh), prisms_read = all_prisms(read);
        ASSERT_EQ(prisms_read.size(), prisms.size());
        for (std::size_t i = 0; i < prisms.size(); ++i)
            ASSERT_EQ(prism_vertices(read, prisms_read[i]), prism_vertices(mesh, prisms[i])) << i;
    }
}

/// The flux of x/3 out of a cell of VTK through its facets, each bilinear or flat: its volume if all of them are
/// turned outwards.
double volume_by_facets(vtkCell* cell) {
    const auto point = [&](vtkCell* facet, int i) {
        std::array<double, 3> x{};
        facet->GetPoints()->GetPoint(i, x.data());
        return Vec3{x[0], x[1], x[2]};
    };
    double volume = 0;
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
        vtkCell* facet = cell->GetFace(f);
        const int corners = static_cast<int>(facet->GetNumberOfPoints());
        for (int i = 0; i < corners; ++i) {  // of a quad, both cuts by a diagonal, by halves
            const Vec3 a = point(facet, i), b = point(facet, (i + 1) % corners), c = point(facet, (i + 2) % corners);
            volume += determinant(a, b, c) / (corners == 4 ? 12 : 18);
        }
    }
    return volume;
}

/// The volume of a wedge by VTK's own shape functions, at 3 x 2 points (exact for its bilinear quads). Their
/// Jacobian is negative for a wedge whose facets are turned outwards: VTK's two conventions differ, and it is the
/// facets that its pages prescribe and its pictures show.
double volume_by_shape_functions(vtkWedge* wedge) {
    double volume = 0;
    const double root = std::sqrt(1.0 / 3) / 2;
    for (const double t : {0.5 - root, 0.5 + root})
        for (const auto& [r, s] : {std::pair{0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}}) {
            std::array<double, 3> at = {r, s, t};
            std::array<double, 18> slopes{};
            wedge->InterpolateDerivs(at.data(), slopes.data());
            std::array<Vec3, 3> jacobian{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < 6; ++i) {
                    std::array<double, 3> x{};
                    wedge->GetPoints()->GetPoint(static_cast<vtkIdType>(i), x.data());
                    jacobian[axis] += slopes[axis * 6 + i] * Vec3{x[0], x[1], x[2]};
                }
            volume += determinant(jacobian[0], jacobian[1], jacobian[2]) / 12;
        }
    return volume;
}

TEST(LayersInFiles, AreWedgesAsVtkKnowsThem) {
    const Folder folder;
    const Mesh mesh = layered_cube(4, {3, 2});
    write_vtu(folder / "a.vtu", mesh);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder / "a.vtu").c_str());
    reader->Update();
    vtkUnstructuredGrid* grid = reader->GetOutput();
    const auto prisms = all_prisms(mesh);
    ASSERT_EQ(grid->GetNumberOfCells(), count_tets(mesh) + count_prisms(mesh));
    for (std::size_t i = 0; i < prisms.size(); ++i) {
        const vtkIdType cell = count_tets(mesh) + static_cast<vtkIdType>(i);
        ASSERT_EQ(grid->GetCellType(cell), VTK_WEDGE);
        const double ours = prism_volume(prism_corners(mesh, prisms[i]));
        ASSERT_GT(ours, 0);
        EXPECT_NEAR(volume_by_facets(grid->GetCell(cell)), ours, 1e-12 * ours + 1e-24);
        EXPECT_NEAR(-volume_by_shape_functions(vtkWedge::SafeDownCast(grid->GetCell(cell))), ours, 1e-9 * ours);
        const Region region = layer_of(mesh, prisms[i].layer).region;
        EXPECT_EQ(grid->GetCellData()->GetArray("region")->GetComponent(cell, 0), region.value);
        EXPECT_EQ(grid->GetCellData()->GetArray("layer")->GetComponent(cell, 0), prisms[i].k + 1);
    }
}

TEST(LayersInFiles, QualityOfPrismsHasTheMeaningOfTets) {
    const Folder folder;
    // One tet on the shell of a right prism on its own equilateral facet, a body of one tet below.
    const double h = 0.7, s = std::sqrt(3.0) / 2;
    const Array<Vertex, Vec3> position = {{0, 0, 0}, {1, 0, 0}, {0.5, s, 0}, {0, 0, h}, {1, 0, h}, {0.5, s, h},
                                          {0.5, 0.3, h + 1}, {0.5, 0.3, -1}};
    const auto v = [](int i) { return Vertex(i); };
    Mesh mesh = make_mesh(position, {{v(3), v(4), v(5), v(6)}, {v(0), v(2), v(1), v(7)}}, {Region(0), Region(1)});
    add_layers(mesh, {{surroundings, Region(1), 1, {{0, 1, 2}}, {v(0), v(3), v(1), v(4), v(2), v(5)}}});
    const auto figures = [&](const char* name) {
        write_vtu(folder / "a.vtu", mesh);
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->SetFileName((folder / "a.vtu").c_str());
        reader->Update();
        return reader->GetOutput()->GetCellData()->GetArray(name)->GetComponent(2, 0);
    };
    EXPECT_NEAR(figures("aspect_ratio"), 3, 1e-12);
    EXPECT_NEAR(figures("min_dihedral"), 60, 1e-12);
    mesh.position[v(5)].z = -1;  // turned over
    EXPECT_EQ(figures("aspect_ratio"), std::numeric_limits<double>::infinity());
}

/// What read_vtu says of a mesh whose loose prisms `spoil` has changed.
template <class Spoil>
std::string refusal(const Mesh& mesh, Spoil spoil) {
    const Folder folder;
    write_vtu(folder / "a.vtu", mesh);
    FileCells cells = read_vtu_cells(folder / "a.vtu");
    spoil(cells.prisms);
    return message_of<FileError>([&] { (void)make_frame(std::move(cells)); });
}

TEST(LayersInFiles, PrismsThatAreNoStacksAreRefused) {
    const Mesh mesh = layered_cube(4);
    using Prisms = std::vector<LoosePrism>;
    const auto first = count_tets(mesh);
    const auto cell = [&](int i) { return "cell " + std::to_string(first + i); };
    EXPECT_EQ(refusal(mesh, [](Prisms&) {}), "");
    EXPECT_EQ(refusal(mesh, [](Prisms& p) { p[2].layer = 4; }),
              cell(2) + ", a prism of layer 4, stands on " + cell(1) + ", which is of layer 2 of region 0");
    EXPECT_EQ(refusal(mesh, [](Prisms& p) { std::swap(p[1].vertices[1], p[1].vertices[2]); }),
              cell(1) + ", a prism of layer 2, is turned over against " + cell(0) + " below it");
    EXPECT_EQ(refusal(mesh, [](Prisms& p) { p.push_back(p[4]); }),
              cell(4) + ", a prism of layer 2, stands on the same triangle as " + cell(4));
    EXPECT_NE(refusal(mesh, [](Prisms& p) { p.erase(p.begin() + 5); }).find("begins a stack of 2 prisms, where"),
              std::string::npos);
    EXPECT_NE(refusal(mesh, [](Prisms& p) { p.erase(p.begin()); }).find("prisms only"), std::string::npos);
    EXPECT_NE(refusal(mesh, [](Prisms& p) {
                  for (LoosePrism& prism : p)
                      if (prism.layer == 3) std::swap(prism.vertices[3], prism.vertices[4]);
              }).find("parts from that of its neighbours"),
              std::string::npos);
}

TEST(LayersInFiles, ALayerOnNoBodyIsRefused) {
    Mesh mesh = layered_cube(4);
    for (Region& region : mesh.region) region = surroundings;
    EXPECT_EQ(refusal(mesh, [](auto&) {}), "prism layer 0 stands on no body's surface");
}

/// What read_vtu says of one tet with a wedge under it, numbered as VTK does.
std::string refusal_of_wedge(const std::string& cell_arrays, const std::string& types = "10 13") {
    const Folder folder;
    put(folder / "a.vtu", text_of({.points = "0 0 0  1 0 0  0 1 0  0 0 1  0 0 -1  1 0 -1  0 1 -1",
                                   .point_count = 7,
                                   .connectivity = "0 1 2 3  4 6 5 0 2 1",
                                   .offsets = "4 10",
                                   .types = types,
                                   .cell_count = 2,
                                   .cell_arrays = cell_arrays}));
    const std::string message = message_of<FileError>([&] { (void)read_vtu(folder / "a.vtu"); });
    return message.substr(std::min(message.size(), message.find("a.vtu: ") + 7));
}

TEST(LayersInFiles, WedgesOfOtherProgramsAreRefusedInOneLine) {
    const auto layer = [](const std::string& values) {
        return "<DataArray type=\"Int32\" Name=\"layer\" format=\"ascii\">" + values + "</DataArray>";
    };
    EXPECT_EQ(refusal_of_wedge(""), "cell 1, a prism, is in no stack that stands where two regions meet");
    EXPECT_EQ(refusal_of_wedge(layer("0 0")), "cell 1, a prism, is in no stack that stands where two regions meet");
    EXPECT_EQ(refusal_of_wedge(layer("0 -1")), "cell 1 has the layer -1.000000, not 0, 1, 2, ...");
    EXPECT_EQ(refusal_of_wedge(layer("0 2")), "of 1 prisms only 0 stand in stacks on a wall");
    EXPECT_EQ(refusal_of_wedge(layer("0 1")), "prism layer 0 stands on no body's surface");
    EXPECT_EQ(refusal_of_wedge(layer("0 1"), "10 25"),
              "cell 1 is a vtkQuadraticHexahedron (VTK cell type 25), not a linear tet or prism");
}

TEST(LayersInFiles, CheckpointsKeepEveryBit) {
    const Folder folder;
    Checkpoint checkpoint;
    checkpoint.mesh = layered_cube(4, {3, 2});
    write_checkpoint(folder / "a.h5", checkpoint);
    const Mesh read = read_checkpoint(folder / "a.h5").mesh;
    EXPECT_EQ(read.layers, checkpoint.mesh.layers);
    EXPECT_EQ(read.layer_at, checkpoint.mesh.layer_at);
    EXPECT_EQ(read, checkpoint.mesh);
}

}  // namespace
}  // namespace kropla
