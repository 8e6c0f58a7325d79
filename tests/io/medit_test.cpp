#include "mesh_files.h"

#include <kropla/base/error.h>

namespace kropla {
namespace {

const std::string good = "# made by hand\nMeshVersionFormatted 1\nDimension\n3\n# region 7 rotor  of iron\n\nVertices\n5\n"
                         "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 -1 0\n"
                         "Corners 2\n1 2\nTetrahedra\n2\n1 2 3 4 7\n1 3 2 5 8\nTriangles 1\n1 2 3 4\nEdges 1\n1 2 0\n"
                         "RequiredTriangles 1\n1\nEnd\n";

std::string replaced(const std::string& what, const std::string& by) {
    std::string text = good;
    return text.replace(text.find(what), what.size(), by);
}

TEST(Medit, ReadsReferencesAndNames) {
    const FileCells cells = cells_from("a.mesh", good);
    EXPECT_EQ(cells.tets[Tet(1)], (std::array{Vertex(0), Vertex(2), Vertex(1), Vertex(4)}));
    EXPECT_EQ(cells.region, (Array<Tet, Region>{Region(7), Region(8)}));
    EXPECT_EQ(cells.facets, (std::vector{PatchFacet{{Vertex(0), Vertex(1), Vertex(2), Vertex{}}, 4}}));
    EXPECT_EQ(cells.region_names, (Names{{7, "rotor  of iron"}}));
    EXPECT_EQ(cells.passed_over, 1u);
}

TEST(Medit, RefusesInOneLine) {
    EXPECT_EQ(refusal_of("a.mesh", replaced("1 3 2 5 8", "1 3 2 5 -7")),
              "line 19: has cells of 7 and of -7, which would be one region");
    EXPECT_EQ(refusal_of("a.mesh", "solid"),
              "line 1: is no Medit file: those begin with MeshVersionFormatted (binary ones, .meshb, are not read)");
    EXPECT_EQ(refusal_of("a.mesh", replaced("Dimension\n3", "Dimension\n2")), "line 4: is of dimension 2, not 3");
    EXPECT_EQ(refusal_of("a.mesh", replaced("1 0 0 0", "1 0 inf 0")), "line 10: a coordinate is not a finite number");
    EXPECT_EQ(refusal_of("a.mesh", replaced("1 3 2 5 8", "1 3 2 6 8")), "line 19: vertex 6 is not among the 5 before it");
    EXPECT_EQ(refusal_of("a.mesh", replaced("1 3 2 5 8", "1 3 2 0 8")), "line 19: vertex 0 is not among the 5 before it");
    EXPECT_EQ(refusal_of("a.mesh", replaced("Tetrahedra", "TetrahedraP2")),
              "line 17: has TetrahedraP2; only linear tets and prisms are read");
    EXPECT_EQ(refusal_of("a.mesh", replaced("Tetrahedra", "Hexahedra")),
              "line 17: has Hexahedra; only linear tets and prisms are read");
    EXPECT_EQ(refusal_of("a.mesh", replaced("Vertices\n5", "Vertices\n5000000000")),
              "line 8: promises 5000000000 vertices, more than the file can hold");
    EXPECT_EQ(refusal_of("a.mesh", replaced("\nEnd\n", "\n")), "line 25: ends without the word End: it is cut off");
    EXPECT_EQ(refusal_of("a.mesh", replaced("Tetrahedra\n2\n1 2 3 4 7\n1 3 2 5 8\n", "")), "line 22: has no tets");
}

}  // namespace
}  // namespace kropla
