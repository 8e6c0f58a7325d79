#include <kropla/io/vtk.h>

#include <kropla/base/error.h>
#include "examples.h"
#include "io/file.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <algorithm>
#include <limits>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTetra.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace kropla {
namespace {

NodalField some_field(const Mesh& mesh) {
    NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size())};
    Random random{7};
    for (double& value : field.values) value = random.uniform(300, 3000);
    return field;
}

/// The mesh with a free slot for a vertex and a tet in front of and behind the living ones.
Mesh with_free_slots(const Mesh& mesh) {
    Mesh with = mesh;
    with.free_vertices.push_back(with.position.push_back({9, 9, 9}));
    with.tet_at.push_back({});
    with.layer_at.push_back({});
    with.free_tets.push_back(with.tets.push_back({}));
    with.neighbour.push_back({});
    with.patch.push_back({});
    with.region.push_back({});
    return with;
}

std::string refusal(const PlainVtu& vtu) {
    const Folder folder;
    put(folder / "a.vtu", text_of(vtu));
    const std::string message = message_of<FileError>([&] { (void)read_vtu(folder / "a.vtu"); });
    EXPECT_NE(message.find("a.vtu: "), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message.substr(std::min(message.size(), message.find("a.vtu: ") + 7));
}

TEST(Vtu, ComesBackBitForBit) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(5);
    const NodalField field = some_field(mesh);
    write_vtu(folder / "a.vtu", mesh, std::vector{field});
    const Frame frame = read_vtu(folder / "a.vtu");
    EXPECT_EQ(frame.mesh.position, mesh.position);
    EXPECT_EQ(frame.mesh.tets, mesh.tets);
    EXPECT_EQ(frame.mesh.region, mesh.region);
    EXPECT_EQ(verify(frame.mesh), "");
    ASSERT_EQ(frame.fields.size(), 1u);
    EXPECT_EQ(frame.fields[0].name, "temperature");
    EXPECT_EQ(frame.fields[0].unit, "K");
    EXPECT_EQ(frame.fields[0].values, field.values);
}

TEST(Vtu, BringsBackVectors) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(2);
    const NodalVectorField velocity{"velocity", "m/s", mesh.position};
    write_vtu(folder / "a.vtu", mesh, {}, nullptr, std::vector{velocity});
    const Frame frame = read_vtu(folder / "a.vtu");
    EXPECT_TRUE(frame.fields.empty());
    ASSERT_EQ(frame.vectors.size(), 1u);
    EXPECT_EQ(frame.vectors[0].name, "velocity");
    EXPECT_EQ(frame.vectors[0].unit, "m/s");
    EXPECT_EQ(frame.vectors[0].values, velocity.values);
}

TEST(Vtu, IsTheSameFileEachTime) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(3);
    write_vtu(folder / "a.vtu", mesh);
    write_vtu(folder / "b.vtu", mesh);
    std::ifstream a(folder / "a.vtu"), b(folder / "b.vtu");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(a), {}),
              std::string(std::istreambuf_iterator<char>(b), {}));
}

TEST(Vtu, LeavesOutFreeSlots) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(2);
    NodalField field = some_field(mesh);
    const Array<Vertex, double> living = field.values;
    field.values.push_back(-1);
    write_vtu(folder / "a.vtu", with_free_slots(mesh), std::vector{field});
    const Frame frame = read_vtu(folder / "a.vtu");
    EXPECT_EQ(frame.mesh.position, mesh.position);
    EXPECT_EQ(frame.mesh.tets, mesh.tets);
    EXPECT_EQ(frame.fields.at(0).values, living);
}

TEST(Vtu, IsWhatVtkItselfReads) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(4);
    write_vtu(folder / "a.vtu", mesh, std::vector{some_field(mesh)});
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder / "a.vtu").c_str());
    reader->Update();
    vtkUnstructuredGrid* grid = reader->GetOutput();
    ASSERT_EQ(grid->GetNumberOfCells(), count_tets(mesh));
    std::array<double, 2> volumes = {};
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
        ASSERT_EQ(grid->GetCellType(i), VTK_TETRA);
        std::array<std::array<double, 3>, 4> p = {};
        for (int k = 0; k < 4; ++k)
            grid->GetPoint(grid->GetCell(i)->GetPointId(k), p[static_cast<std::size_t>(k)].data());
        const double region = grid->GetCellData()->GetArray("region")->GetComponent(i, 0);
        volumes[static_cast<std::size_t>(region)] +=
            vtkTetra::ComputeVolume(p[0].data(), p[1].data(), p[2].data(), p[3].data());
    }
    EXPECT_NEAR(volumes[0] + volumes[1], 64e-9, 64e-9 * 1e-12);
    for (int r = 0; r < 2; ++r)
        EXPECT_NEAR(volumes[static_cast<std::size_t>(r)], region_volume(mesh, Region(r)), 64e-9 * 1e-12);
}

TEST(Vtu, HasTheArraysByTheirNames) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(3);
    write_vtu(folder / "a.vtu", mesh, std::vector{some_field(mesh)});
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder / "a.vtu").c_str());
    reader->Update();
    vtkCellData* cells = reader->GetOutput()->GetCellData();
    ASSERT_EQ(cells->GetNumberOfArrays(), 4);
    EXPECT_EQ(cells->GetArray("region")->GetDataType(), VTK_INT);
    EXPECT_EQ(cells->GetArray("layer")->GetDataType(), VTK_INT);
    ASSERT_EQ(cells->GetArray("aspect_ratio")->GetDataType(), VTK_DOUBLE);
    ASSERT_EQ(cells->GetArray("min_dihedral")->GetDataType(), VTK_DOUBLE);
    double least = 180;
    for (const Tet t : mesh.tets.indices()) {
        EXPECT_EQ(cells->GetArray("aspect_ratio")->GetComponent(t.value, 0), aspect_ratio(mesh, t));
        EXPECT_EQ(cells->GetArray("layer")->GetComponent(t.value, 0), 0);
        least = std::min(least, cells->GetArray("min_dihedral")->GetComponent(t.value, 0));
    }
    EXPECT_DOUBLE_EQ(least, summarise_quality(mesh).min_dihedral);
    EXPECT_NE(reader->GetOutput()->GetPointData()->GetArray("temperature"), nullptr);
}

TEST(Vtu, PatchesAreTheFacesOfTheBox) {
    const Folder folder;
    write_vtu(folder / "a.vtu", cube_of_tets(3));
    const Mesh mesh = read_vtu(folder / "a.vtu").mesh;
    std::array<int, 6> facets = {};
    for (const auto& patches : mesh.patch)
        for (const Patch patch : patches)
            if (patch.exists()) ++facets.at(static_cast<std::size_t>(patch.value));
    for (const int count : facets) EXPECT_EQ(count, 3 * 3 * 2);
}

TEST(Vtu, KeepsCellsThatAreWrong) {
    const Folder folder;
    put(folder / "a.vtu", text_of({.connectivity = "0 2 1 3"}));
    const Frame frame = read_vtu(folder / "a.vtu");
    EXPECT_NE(verify(frame.mesh).find("inside out"), std::string::npos);
}

TEST(Vtu, ReadsWhatOthersWrite) {
    const Folder folder;
    put(folder / "a.vtu", text_of({}));
    const Frame frame = read_vtu(folder / "a.vtu");
    EXPECT_EQ(verify(frame.mesh), "");
    EXPECT_EQ(frame.mesh.region[Tet(0)], surroundings);
}

TEST(Vtu, PassesOverCellsWithoutVolume) {
    const Folder folder;
    put(folder / "a.vtu", text_of({.connectivity = "0  0 1  0 2 1  0 1 2 3  0 1 3",
                                   .offsets = "1 3 6 10 13",
                                   .types = "1 3 5 10 5",
                                   .cell_count = 5,
                                   .cell_arrays = "<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">"
                                                  "7 7 7 3 7</DataArray>"}));
    const FileCells cells = read_vtu_cells(folder / "a.vtu");
    EXPECT_EQ(cells.tets.size(), 1u);
    EXPECT_EQ(cells.region[Tet(0)], Region(3));
    EXPECT_EQ(cells.passed_over, 4u);
}

TEST(Vtu, RefusesInOneLine) {
    EXPECT_EQ(refusal({.connectivity = "", .offsets = "", .types = "", .cell_count = 0}), "has no cells");
    EXPECT_EQ(refusal({.types = "12"}), "cell 0 is a vtkHexahedron (VTK cell type 12), not a linear tet or prism");
    EXPECT_EQ(refusal({.types = "24"}),
              "cell 0 is a vtkQuadraticTetra (VTK cell type 24), not a linear tet or prism");
    EXPECT_EQ(refusal({.types = "9"}), "has no tets");
    EXPECT_EQ(refusal({.connectivity = "0 1 2 4"}), "cell 0 has vertex 4, which is not among the 4");
    EXPECT_EQ(refusal({.connectivity = "0 1 2", .offsets = "3"}), "cell 0 is a tet of 3 vertices");
    const std::string region = "<DataArray type=\"Float64\" Name=\"region\" format=\"ascii\">-1</DataArray>";
    EXPECT_EQ(refusal({.cell_arrays = region}), "cell 0 has the region -1.000000, not 0, 1, 2, ...");
}

TEST(Vtu, RefusesCoordinatesThatAreNoNumbers) {
    const Folder folder;
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
        Mesh mesh = cube_of_tets(2);
        mesh.position[Vertex(5)].y = bad;
        write_vtu(folder / "a.vtu", mesh);
        EXPECT_NE(message_of<FileError>([&] {
                      (void)read_vtu(folder / "a.vtu");
                  }).find("vertex 5 has a coordinate"),
                  std::string::npos);
    }
}

TEST(Vtu, NamesTheCellOfAFacetWithThreeCells) {
    PlainVtu three;
    three.points += "  0 0 -1  1 1 1";
    three.point_count = 6;
    three.connectivity = "0 1 2 3  0 2 1 4  0 1 2 5";
    three.offsets = "4 8 12";
    three.types = "10 10 10";
    three.cell_count = 3;
    EXPECT_NE(refusal(three).find("cell 2"), std::string::npos);
}

TEST(Vtu, RefusesWhatIsNotVtu) {
    const Folder folder;
    const auto refused = [&](const std::string& bytes) {
        put(folder / "a.vtu", bytes);
        return message_of<FileError>([&] { (void)read_vtu(folder / "a.vtu"); });
    };
    EXPECT_NE(refused("").find("is empty"), std::string::npos);
    EXPECT_NE(refused("\x89PNG\r\n\x1a\n garbage").find("is not a VTU file"), std::string::npos);
    EXPECT_NE(refused("<VTKFile type=\"PolyData\"></VTKFile>").find("not of an unstructured grid"),
              std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { (void)read_vtu(folder / "none.vtu"); }).find("No such file"),
              std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { (void)read_vtu(folder.path()); }).find("Is a directory"),
              std::string::npos);
}

TEST(Vtu, SaysWhyItCannotBeWritten) {
    const Folder folder;
    const auto message = message_of<FileError>([&] { write_vtu(folder / "none/a.vtu", cube_of_tets(1)); });
    EXPECT_NE(message.find("none/a.vtu: cannot be written: No such file or directory"), std::string::npos);
}

TEST(Vtk, IsEndedByItsWatch) {
    const Folder folder;
    const Mesh mesh = cube_of_tets(2);
    Watch watch;
    write_vtu(folder / "a.vtu", mesh, {}, &watch);
    const std::string whole = read_file(folder / "a.vtu");
    write_vtu(folder / "b.vtu", mesh);
    EXPECT_EQ(whole, read_file(folder / "b.vtu"));
    EXPECT_EQ(read_vtu(folder / "a.vtu", &watch).mesh.tets, mesh.tets);
    watch.stop = true;
    EXPECT_THROW(write_vtu(folder / "a.vtu", mesh, std::vector{some_field(mesh)}, &watch), Interrupted);
    EXPECT_THROW(static_cast<void>(read_vtu(folder / "a.vtu", &watch)), Interrupted);
    EXPECT_EQ(read_file(folder / "a.vtu"), whole);
}

}  // namespace
}  // namespace kropla
