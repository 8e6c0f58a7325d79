#include "app/check_files.h"

#include "../io/examples.h"
#include "app/fault.h"
#include <kropla/base/error.h>
#include <kropla/io/pvd.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/verify.h>
#include "program.h"

#include <algorithm>
#include <limits>

namespace kropla {
namespace {

/// A cube of tets of which region 1 is cut loose and shifted.
Mesh cut_loose(const Vec3& shift) {
    const Mesh cube = cube_of_tets(4);
    auto position = cube.position;
    auto tets = cube.tets;
    Array<Vertex, Vertex> own(cube.position.size());
    for (const Tet t : cube.tets.indices()) {
        if (cube.region[t] == surroundings) continue;
        for (Vertex& v : tets[t]) {
            if (!own[v].exists()) own[v] = position.push_back(cube.position[v] + shift);
            v = own[v];
        }
    }
    return make_mesh(std::move(position), std::move(tets), cube.region);
}

Mesh twice(const Mesh& mesh) {
    auto position = mesh.position;
    auto tets = mesh.tets;
    auto region = mesh.region;
    for (const Vec3& x : mesh.position) position.push_back(x);
    for (const Tet t : mesh.tets.indices()) {
        auto v = mesh.tets[t];
        for (Vertex& corner : v) corner = Vertex(corner.value + static_cast<std::int32_t>(mesh.position.size()));
        tets.push_back(v);
        region.push_back(mesh.region[t]);
    }
    return make_mesh(std::move(position), std::move(tets), std::move(region));
}

TEST(Fault, MeshesThatLieOverThemselvesAreNamed) {
    const Mesh shifted = cut_loose({4e-4, 0, 0}), doubled = twice(cube_of_tets(4));
    ASSERT_EQ(verify(shifted), "");
    ASSERT_EQ(verify(doubled), "");
    const auto expect = [](const Mesh& mesh, const char* words) {
        const std::string fault = fault_of(mesh);
        EXPECT_TRUE(fault.starts_with("cell ")) << fault;
        EXPECT_NE(fault.find(words), std::string::npos) << fault;
    };
    expect(shifted, " cuts that opposite corner ");
    expect(doubled, " covers that opposite corner ");
    // Loose where it is: its vertices lie on the facets that were theirs.
    expect(cut_loose({}), " lies in its facet ");
    EXPECT_EQ(fault_of(cube_of_tets(4)), "");
}

TEST(Fault, AllCellsTurnedAreSaidOnce) {
    Mesh mesh = cube_of_tets(3);
    for (auto& v : mesh.tets) std::swap(v[2], v[3]);
    EXPECT_EQ(fault_of(make_mesh(mesh.position, mesh.tets, mesh.region)),
              "all 162 tets are inside out: the file numbers their corners the other way round");
}

TEST(CheckFiles, TakesFoldersSeriesAndFiles) {
    const Folder folder;
    std::filesystem::create_directories(folder / "run/frames");
    for (const char* name : {"run/frames/00001.vtu", "run/frames/00000.vtu", "run/frames/note.txt"})
        put(folder / name, "-");
    write_pvd(folder / "run/frames.pvd", std::array{SeriesEntry{0.5, "frames/00001.vtu"}});
    const auto files = [&](const std::vector<std::filesystem::path>& paths) { return files_to_check(paths); };
    const auto first = folder / "run/frames/00000.vtu", second = folder / "run/frames/00001.vtu";
    EXPECT_EQ(files({folder / "run"}), (std::vector{first, second}));
    EXPECT_EQ(files({folder / "run/frames"}), (std::vector{first, second}));
    EXPECT_EQ(files({folder / "run/frames.pvd", first}), (std::vector{second, first}));
    std::filesystem::create_directories(folder / "empty");
    EXPECT_THROW((void)files({folder / "empty"}), FileError);
    EXPECT_THROW((void)files({folder / "none.pvd"}), FileError);
}

TEST(CheckFiles, ALineTellsWhatAFileIs) {
    const Folder folder;
    const auto line = [&](const std::string& bytes) {
        put(folder / "a.vtu", bytes);
        const CheckLine said = check_line(folder / "a.vtu");
        EXPECT_EQ(std::ranges::count(said.text, '\n'), 1) << said.text;
        EXPECT_TRUE(said.text.starts_with((folder / "a.vtu").string() + ": ")) << said.text;
        EXPECT_FALSE(said.valid) << said.text;
        return said.text;
    };
    const auto says = [](const std::string& text, const char* words) { return text.find(words) != std::string::npos; };
    EXPECT_TRUE(says(line(""), "is empty"));
    EXPECT_TRUE(says(line("no mesh"), "is not a VTU file"));
    EXPECT_TRUE(says(line(text_of({}).substr(0, 300)), "is truncated"));
    EXPECT_TRUE(says(line(text_of({.points = "nan 0 0  1 0 0  0 1 0  0 0 1"})), "not a finite number"));
    EXPECT_TRUE(says(line(text_of({.connectivity = "0 1 2 9"})), "has vertex 9"));
    EXPECT_TRUE(says(line(text_of({.types = "12"})), "not a linear tet or prism"));
    EXPECT_TRUE(says(line(text_of({.connectivity = "1 0 2 3"})), "invalid: cell 0 at (0.25, 0.25, 0.25) is turned"));
    EXPECT_TRUE(says(line(text_of({.connectivity = "0 0 2 3"})), "invalid: "));
    write_vtu(folder / "b.vtu", cube_of_tets(2));
    const CheckLine good = check_line(folder / "b.vtu");
    EXPECT_TRUE(good.valid);
    EXPECT_TRUE(says(good.text, ": valid, 48 tets, 0 prisms, worst R/r ")) << good.text;
}

TEST(CheckFiles, TheProgramTellsOfSeveralAndSumsUp) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path / "frames");
    write_vtu(folder.path / "frames/0.vtu", cube_of_tets(2));
    write_vtu(folder.path / "frames/1.vtu", cube_of_tets(3));
    Outcome outcome = kropla_program(folder, "check .");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(outcome.out.ends_with("2 of 2 files are valid\n")) << outcome.out;
    EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 3);
    write_vtu(folder.path / "frames/2.vtu", twice(cube_of_tets(2)));
    put(folder.path / "frames/3.vtu", "");
    outcome = kropla_program(folder, "check .");
    EXPECT_EQ(outcome.code, 5);
    EXPECT_TRUE(outcome.out.ends_with("2 of 4 files are valid\n")) << outcome.out;
    outcome = kropla_program(folder, "check frames/0.vtu frames/1.vtu");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(outcome.out.ends_with("2 of 2 files are valid\n")) << outcome.out;
    for (const char* none : {"none", "none.vtu"}) {
        outcome = kropla_program(folder, std::string("check ") + none);
        EXPECT_EQ(outcome.code, 5);
        EXPECT_EQ(outcome.err, std::string("kropla: ") + none + ": cannot be read: no such file or folder\n");
    }
}

TEST(CheckFiles, AFullDiskIsSeen) {
    const TemporaryFolder folder;
    write_vtu(folder.path / "0.vtu", cube_of_tets(2));
    for (const char* files : {"0.vtu", "0.vtu 0.vtu"}) {
        (void)kropla_program(folder, std::string("check ") + files + " >/dev/full 2>full.txt; echo $? >code.txt; true");
        EXPECT_EQ(contents(folder.path / "code.txt"), "5\n");
        EXPECT_NE(contents(folder.path / "full.txt").find("cannot be written"), std::string::npos);
    }
}

TEST(CheckFiles, CellsWithoutVolumeAreNoted) {
    const TemporaryFolder folder;
    put(folder.path / "a.vtu", text_of({.connectivity = "0 1 2  0 1 2 3", .offsets = "3 7", .types = "5 10", .cell_count = 2}));
    const Outcome outcome = kropla_program(folder, "check a.vtu");
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    EXPECT_NE(outcome.out.find("1 cells of surfaces, lines or points are passed over"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace kropla
