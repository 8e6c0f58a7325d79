#include "mesh_files.h"

#include <kropla/base/error.h>
#include "io/file.h"
#include <kropla/io/vtk.h>
#include <kropla/mesh/verify.h>

#include <cstdlib>
#include <numbers>

namespace kropla {
namespace {

/// Written and read, one format after another.
FileCells round_trip(FileCells cells, const std::vector<std::string>& extensions) {
    const Folder folder;
    for (const std::string& extension : extensions) {
        write_mesh_file(folder / ("a" + extension), cells);
        cells = read_mesh_file(folder / ("a" + extension));
    }
    return cells;
}

TEST(MeshFile, ComesBackFromEachFormat) {
    const FileCells cells = named_cube();
    ASSERT_EQ(region_numbers(cells), (std::vector{0, 1}));
    ASSERT_EQ(patch_numbers(cells), (std::vector{1, 2, 3, 4, 5, 6, 9}));
    for (const char* extension : {".vtu", ".msh", ".mesh"}) {
        SCOPED_TRACE(extension);
        expect_same(round_trip(cells, {extension}), cells);
    }
}

TEST(MeshFile, ComesBackFromAllOneAfterAnother) {
    const FileCells cells = named_cube(5);
    expect_same(round_trip(cells, {".vtu", ".msh", ".mesh", ".vtu"}), cells);
}

TEST(MeshFile, CoordinatesComeBackBitForBit) {
    FileCells cells = named_cube(2);
    int i = 0;
    for (const double x : {0.1, 1.0 / 3, 5e-324, -0.0, 1e-310, 1.7976931348623157e308 / 1e300, std::numbers::pi * 1e-17})
        cells.position[Vertex(i++)] = {x, -x, 2 * x};
    const FileCells back = round_trip(cells, {".msh", ".mesh", ".vtu"});
    for (const Vertex v : cells.position.indices())
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(back.position[v][axis], cells.position[v][axis]);
            EXPECT_EQ(std::signbit(back.position[v][axis]), std::signbit(cells.position[v][axis]));
        }
}

TEST(MeshFile, PrismsComeBackWithTheirLayers) {
    for (const LayerPlan& plan : {LayerPlan{3, 0}, LayerPlan{0, 2}, LayerPlan{2, 3}}) {
        const Mesh mesh = layered_cube(4, plan);
        const FileCells cells = cells_of(mesh);
        ASSERT_FALSE(cells.prisms.empty());
        const FileCells back = round_trip(cells, {".msh", ".mesh", ".vtu"});
        EXPECT_EQ(make_frame(back).mesh, make_frame(cells).mesh);
        EXPECT_EQ(make_frame(back).mesh.layers.size(), mesh.layers.size());
    }
}

TEST(MeshFile, FacetsOfLayersAreNoBoundary) {
    const FileCells cells = cells_of(layered_cube(4));
    EXPECT_EQ(patch_numbers(cells), (std::vector{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(cells.facets.size(), 6u * 2 * 4 * 4);
}

TEST(MeshFile, AFileWithoutFacetsGetsItsBoundary) {
    FileCells cells = named_cube(3);
    const std::size_t on_body = 6 * 2;  // a cube of one small cube
    const std::size_t boundary = cells.facets.size() - on_body;
    cells.facets.clear();
    ASSERT_TRUE(add_boundary(cells));
    EXPECT_EQ(cells.facets.size(), boundary);
    EXPECT_EQ(cells.patch_names, (Names{{1, "boundary"}}));
    EXPECT_FALSE(add_boundary(cells));
}

TEST(MeshFile, TidyMendsWhatCanBeMended) {
    const FileCells good = named_cube(3);
    FileCells cells = good;
    std::swap(cells.tets[Tet(4)][0], cells.tets[Tet(4)][1]);
    cells.position.push_back({9, 9, 9});                                            // of no cell
    cells.tets[Tet(7)][2] = cells.position.push_back(good.position[good.tets[Tet(7)][2]]);  // at the same place
    cells.facets.push_back({{Vertex(0), Vertex(1), cells.position.push_back({8, 8, 8}), Vertex{}}, 77});
    const Tidied done = tidy(cells);
    EXPECT_EQ(done.turned, 1u);
    EXPECT_EQ(done.unused, 2u);
    EXPECT_EQ(done.united, 1u);
    EXPECT_EQ(cells.passed_over, 1u);
    EXPECT_EQ(cells.position, good.position);
    EXPECT_EQ(cells.facets, good.facets);
    EXPECT_EQ(verify(make_frame(cells).mesh), "");
    const Tidied again = tidy(cells);
    EXPECT_EQ(again.turned + again.unused + again.united, 0u);
}

TEST(MeshFile, PrismsInNoStackAreNamed) {
    FileCells cells = cells_of(layered_cube(4));
    for (LoosePrism& prism : cells.prisms) prism.layer = 0;
    for (Region& region : cells.region) region = surroundings;  // no interface is left
    EXPECT_NE(message_of<FileError>([&] { number_layers(cells); }).find("a prism, is in no stack"), std::string::npos);
}

TEST(MeshFile, UnknownFormatsAreNamed) {
    EXPECT_EQ(refusal_of("a.stl", "solid"),
              "is of no format that is known; the name is to end in .vtu (VTK), .msh (Gmsh) or .mesh (Medit)");
    const Folder folder;
    EXPECT_THROW(write_mesh_file(folder / "a.inp", named_cube(2)), FileError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.inp"));
}

std::string bytes_of(const std::string& name) {
    const Folder folder;
    write_mesh_file(folder / name, named_cube(2));
    return read_file(folder / name);
}

TEST(MeshFile, CutAnywhereIsRefused) {
    for (const std::string name : {"a.msh", "a.mesh"}) {
        const std::string good = bytes_of(name);
        ASSERT_EQ(refusal_of(name, good), "");
        for (std::size_t length = 0; length + 10 < good.size(); length += 61)
            EXPECT_NE(refusal_of(name, good.substr(0, length)), "") << name << " " << length;
    }
}

TEST(MeshFile, FlippedBytesNeverDoHarm) {
    for (const std::string name : {"a.msh", "a.mesh"}) {
        const std::string good = bytes_of(name);
        for (std::uint64_t seed = 1; seed <= 300; ++seed) {
            SCOPED_TRACE(seed);
            Random random{seed};
            std::string bad = good;
            for (std::uint64_t flips = 1 + random.below(4); flips > 0; --flips)
                bad[random.below(bad.size())] = static_cast<char>(seed % 2 == 0 ? '0' + random.below(10) : random.below(256));
            try {
                FileCells cells = cells_from(name, bad);
                (void)tidy(cells);
                (void)add_boundary(cells);
            } catch (const FileError&) {
            }
        }
    }
}

/// Another reader, where there is one: `meshio` for Python.
TEST(MeshFile, MeshioReadsTheSame) {
    if (std::system("python3 -c 'import meshio' 2>/dev/null") != 0) GTEST_SKIP() << "meshio is not installed";
    const Folder folder;
    const FileCells cells = named_cube();
    for (const char* name : {"a.msh", "a.mesh", "a.vtu"}) {
        write_mesh_file(folder / name, cells);
        const std::string script = "import meshio; m = meshio.read('" + (folder / name).string() + "'); assert len(m.points) == " +
                                   std::to_string(cells.position.size()) +
                                   " and sum(len(c.data) for c in m.cells if c.type == 'tetra') == " +
                                   std::to_string(cells.tets.size());
        EXPECT_EQ(std::system(("python3 -c \"" + script + "\"").c_str()), 0) << name;
    }
}

}  // namespace
}  // namespace kropla
