// `kropla improve --remesh-surface`.
#include "../io/mesh_files.h"
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include "program.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// A ball, 2, in a ball, 1, twisted about its axis between the centre and the outer surface, with a patch 9 on its surface.
FileCells twisted_ball() {
    FileCells cells = read_mesh_file(std::filesystem::path(KROPLA_CASES) / "meshes" / "spheres.mesh");
    for (Vec3& x : cells.position) {
        const double turn = 5 * x.z * std::max(0.0, 1 - norm(x));
        x = {x.x * std::cos(turn) - x.y * std::sin(turn), x.x * std::sin(turn) + x.y * std::cos(turn), x.z};
    }
    cells.patch_names[9] = "skin";
    const Mesh mesh = make_frame(cells).mesh;
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (!n.exists() || !(mesh.region[t] < mesh.region[n])) continue;
            const auto [a, b, c] = facet_vertices(mesh, {t, corner});
            cells.facets.push_back({{a, b, c, Vertex{}}, 9});
        }
    return cells;
}

double worst(const FileCells& cells) {
    const Mesh mesh = make_frame(cells).mesh;
    return worst_aspect_ratio(mesh, all_tets(mesh));
}

std::ptrdiff_t facets_of(const FileCells& cells, int patch) { return std::ranges::count(cells.facets, patch, &PatchFacet::patch); }

TEST(RemeshSurface, InterfacesChangeAndKeepVolumesAndPatches) {
    const TemporaryFolder folder;
    const FileCells bad = twisted_ball();
    write_mesh_file(folder.path / "a.msh", bad);
    ASSERT_EQ(kropla_program(folder, "improve a.msh -o kept.vtu").code, 0);
    const Outcome ended = kropla_program(folder, "improve a.msh -o b.vtu --remesh-surface");
    EXPECT_EQ(ended.code, 0) << ended.err;
    for (const char* words : {"triangles of interfaces", "their least angle [deg]", "their largest angle [deg]"})
        EXPECT_TRUE(says(ended.out, words)) << words;
    const FileCells kept = read_mesh_file(folder.path / "kept.vtu"), better = read_mesh_file(folder.path / "b.vtu");
    EXPECT_GT(worst(bad), 300);
    EXPECT_GT(worst(kept), 7.8);  // reached: 8.64
    EXPECT_LT(worst(better), 6.9);  // 6.27
    const Mesh before = make_frame(bad).mesh, after = make_frame(better).mesh;
    for (const int region : {1, 2})
        EXPECT_NEAR(region_volume(after, Region(region)) / region_volume(before, Region(region)), 1, 1e-13);
    EXPECT_EQ(facets_of(kept, 9), 192);
    std::ptrdiff_t between = 0;
    for (const Tet t : after.tets.indices())
        for (const Tet n : after.neighbour[t]) between += n.exists() && after.region[t] < after.region[n] ? 1 : 0;
    EXPECT_NE(between, 192);
    EXPECT_EQ(facets_of(better, 9), between);
    EXPECT_EQ(facets_of(better, 1), facets_of(bad, 1));
    EXPECT_EQ(kropla_program(folder, "check b.vtu").code, 0);
}

TEST(RemeshSurface, IsTheSameForAnyNumberOfThreads) {
    const TemporaryFolder folder;
    write_mesh_file(folder.path / "a.msh", twisted_ball());
    for (const char* threads : {"1", "2"})
        ASSERT_EQ(kropla_program(folder, std::string("improve a.msh --remesh-surface --threads ") + threads + " -o " + threads + ".vtu").code, 0);
    expect_same(read_mesh_file(folder.path / "1.vtu"), read_mesh_file(folder.path / "2.vtu"));
}

TEST(RemeshSurface, TellsWhichInterfacesStay) {
    const TemporaryFolder folder;
    FileCells cells = twisted_ball();
    cells.facets.back().patch = 8;  // a part of the surface
    write_mesh_file(folder.path / "a.vtu", cells);
    Outcome ended = kropla_program(folder, "improve a.vtu -o b.vtu --remesh-surface");
    EXPECT_TRUE(says(ended.out, "the interface of regions 1 and 2 stays as it is: it has several patches, or one on a part of it\n")) << ended.out;
    const FileCells better = read_mesh_file(folder.path / "b.vtu");
    EXPECT_EQ(facets_of(better, 9), 191);
    EXPECT_EQ(facets_of(better, 8), 1);
    for (const Tet t : cells.tets.indices())
        if (cells.region[t] == Region(2) && cells.position[cells.tets[t][0]].x > 0) cells.region[t] = Region(3);
    write_mesh_file(folder.path / "a.vtu", cells);
    ended = kropla_program(folder, "improve a.vtu -o b.vtu --remesh-surface");
    for (const char* pair : {"1 and 2", "1 and 3", "2 and 3"})
        EXPECT_TRUE(says(ended.out, std::string("the interface of regions ") + pair +
                                     " stays as it is: it is at the boundary, at a third region, or touches itself\n")) << ended.out;
}

}  // namespace
}  // namespace kropla
