#include "mesh_files.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cstring>

namespace kropla {
namespace {

// Two tets on one triangle, with node tags that are not contiguous:
//
//         50 (0,0,1)          the upper one is of the volume 7, the lower one of 8
//        /|\                  a triangle of the surface 3 between them, one of 4 on the boundary, a line
//      10-20-30
//        \|/
//         40 (0,0,-1)
const std::string nodes_22 = "$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n50 0 0 1\n40 0 0 -1\n$EndNodes\n";

std::string file_22(const std::string& elements, const std::string& names = "") {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + nodes_22 + "$Elements\n" + elements + "$EndElements\n";
}

std::string file_41(const std::string& entities, const std::string& elements, const std::string& names = "") {
    return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names + entities +
           "$Nodes\n2 5 10 50\n2 3 0 3\n10\n20\n30\n0 0 0\n1 0 0\n0 1 0\n"
           "3 7 1 2\n50\n40\n0 0 1 .1 .2 .3\n0 0 -1 .1 .2 .3\n$EndNodes\n$Elements\n" +
           elements + "$EndElements\n";
}

const std::string elements_22 = "5\n1 1 2 5 9 10 20\n2 2 2 3 13 10 20 30\n3 2 2 4 14 10 20 50\n"
                                "4 4 2 7 17 10 20 30 50\n5 4 2 8 18 10 30 20 40\n";
const std::string names = "$PhysicalNames\n3\n1 5 \"an edge\"\n2 4 \"in let\"\n3 8 \"surroundings\"\n$EndPhysicalNames\n";
const std::string entities_41 = "$Entities\n0 1 2 2\n9 0 0 0 1 0 0 1 5 0\n13 0 0 0 1 1 0 1 3 1 9\n14 0 0 0 1 0 1 2 4 6 0\n"
                                "17 0 0 0 1 1 1 1 7 2 13 -14\n18 0 0 -1 1 1 0 1 8 0\n$EndEntities\n";
const std::string elements_41 = "5 5 1 5\n1 9 1 1\n1 10 20\n2 13 2 1\n2 10 20 30\n2 14 2 1\n3 10 20 50\n3 17 4 1\n4 10 20 30 50\n"
                                "3 18 4 1\n5 10 30 20 40\n";

void expect_the_two_tets(const FileCells& cells) {
    const Vertex a(0), b(1), c(2), up(3), down(4);
    EXPECT_EQ(cells.position[down], (Vec3{0, 0, -1}));
    EXPECT_EQ(cells.tets, (Array<Tet, std::array<Vertex, 4>>{{a, b, c, up}, {a, c, b, down}}));
    EXPECT_EQ(cells.passed_over, 1u);
    EXPECT_EQ(cells.facets.size(), 2u);
}

TEST(Msh, ReadsBothVersionsWithGroups) {
    for (const std::string& text : {file_22(elements_22, names), file_41(entities_41, elements_41, names)}) {
        const FileCells cells = cells_from("a.msh", text);
        expect_the_two_tets(cells);
        EXPECT_EQ(cells.region, (Array<Tet, Region>{Region(7), surroundings}));  // by its name
        EXPECT_EQ(patch_numbers(cells), (std::vector{3, 4}));
        EXPECT_EQ(cells.region_names, (Names{{0, "surroundings"}}));
        EXPECT_EQ(cells.patch_names, (Names{{4, "in let"}}));
    }
}

TEST(Msh, EntitiesStandForGroupsWhereThereAreNone) {
    std::string ungrouped = elements_22;
    for (const char* tags : {" 2 3 13 ", " 2 4 14 ", " 2 7 17 ", " 2 8 18 "}) {
        const std::string is = tags;
        ungrouped.replace(ungrouped.find(is), is.size(), " 2 0" + is.substr(4));
    }
    for (const std::string& text : {file_22(ungrouped), file_41("", elements_41)}) {
        const FileCells cells = cells_from("a.msh", text);
        expect_the_two_tets(cells);
        EXPECT_EQ(cells.region, (Array<Tet, Region>{Region(17), Region(18)}));
        EXPECT_EQ(patch_numbers(cells), (std::vector{13, 14}));
    }
}

TEST(Msh, ElementsOfNoGroupAmongOthersHaveNone) {
    std::string text = elements_22;
    text.replace(text.find(" 2 3 13 "), 8, " 2 0 13 ");
    text.replace(text.find(" 2 8 18 "), 8, " 2 0 18 ");
    const FileCells cells = cells_from("a.msh", file_22(text));
    EXPECT_EQ(cells.region, (Array<Tet, Region>{Region(7), surroundings}));
    EXPECT_EQ(patch_numbers(cells), std::vector{4});
    EXPECT_EQ(cells.passed_over, 2u);
}

TEST(Msh, AnElementOfSeveralGroupsIsOfTheFirst) {
    const std::string twice = "4\n1 2 2 3 13 10 20 30\n2 4 2 1 17 10 20 30 50\n3 4 2 2 17 10 20 30 50\n4 4 2 2 18 10 30 20 40\n";
    EXPECT_EQ(cells_from("a.msh", file_22(twice)).region, (Array<Tet, Region>{Region(1), Region(2)}));
}

TEST(Msh, CellsComeInTheOrderOfTheirTags) {
    const std::string swapped = "2\n9 4 2 1 1 10 20 30 50\n3 4 2 2 2 10 30 20 40\n";
    EXPECT_EQ(cells_from("a.msh", file_22(swapped)).region, (Array<Tet, Region>{Region(2), Region(1)}));
}

/// Appends the bytes of a number, this machine's or reversed.
template <class T>
void append(std::string& bytes, T value, bool reversed) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    if (reversed) std::ranges::reverse(raw);
    bytes.append(raw.data(), raw.size());
}

std::string binary_22(bool reversed) {
    std::string f = "$MeshFormat\n2.2 1 8\n";
    const auto ints = [&](std::initializer_list<int> values) {
        for (const int i : values) append(f, i, reversed);
    };
    ints({1});
    f += "\n$EndMeshFormat\n$Nodes\n5\n";
    int tag = 0;
    for (const Vec3& x : {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}}) {
        ints({++tag});
        for (int axis = 0; axis < 3; ++axis) append(f, x[axis], reversed);
    }
    f += "\n$EndNodes\n$Elements\n5\n";
    ints({1, 1, 2, 1, 5, 9, 1, 2});
    ints({2, 2, 2, 2, 3, 13, 1, 2, 3, 3, 4, 14, 1, 2, 4});
    ints({4, 2, 2, 4, 7, 17, 1, 2, 3, 4, 5, 8, 18, 1, 3, 2, 5});
    return f + "\n$EndElements\n";
}

std::string binary_41(bool reversed) {
    std::string f = "$MeshFormat\n4.1 1 8\n";
    const auto ints = [&](std::initializer_list<int> values) {
        for (const int i : values) append(f, i, reversed);
    };
    const auto sizes = [&](std::initializer_list<std::uint64_t> values) {
        for (const std::uint64_t i : values) append(f, i, reversed);
    };
    const auto numbers = [&](std::initializer_list<double> values) {
        for (const double x : values) append(f, x, reversed);
    };
    const auto entity = [&](int number, int group) {
        ints({number});
        numbers({0, 0, 0, 1, 1, 1});
        sizes({1});
        ints({group});
        sizes({0});
    };
    ints({1});
    f += "\n$EndMeshFormat\n$Entities\n";
    sizes({0, 1, 2, 2});
    for (const auto& [number, group] : {std::pair(9, 5), {13, 3}, {14, 4}, {17, 7}, {18, 8}}) entity(number, group);
    f += "\n$EndEntities\n$Nodes\n";
    sizes({1, 5, 1, 5});
    ints({3, 17, 0});
    sizes({5, 1, 2, 3, 4, 5});
    numbers({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1});
    f += "\n$EndNodes\n$Elements\n";
    sizes({5, 5, 1, 5});
    ints({1, 9, 1}), sizes({1, 1, 1, 2});
    ints({2, 13, 2}), sizes({1, 2, 1, 2, 3});
    ints({2, 14, 2}), sizes({1, 3, 1, 2, 4});
    ints({3, 17, 4}), sizes({1, 4, 1, 2, 3, 4});
    ints({3, 18, 4}), sizes({1, 5, 1, 3, 2, 5});
    return f + "\n$EndElements\n";
}

TEST(Msh, ReadsBinaryFilesOfEitherOrder) {
    for (const bool reversed : {false, true})
        for (const std::string& bytes : {binary_22(reversed), binary_41(reversed)}) {
            const FileCells cells = cells_from("a.msh", bytes);
            expect_the_two_tets(cells);
            EXPECT_EQ(cells.region, (Array<Tet, Region>{Region(7), Region(8)}));
            EXPECT_EQ(patch_numbers(cells), (std::vector{3, 4}));
        }
}

TEST(Msh, BinaryFilesCutAnywhereAreRefused) {
    for (const std::string& bytes : {binary_22(false), binary_41(false)})
        for (std::size_t length = 0; length + 12 < bytes.size(); length += 7)
            EXPECT_NE(refusal_of("a.msh", bytes.substr(0, length)), "") << length;
    EXPECT_EQ(refusal_of("a.msh", binary_41(false).substr(0, 700)).find("byte "), 0u);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST(Msh, RefusesInOneLine) {
    const std::string good = file_22(elements_22);
    EXPECT_EQ(refusal_of("a.msh", "solid"), "line 1: is no MSH file of Gmsh: those begin with $MeshFormat");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "2.2", "4.0")), "line 2: is of MSH version 4.0; 2.2 and 4.1 are read");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "1 0 0", "1 0 nan")), "line 7: a coordinate is not a finite number");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "1 0 0", "1 0 1e400")), "line 7: a coordinate is not a finite number");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "1 0 0", "1 0 O")), "line 7: a coordinate is no number of its kind: \"O\"");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "20 1 0 0", "10 1 0 0")), "line 7: node 10 is there twice");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "10 20 30 50", "10 20 30 60")),
              "line 17: node 60 of an element is not in the file");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "5\n10", "500\n10")), "line 5: promises 500 nodes, more than the file can hold");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "5\n10", "6\n10")), "line 11: the number of a node is no number of its kind: \"$EndNodes\"");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "4 4 2", "4 11 2")),
              "line 17: has second-order tetrahedra; only linear tets and prisms, and their facets, are read (Gmsh: SetOrder 1)");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "4 4 2", "4 5 2")),
              "line 17: has hexahedra; only linear tets and prisms, and their facets, are read");
    EXPECT_EQ(refusal_of("a.msh", replaced(good, "4 4 2", "4 99 2")),
              "line 17: has elements of type 99; only linear tets and prisms, and their facets, are read");
    EXPECT_EQ(refusal_of("a.msh", file_22("1\n1 2 2 3 13 10 20 30\n")), "line 15: has no tets");
    EXPECT_EQ(refusal_of("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PartitionedEntities\n"),
              "line 4: is a mesh in parts (partitioned); save it as one");
}

TEST(Msh, UnknownSectionsArePassedOver) {
    const std::string text = file_22(elements_22) + "$NodeData\n1\n\"a view\"\n$EndNodeData\n";
    expect_the_two_tets(cells_from("a.msh", text));
}

}  // namespace
}  // namespace kropla
