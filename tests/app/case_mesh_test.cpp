// [domain] mesh: meshes that are brought.
#include "../io/mesh_files.h"
#include "case/case.h"
#include "app/commands.h"
#include "app/first_mesh.h"
#include "case/mesh_size.h"
#include <kropla/adapt/moving_mesh.h>
#include <kropla/base/error.h>
#include <kropla/domain/words.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/stuck.h>
#include "program.h"

#include <fmt/format.h>

namespace kropla {
namespace {

constexpr std::string_view case_text = R"toml([domain]
mesh = "a.msh"
[[body]]
name = "rotor"
shape = "region"
region = "the rotor, hot"
[body.motion]
x = "0.05*t"
[time]
end = 0.01
steps = 2
)toml";

std::string replaced(std::string_view from, std::string_view to) {
    std::string text(case_text);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

/// The case with heat, and this at faces.
std::string heated(const std::string& faces) {
    std::string text(case_text);
    for (const char* region : {"surroundings", "rotor"})
        text += fmt::format("[heat.region.{}]\nconductivity = 1\ndensity = 1\nspecific_heat = 1\ninitial = 300\n", region);
    return text + "[heat.face]\n" + faces;
}

/// The case in a folder with its mesh.
class CaseMeshTest : public testing::Test {
protected:
    CaseMeshTest() { write_mesh_file(folder / "a.msh", named_cube(6)); }
    [[nodiscard]] Case read(std::string_view text) const { return parse_case(text, (folder / "case.toml").string()); }
    /// Without the folder's name.
    [[nodiscard]] std::string refusal(std::string_view text) const {
        std::string message = message_of<CaseError>([&] { (void)read(text); });
        const std::string path = folder.path().string() + "/";
        for (std::size_t at; (at = message.find(path)) != std::string::npos;) message.erase(at, path.size());
        return message;
    }
    Folder folder;
};

TEST_F(CaseMeshTest, BodiesAreRegionsByNameOrNumber) {
    for (const std::string& text : {std::string(case_text), replaced("\"the rotor, hot\"", "1")}) {
        const Case given = read(text);
        ASSERT_TRUE(given.mesh);
        EXPECT_EQ(given.domain.box.min, (Vec3{0, 0, 0}));
        EXPECT_EQ(given.domain.box.max, (Vec3{6e-3, 6e-3, 6e-3}));
        EXPECT_EQ(given.domain.walls, nullptr);
        EXPECT_NEAR(volume(given.domain.bodies[0].shape), region_volume(*given.mesh->mesh, Region(1)), 1e-22);
        EXPECT_EQ(verify(*given.mesh->mesh), "");
        EXPECT_EQ(to_toml(read(to_toml(given))), to_toml(given));
    }
}

TEST_F(CaseMeshTest, OtherRegionsAreTheSurroundings) {
    FileCells cells = named_cube(6);
    for (const Tet t : cells.region.indices())
        cells.region[t] = Region(cells.region[t] == surroundings ? 7 + t.value % 2 : 3);
    cells.region_names = {{3, "the rotor, hot"}};
    write_mesh_file(folder / "a.msh", cells);
    const Case given = read(case_text);
    EXPECT_EQ(region_numbers(cells_of(*given.mesh->mesh)), (std::vector{0, 1}));
}

TEST_F(CaseMeshTest, PlanesAreFoundAlsoIfRounded) {
    FileCells cells = named_cube(6);
    for (Vec3& x : cells.position)
        if (x.z == 6e-3) x.z += 1e-18 * std::sin(1e6 * x.x);
    write_mesh_file(folder / "a.msh", cells);
    const Case given = read(case_text);
    EXPECT_EQ(given.domain.walls, nullptr);
    EXPECT_EQ(patch_numbers(cells_of(*given.mesh->mesh)), (std::vector{1, 2, 3, 4, 5, 6}));
}

TEST_F(CaseMeshTest, WhatIsInNoFaceStaysAsItIs) {
    FileCells cells = named_cube(6);
    for (const Vertex v : cells.position.indices()) {
        Vec3& x = cells.position[v];
        x.x *= 1 + 20 * x.z;  // the faces across x lean
    }
    write_mesh_file(folder / "a.msh", cells);
    const Case given = read(case_text);
    ASSERT_NE(given.domain.walls, nullptr);
    EXPECT_EQ(patch_numbers(cells_of(*given.mesh->mesh)), (std::vector{1, 3, 4, 5, 6, 7}));  // x min is still a plane
    EXPECT_EQ(refusal(heated("x_max = { value = 400 }\n")),
              "case.toml: heat.face.x_max (line 23): is a face of the box that holds the mesh; nothing of the mesh is in it");
    EXPECT_NO_THROW((void)read(heated("x_max = \"insulated\"\nx_min = { value = 400 }\n")));
    Domain domain = given.domain;
    MovingMesh moving(domain, first_mesh(given, nullptr), 0);  // throws if they do not fit
}

TEST_F(CaseMeshTest, SizesAreTheMeshesOwnUnlessGiven) {
    const Case own = read(case_text);
    EXPECT_NEAR(own.domain.size.surface, 1e-3, 0.5e-3);
    EXPECT_GE(own.domain.size.far, own.domain.size.surface);
    EXPECT_LE(own.domain.size.growth, steepest_growth);
    const Case given = read(std::string(case_text) + "[size]\nfar = 5e-3\n");
    EXPECT_EQ(given.domain.size.far, 5e-3);
    EXPECT_EQ(given.domain.size.surface, own.domain.size.surface);
    EXPECT_EQ(refusal(std::string(case_text) + "[size]\nfar = 5e-5\n").substr(0, 60),
              "case.toml: size.far (line 13): must be at least surface = 0.");
}

TEST_F(CaseMeshTest, RefusesInOneLine) {
    EXPECT_EQ(refusal(replaced("\"a.msh\"", "\"b.msh\"")),
              "case.toml: domain.mesh (line 2): b.msh: cannot be read: No such file or directory");
    EXPECT_EQ(refusal(replaced("\"a.msh\"", "\"a.stl\"")).substr(0, 66),
              "case.toml: domain.mesh (line 2): a.stl: is of no format that is kn");
    EXPECT_EQ(refusal(replaced("[[body]]", "min = [0, 0, 0]\n[[body]]")),
              "case.toml: domain.min (line 3): stands beside mesh, whose box is its own");
    EXPECT_EQ(refusal(replaced("\"the rotor, hot\"", "\"rotor\"")),
              "case.toml: body[0].region (line 6): must be one of the mesh's regions: 0 (\"surroundings\"), 1 (\"the rotor, hot\"), "
              "got \"rotor\"");
    EXPECT_EQ(refusal(replaced("\"the rotor, hot\"", "2")),
              "case.toml: body[0].region (line 6): must be one of the mesh's regions: 0 (\"surroundings\"), 1 (\"the rotor, hot\"), got 2");
    EXPECT_EQ(refusal(replaced("region = \"the rotor, hot\"\n", "")),
              "case.toml: body[0].region (line 3): is missing; it must be one of the mesh's regions: 0 (\"surroundings\"), "
              "1 (\"the rotor, hot\")");
    EXPECT_EQ(refusal(replaced("shape = \"region\"", "shape = \"sphere\"")),
              "case.toml: body[0].shape (line 5): must be \"region\" where domain.mesh brings the mesh, got \"sphere\"");
    EXPECT_EQ(refusal(replaced("mesh = \"a.msh\"", "min = [0, 0, 0]\nmax = [1, 1, 1]")),
              "case.toml: body[0].shape (line 6): \"region\" is one of a mesh that domain.mesh names; there is none");
    EXPECT_EQ(refusal(replaced("[time]", "[[body]]\nname = \"b\"\nshape = \"region\"\nregion = 1\n[time]")),
              "case.toml: body[1].region (line 12): is that of body[0] already");
    EXPECT_EQ(refusal(replaced("region = \"the rotor, hot\"", "region = 0")).substr(0, 74),
              "case.toml: domain.mesh (line 2): a.msh: body \"rotor\": it reaches the bound");
}

TEST_F(CaseMeshTest, BodiesThatTouchAreRefusedWithThePlace) {
    FileCells cells = named_cube(6);
    const auto middle = [&](Tet t) {
        const auto& v = cells.tets[t];
        return (cells.position[v[0]] + cells.position[v[1]] + cells.position[v[2]] + cells.position[v[3]]) / 4;
    };
    for (const Tet t : cells.region.indices())
        if (cells.region[t] != surroundings && middle(t).x > 3e-3) cells.region[t] = Region(2);
    write_mesh_file(folder / "a.msh", cells);
    const std::string message = refusal(replaced("[time]", "[[body]]\nname = \"b\"\nshape = \"region\"\nregion = 2\n[time]"));
    EXPECT_TRUE(message.starts_with("case.toml: domain.mesh (line 2): a.msh: body \"rotor\" touches body \"b\" at (0.003")) << message;
    EXPECT_TRUE(message.ends_with(") m; bodies are to be apart from each other and from the boundary")) << message;
}

TEST_F(CaseMeshTest, ABodyThatTouchesTheBoundaryIsRefusedWithThePlace) {
    FileCells cells = named_cube(6);
    const Mesh mesh = make_mesh(cells.position, cells.tets, cells.region);
    std::vector<Vertex> there;  // of a cell that has one vertex at the boundary, which joins the body
    for (const Tet t : cells.region.indices()) {
        there.clear();
        for (Vertex v : cells.tets[t])
            if (constraint(mesh, v, ball(mesh, v)).patches != 0) there.push_back(v);
        if (there.size() != 1) continue;
        cells.region[t] = Region(1);
        break;
    }
    ASSERT_EQ(there.size(), 1u);
    write_mesh_file(folder / "a.msh", cells);
    EXPECT_EQ(refusal(case_text), "case.toml: domain.mesh (line 2): a.msh: body \"rotor\" touches the boundary at " +
                                      place_words(cells.position[there[0]]) +
                                      "; bodies are to be apart from each other and from the boundary");
}

TEST_F(CaseMeshTest, FacesMayBeCalledByTheNamesOfPatches) {
    const auto& with = heated;
    const std::string by_key = to_toml(read(with("x_min = { value = 400 }\n")));
    EXPECT_EQ(to_toml(read(with("inlet = { value = 400 }\n"))), by_key);
    EXPECT_EQ(refusal(with("inlet = { valu = 400 }\n")),
              "case.toml: heat.face.x_min.valu (line 23): unknown key; did you mean \"value\"?");
    EXPECT_EQ(refusal(with("skin = { value = 400 }\n")),
              "case.toml: heat.face.skin (line 23): is a patch that is no face of the box as a whole; conditions are known at those "
              "only: x_min, x_max, y_min, y_max, z_min, z_max");
    EXPECT_EQ(refusal(with("x_min = \"insulated\"\ninlet = { value = 400 }\n")),
              "case.toml: heat.face.inlet (line 24): is x_min, which stands there too");
    EXPECT_EQ(refusal(with("inlett = { value = 400 }\n")),
              "case.toml: heat.face.inlett (line 23): unknown key; did you mean \"inlet\"?");
    FileCells cells = named_cube(6);
    for (auto& [number, name] : cells.patch_names)
        if (name == "inlet") name = "x_max";  // which it is not
    write_mesh_file(folder / "a.msh", cells);
    EXPECT_EQ(refusal(with("x_max = { value = 400 }\n")),
              "case.toml: heat.face.x_max (line 23): is a face of the box, and the mesh has a patch of that name elsewhere: that is to "
              "have another name");
}

TEST_F(CaseMeshTest, PrismsAndOverlapsAreRefused) {
    write_mesh_file(folder / "a.msh", cells_of(layered_cube(4), {{1, "the rotor, hot"}}));
    EXPECT_NE(refusal(case_text).find("a.msh: has "), std::string::npos);
    EXPECT_NE(refusal(case_text).find(" prisms; a mesh that moves is of tets alone"), std::string::npos);
    FileCells cells = named_cube(4);
    for (const Vertex v : cells.position.indices())
        if (distance(cells.position[v], {2e-3, 2e-3, 2e-3}) < 0.5e-3) cells.position[v] = {3.6e-3, 2e-3, 2e-3};
    write_mesh_file(folder / "a.msh", cells);
    EXPECT_NE(refusal(case_text).find("on one side of the facet between them"), std::string::npos) << refusal(case_text);
}

TEST_F(CaseMeshTest, WhatCannotBeImprovedIsSaid) {
    FileCells cells = named_cube(6);
    for (Vec3& x : cells.position)
        if (x.z > 1.5e-3 && x.z < 4.5e-3) x.z = 3e-3 + 0.01 * (x.z - 3e-3);  // the body is as good as flat
    write_mesh_file(folder / "a.msh", cells);
    const std::string message = message_of<StuckError>([&] { (void)first_mesh(read(case_text), nullptr); });
    EXPECT_NE(message.find("a.msh: a cell at ("), std::string::npos) << message;
    EXPECT_NE(message.find("cannot be improved with the surfaces kept as they are"), std::string::npos);
}

TEST(RunInAMesh, GoesOnWhereItWasStopped) {
    const TemporaryFolder folder;
    write_mesh_file(folder.path / "a.msh", named_cube(6));
    const auto put_case = [&](const char* name, double end, int steps) {
        put(folder.path / name, replaced("end = 0.01\nsteps = 2", fmt::format("end = {}\nsteps = {}", end, steps)));
    };
    put_case("half.toml", 0.005, 1);
    put_case("whole.toml", 0.01, 2);
    ASSERT_EQ(kropla_program(folder, "run half.toml --out d").code, 0);
    const Outcome resumed = kropla_program(folder, "run whole.toml --out d --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    ASSERT_EQ(kropla_program(folder, "run whole.toml --out e").code, 0);
    EXPECT_EQ(contents(folder.path / "d/frames/00002.vtu"), contents(folder.path / "e/frames/00002.vtu"));
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
    EXPECT_EQ(kropla_program(folder, "mesh whole.toml -o m.mesh").code, 0);
    EXPECT_EQ(read_mesh_file(folder.path / "m.mesh").region_names, (Names{{0, "surroundings"}, {1, "rotor"}}));
}

TEST(RunInAMesh, DoesNotGoOnInAnother) {
    const TemporaryFolder folder;
    write_mesh_file(folder.path / "a.msh", named_cube(6));
    put(folder.path / "a.toml", replaced("end = 0.01\nsteps = 2", "end = 0.005\nsteps = 1"));
    put(folder.path / "b.toml", replaced("end = 0.01\nsteps = 2", "end = 0.01\nsteps = 2"));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    write_mesh_file(folder.path / "a.msh", named_cube(7));
    const Outcome resumed = kropla_program(folder, "run b.toml --out d --resume");
    EXPECT_EQ(resumed.code, 2);
    EXPECT_NE(resumed.err.find("b.toml: domain.mesh: "), std::string::npos) << resumed.err;
    EXPECT_NE(resumed.err.find("a.msh is not the file that the run in d was begun with; with that it goes on, or begins anew with "
                               "--force\n"), std::string::npos) << resumed.err;
}

TEST(SizeOfAMesh, OneOfARegularGridIsItsEdge) {
    Mesh mesh = cube_of_tets(8);
    Domain domain;
    domain.box = {{0, 0, 0}, {8e-3, 8e-3, 8e-3}};
    const SizeField none = size_of_mesh(cube_of_tets(2), domain);
    EXPECT_NEAR(none.far, 2e-3, 0.3e-3);  // the diagonal of a small cube, more or less
    EXPECT_EQ(none.surface, none.far);
}

}  // namespace
}  // namespace kropla
