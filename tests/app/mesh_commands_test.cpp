// `kropla convert` and `kropla improve` as users meet them.
#include "../io/mesh_files.h"
#include "app/commands.h"
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include "program.h"

#include <algorithm>

namespace kropla {
namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

TEST(Convert, TellsWhatTheMeshHolds) {
    const TemporaryFolder folder;
    write_mesh_file(folder.path / "a.vtu", named_cube());
    const Outcome ended = kropla_program(folder, "convert a.vtu a.msh");
    EXPECT_EQ(ended.code, 0);
    EXPECT_EQ(ended.out, "a.msh: 384 tets, 0 prisms, 125 vertices, 2 regions (surroundings, the rotor, hot), "
                      "7 patches (inlet, outlet, 3, 4, 5, 6, skin)\n");
    ASSERT_EQ(kropla_program(folder, "convert a.msh a.mesh").code, 0);
    ASSERT_EQ(kropla_program(folder, "convert a.mesh b.vtu").code, 0);
    expect_same(read_mesh_file(folder.path / "b.vtu"), named_cube());
}

TEST(Convert, SaysWhatItMended) {
    const TemporaryFolder folder;
    FileCells cells = named_cube(2);
    cells.facets.clear();
    for (auto& tet : cells.tets) std::swap(tet[0], tet[1]);
    cells.position.push_back({9, 9, 9});
    cells.fields.push_back({"heat", "", Array<Vertex, double>(cells.position.size(), 1.0)});
    write_mesh_file(folder.path / "a.vtu", cells);
    const Outcome ended = kropla_program(folder, "convert a.vtu b.msh");
    EXPECT_EQ(ended.code, 0);
    for (const char* words : {"1 vertex of no cell was dropped\n", "48 cells were inside out and were turned round\n",
                              "its boundary is the patch \"boundary\"\n", "left out, as only VTU holds fields here: heat\n",
                              "1 patch (boundary)"})
        EXPECT_TRUE(says(ended.out, words)) << words << ended.out;
    ASSERT_EQ(kropla_program(folder, "convert a.vtu b.vtu").code, 0);
    EXPECT_EQ(read_mesh_file(folder.path / "b.vtu").fields.size(), 1u);
    EXPECT_EQ(kropla_program(folder, "check b.vtu b.msh").code, 0);
}

TEST(Convert, BadFilesEndInOneLine) {
    const TemporaryFolder folder;
    write_mesh_file(folder.path / "a.vtu", named_cube(2));
    put(folder.path / "bad.msh", "solid");
    for (const auto& [arguments, code] : {std::pair("convert a.vtu b.stl", 2), {"convert a.vtk b.msh", 2}, {"convert a.vtu", 2},
                                          {"convert none.msh b.msh", 5}, {"convert bad.msh b.msh", 5}, {"improve bad.msh -o b.msh", 5},
                                          {"convert a.vtu none/b.msh", 5}, {"improve a.vtu", 2}, {"improve a.vtu -o b.txt", 2}}) {
        SCOPED_TRACE(arguments);
        const Outcome ended = kropla_program(folder, arguments);
        EXPECT_EQ(ended.code, code);
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path / "b.msh"));
    }
}

TEST(Mesh, IsWrittenInEachFormatWithNames) {
    const TemporaryFolder folder;
    const Outcome made = kropla_program(folder, "new droplet");
    ASSERT_EQ(made.code, 0);
    const std::string coarse = " --set size.surface=6e-4 --set size.far=2e-3";
    for (const char* name : {"a.msh", "a.mesh"}) {
        ASSERT_EQ(kropla_program(folder, std::string("mesh droplet.toml -o ") + name + coarse).code, 0);
        const FileCells cells = read_mesh_file(folder.path / name);
        EXPECT_EQ(cells.region_names, (Names{{0, "surroundings"}, {1, "droplet"}}));
        EXPECT_EQ(cells.patch_names.at(6), "z_max");
        EXPECT_EQ(patch_numbers(cells), (std::vector{1, 2, 3, 4, 5, 6}));
    }
}

/// Those within the body at random, here and there far nearer to each other than cells are large: with flat cells.
FileCells bad_cube(int n) {
    FileCells cells = named_cube(n);
    Random random{5};
    for (const Vertex v : cells.position.indices()) {
        Vec3& x = cells.position[v];
        const Vec3 old = x;
        const Vec3 shift = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const auto is_inside = [&](double c) { return c > 1.5e-3 && c < 1e-3 * n - 1.5e-3; };
        if (is_inside(x.x) && is_inside(x.y) && is_inside(x.z)) x += 0.6e-3 * shift;
        for (const auto& t : cells.tets)  // no cell is turned over
            if (std::ranges::find(t, v) != t.end() &&
                determinant(cells.position[t[1]] - cells.position[t[0]], cells.position[t[2]] - cells.position[t[0]],
                            cells.position[t[3]] - cells.position[t[0]]) <= 0)
                x = old;
    }
    return cells;
}

TEST(Improve, KeepsBoundaryInterfacesAndNames) {
    const TemporaryFolder folder;
    const FileCells bad = bad_cube(6);
    write_mesh_file(folder.path / "a.msh", bad);
    const Outcome ended = kropla_program(folder, "improve a.msh -o b.vtu");
    EXPECT_EQ(ended.code, 0) << ended.err;
    for (const char* words : {"before", "after", "worst R/r", "R/r, 99.9 %", "least dihedral", "tets above R/r 10", "seconds"})
        EXPECT_TRUE(says(ended.out, words)) << words;
    FileCells better = read_mesh_file(folder.path / "b.vtu");
    EXPECT_EQ(better.region_names, bad.region_names);
    EXPECT_EQ(better.patch_names, bad.patch_names);
    ASSERT_EQ(better.facets.size(), bad.facets.size());
    for (std::size_t i = 0; i < bad.facets.size(); ++i)  // places stay, numbers may be others
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(better.position[better.facets[i].vertices[k]], bad.position[bad.facets[i].vertices[k]]);
            EXPECT_EQ(better.facets[i].patch, bad.facets[i].patch);
        }
    EXPECT_LT(worst_aspect_ratio(make_frame(better).mesh, all_tets(make_frame(better).mesh)), 10);
    EXPECT_GT(worst_aspect_ratio(make_frame(bad).mesh, all_tets(make_frame(bad).mesh)), 20);
    EXPECT_EQ(kropla_program(folder, "check b.vtu").code, 0);
}

TEST(Improve, KeepsPrisms) {
    const TemporaryFolder folder;
    const FileCells cells = cells_of(layered_cube(6, {2, 2}));
    write_mesh_file(folder.path / "a.vtu", cells);
    ASSERT_EQ(kropla_program(folder, "improve a.vtu -o b.vtu").code, 0);
    const FileCells better = read_mesh_file(folder.path / "b.vtu");
    ASSERT_EQ(better.prisms.size(), cells.prisms.size());
    for (std::size_t i = 0; i < cells.prisms.size(); ++i)
        for (std::size_t k = 0; k < 6; ++k)
            EXPECT_EQ(better.position[better.prisms[i].vertices[k]], cells.position[cells.prisms[i].vertices[k]]);
    EXPECT_EQ(kropla_program(folder, "check b.vtu").code, 0);
}

TEST(Improve, RefusesAMeshThatOverlapsItself) {
    const TemporaryFolder folder;
    FileCells cells = named_cube(4);
    for (const Vertex v : cells.position.indices())
        if (distance(cells.position[v], {2e-3, 2e-3, 2e-3}) < 0.5e-3) cells.position[v] = {3.6e-3, 2e-3, 2e-3};
    write_mesh_file(folder.path / "a.msh", cells);
    const Outcome ended = kropla_program(folder, "improve a.msh -o b.msh");
    EXPECT_EQ(ended.code, 5);
    EXPECT_TRUE(says(ended.err, "a.msh: cells ")) << ended.err;
    EXPECT_TRUE(says(ended.err, "lie on one side of the facet between them")) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "b.msh"));
}

}  // namespace
}  // namespace kropla
