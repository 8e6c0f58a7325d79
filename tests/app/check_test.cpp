#include "app/check.h"

#include "../io/examples.h"
#include "../io/layered.h"
#include "app/distribution.h"
#include "app/hanging.h"
#include <kropla/step/initial_mesh.h>
#include "app/shell_jump.h"
#include <kropla/base/error.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace kropla {
namespace {

CheckReport check(const Mesh& mesh) {
    const Folder folder;
    write_vtu(folder / "a.vtu", mesh);
    return check_file(folder / "a.vtu");
}

bool says(const CheckReport& report, const std::string& words) {
    // Lines are wrapped: a break counts as one blank.
    std::string text;
    std::istringstream stream(report.text);
    for (std::string word; stream >> word;) text += word + " ";
    return text.find(words) != std::string::npos;
}

struct Hung {
    Mesh mesh;
    Vertex vertex;  // hangs
    Tet cell;       // on a facet of this
};
/// A cube of tets in which, on one side only of a facet amid the mesh, the cell is split into three around a
/// new vertex m in the middle of the facet:
///
///          d
///         /|\          From above, the facet (a, b, c) belongs to one cell; from below to three, around m.
///        a-+-c
///         \m/ b
///          e
Hung mesh_with_hanging_vertex() {
    const Mesh cube = cube_of_tets(6);
    const auto amid = [&](Vertex v) { return distance(cube.position[v], Vec3{3e-3, 3e-3, 3e-3}) < 1.9e-3; };
    for (const Tet t : cube.tets.indices()) {
        if (!std::ranges::all_of(cube.tets[t], amid)) continue;
        const auto [d, a, b, c] = cube.tets[t];
        auto position = cube.position;
        auto tets = cube.tets;
        auto region = cube.region;
        const Vertex m = position.push_back((position[a] + position[b] + position[c]) / 3);
        tets[t] = {d, m, b, c};
        for (const auto& part : {std::array{d, a, m, c}, std::array{d, a, b, m}}) {
            tets.push_back(part);
            region.push_back(Region(1));
        }
        return {make_mesh(std::move(position), std::move(tets), std::move(region)), m, cube.neighbour[t][0]};
    }
    throw std::logic_error("no cell amid the mesh");
}

TEST(Check, AGoodMeshIsValid) {
    const CheckReport report = check(cube_of_tets(5));
    EXPECT_TRUE(report.valid);
    EXPECT_TRUE(says(report, "a.vtu: valid vertices 216 tets 750 prisms 0 boundary facets 300 regions 2 "));
    EXPECT_TRUE(says(report, "0 588 0 ")) << report.text;
    EXPECT_TRUE(says(report, "1 162 0 "));
    EXPECT_TRUE(says(report, "all 750 0 1.250000000000e-07"));
    EXPECT_TRUE(says(report, "worst cell: "));
}

TEST(Check, PrismsAreCountedAndEveryLayerIsSummedUp) {
    const Mesh mesh = layered_cube(4, {3, 2});
    const CheckReport report = check(mesh);
    SCOPED_TRACE(report.text);
    EXPECT_TRUE(says(report, "tets 384 prisms 240 boundary facets 192 regions 2 "));
    EXPECT_TRUE(says(report, "0 336 144 "));
    EXPECT_TRUE(says(report, "1 48 96 "));
    EXPECT_TRUE(says(report, "all 384 240 6.400000000000e-08"));
    for (const Layer l : {Layer(0), Layer(1)}) {
        const LayerSummary s = summarise_layer(mesh, l);
        EXPECT_TRUE(says(report, fmt::format("1 {} {} {} {:.4f} {:.4g} - {:.4g} 1.300 - 1.300 {:.4g} - {:.4g} ",
                                             l.value, 3 - l.value, s.prisms, s.min_jacobian, s.min_first_height * 1e6,
                                             s.max_first_height * 1e6, s.min_thickness * 1e6,
                                             s.max_thickness * 1e6)));
    }
}

TEST(Check, FirstTetsAreMeasuredAgainstTheLastPrisms) {
    const Mesh mesh = layered_cube(4, {3, 2});
    const CheckReport report = check(mesh);
    for (const Layer l : {Layer(0), Layer(1)}) {
        const PrismLayer& layer = layer_of(mesh, l);
        const std::vector<double> jumps = shell_jumps(mesh, l);
        ASSERT_EQ(jumps.size(), layer.triangles.size());
        EXPECT_TRUE(std::ranges::is_sorted(jumps));
        // The product over the shell is the tets' volumes by the prisms', however they are paired.
        double product = 0, volumes = 0;
        for (double jump : jumps) product += 3 * std::log(jump);
        for (int triangle = 0; triangle < static_cast<int>(layer.triangles.size()); ++triangle)
            volumes -= std::log(prism_volume(prism_corners(mesh, {l, triangle, layer.count - 1})));
        for (Tet t : mesh.tets.indices())
            for (Patch patch : mesh.patch[t])
                if (patch == shell_patch(l)) volumes += std::log(volume(mesh, t));
        EXPECT_NEAR(product, volumes, 1e-9);
        EXPECT_TRUE(says(report, fmt::format("1 {} {:.3f} {:.3f} ", l.value, jumps[jumps.size() / 2], jumps.back())))
            << report.text;
    }
}

// Also where the layer ends in thin prisms: the walls are finer there.
TEST(Check, FirstTetsAreAtMostTwiceAsLargeAsTheLastPrisms) {
    for (const double first_height : {4e-5, 2e-5, 5e-6}) {
        Domain domain;
        domain.box = {{-0.002, -0.002, -0.002}, {0.002, 0.002, 0.002}};
        domain.bodies = {{.name = "drop", .shape = {{}, {1e-3, 7e-4, 7e-4}, {}}}};
        domain.bodies[0].layer = {.first_height = first_height};
        EXPECT_LT(shell_jumps(initial_mesh(domain), Layer(0)).back(), 2) << first_height;
    }
}

TEST(Check, PrismsThatAreNoStacksAreInvalidNotUnreadable) {
    const Folder folder;
    const std::string layer = "<DataArray type=\"Int32\" Name=\"layer\" format=\"ascii\">0 2</DataArray>";
    put(folder / "a.vtu", text_of({.points = "0 0 0  1 0 0  0 1 0  0 0 1  0 0 -1  1 0 -1  0 1 -1",
                                   .point_count = 7,
                                   .connectivity = "0 1 2 3  4 6 5 0 2 1",
                                   .offsets = "4 10",
                                   .types = "10 13",
                                   .cell_count = 2,
                                   .cell_arrays = layer}));
    const CheckReport report = check_file(folder / "a.vtu");
    EXPECT_FALSE(report.valid);
    EXPECT_TRUE(says(report, ": invalid of 1 prisms only 0 stand in stacks on a wall vertices 7 tets 1 prisms 1 "))
        << report.text;
}

TEST(Check, KeepsToEightyColumns) {
    Mesh inverted = cube_of_tets(4);
    std::swap(inverted.tets[Tet(100)][0], inverted.tets[Tet(100)][1]);
    for (const Mesh& mesh : {inverted, layered_cube(4, {3, 2})}) {
        std::istringstream lines(check(mesh).text);
        std::string line;
        std::getline(lines, line);  // the file's name has any length
        while (std::getline(lines, line)) {
            EXPECT_LE(line.size(), 80u) << line;
            EXPECT_FALSE(line.ends_with(' ')) << line;
        }
    }
}

TEST(Check, AnInvertedCellIsNamedWithItsPlace) {
    Mesh mesh = cube_of_tets(3);
    std::swap(mesh.tets[Tet(77)][0], mesh.tets[Tet(77)][1]);
    const CheckReport report = check(mesh);
    EXPECT_FALSE(report.valid);
    const Vec3 at = centroid(mesh, Tet(77));
    const std::string cell = fmt::format("77 at ({:.6g}, {:.6g}, {:.6g})", at.x, at.y, at.z);
    EXPECT_TRUE(says(report, ": invalid cell " + cell + " is turned inside out")) << report.text;
    EXPECT_TRUE(says(report, "worst cell: " + cell + ", region 0, R/r inf")) << report.text;
}

TEST(Check, AHangingVertexIsFound) {
    const Hung hung = mesh_with_hanging_vertex();
    ASSERT_EQ(verify(hung.mesh), "");  // as a mesh with a flat void inside it is in order
    const auto hanging = hanging_vertex(hung.mesh);
    ASSERT_TRUE(hanging);
    EXPECT_EQ(hanging->vertex, hung.vertex);
    EXPECT_EQ(hanging->facet.tet, hung.cell);
    const CheckReport report = check(hung.mesh);
    EXPECT_FALSE(report.valid);
    EXPECT_TRUE(says(report, ": invalid cell " + std::to_string(hung.cell.value) + " at (")) << report.text;
    EXPECT_TRUE(says(report, ": vertex " + std::to_string(hung.vertex.value) + " at (")) << report.text;
    EXPECT_TRUE(says(report, "lies in its facet")) << report.text;
}

TEST(Check, AHoleIsNoHangingVertex) {
    const Mesh cube = cube_of_tets(4);
    Array<Tet, std::array<Vertex, 4>> tets;
    for (const Tet t : cube.tets.indices())
        if (cube.region[t] == surroundings) tets.push_back(cube.tets[t]);
    const std::size_t count = tets.size();
    const Mesh holed = make_mesh(cube.position, std::move(tets), Array<Tet, Region>(count, surroundings));
    EXPECT_FALSE(hanging_vertex(holed));
    EXPECT_TRUE(check(holed).valid);
}

TEST(Check, AFacetOfThreeCellsIsInvalidNotUnreadable) {
    const Folder folder;
    put(folder / "a.vtu", text_of({.points = "0 0 0  1 0 0  0 1 0  0 0 1  0 0 -1  1 1 1",
                                   .point_count = 6,
                                   .connectivity = "0 1 2 3  0 2 1 4  0 1 2 5",
                                   .offsets = "4 8 12",
                                   .types = "10 10 10",
                                   .cell_count = 3,
                                   .cell_arrays = ""}));
    const CheckReport report = check_file(folder / "a.vtu");
    EXPECT_FALSE(report.valid);
    EXPECT_TRUE(says(report, ": invalid a facet of cell 2 already belongs to cells 0 and 1")) << report.text;
}

TEST(Check, ThrowsWhereThereIsNoMesh) { EXPECT_THROW((void)check_file("/no/such/file.vtu"), FileError); }

TEST(Check, DistributionOfKnownValues) {
    std::vector<double> values(1001);
    std::iota(values.rbegin(), values.rend(), 0.0);
    const Distribution d = distribution(values);
    EXPECT_EQ(d.count, 1001u);
    EXPECT_EQ(d.min, 0);
    EXPECT_EQ(d.mean, 500);
    EXPECT_EQ(d.median, 500);
    EXPECT_EQ(d.p99, 990);
    EXPECT_EQ(d.p999, 999);
    EXPECT_EQ(d.max, 1000);
    EXPECT_EQ(distribution({}).count, 0u);
}

TEST(Check, HistogramCountsEveryValueOnce) {
    const double infinity = std::numeric_limits<double>::infinity();
    const auto lines =
        histogram(std::vector{-1.0, 3.0, 3.5, 4.0, 9.0, infinity}, std::vector{3.0, 4.0, 5.0, infinity});
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "   3 -   4         3 #################");
    EXPECT_EQ(lines[1], "   4 -   5         1 ######");
    EXPECT_EQ(lines[2], "   5 - inf         2 ############");
}

}  // namespace
}  // namespace kropla
