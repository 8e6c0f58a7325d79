// Bodies whose surface is in a file beside the case.
#include "case/case.h"
#include "case/case_text.h"
#include "app/temporary_folder.h"
#include "domain/triangulated_surface.h"

#include <gtest/gtest.h>

#include <fstream>

namespace kropla {
namespace {

const std::string cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";

std::string case_with(const std::string& body) {
    return "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[[body]]\nname = \"cube\"\nshape = \"surface\"\n" + body +
           "\n[size]\nsurface = 0.05\nfar = 0.2\n[time]\nend = 1\nsteps = 2\n";
}

class CaseSurface : public testing::Test {
protected:
    void put(const char* name, const std::string& text) const { std::ofstream(folder_.path / name) << text; }
    [[nodiscard]] Case read(const std::string& body) const {
        return parse_case(case_with(body), (folder_.path / "case.toml").string());
    }
    [[nodiscard]] std::string refusal(const std::string& body) const {
        try {
            (void)read(body);
        } catch (const CaseError& error) {
            return error.what();
        }
        return "";
    }
    TemporaryFolder folder_;
};

}  // namespace

TEST_F(CaseSurface, IsReadScaledTurnedAndPut) {
    put("cube.obj", cube + "f 4 1 5 8\n");
    const Case given = read("file = \"cube.obj\"\nscale = 0.2\ncentre = [0.3, 0.4, 0.5]\nrotation = [0, 0, 1, 90]\nsize = 0.03");
    const Body& body = given.domain.bodies[0];
    EXPECT_NEAR(volume(body.shape), 0.008, 1e-15);
    EXPECT_NEAR(signed_distance(body.shape, {0.2, 0.5, 0.6}), -0.1, 1e-12);  // the middle: x turned to y, y to -x
    EXPECT_EQ(body.size, 0.03);
    EXPECT_EQ(asked_size(given.domain, 0), 0.03);
    const std::string written = to_toml(given);
    const Case again = parse_case(written, "elsewhere/case.toml");
    EXPECT_EQ(to_toml(again), written);
    EXPECT_EQ(again.domain.bodies[0].shape.centre, body.shape.centre);
}

// The predicates are exact for what does not underflow: the mesher went round and round.
TEST_F(CaseSurface, WhatIsNextToNothingIsNothing) {
    const std::string nearly = replaced(replaced(cube, "v 1 0 0", "v 1 1e-320 0"), "v 0 1 1", "v -1e-31 1 1");
    put("cube.obj", nearly + "f 4 1 5 8\n");
    const Case given = read("file = \"cube.obj\"\nscale = 0.5\ncentre = [0.3, 0.4, 0.5]");
    for (const Vec3& x : given.domain.bodies[0].shape.surface->points())
        for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(x[axis] == 0 || x[axis] == 0.5) << x[axis];
}

TEST_F(CaseSurface, IsCutByAFace) {
    put("cube.obj", cube + "f 4 1 5 8\n");
    const std::string body = "file = \"cube.obj\"\nscale = 0.4\ncentre = [0.8, 0.3, 0.2]\n";
    const Case given = read(body + "cut = true");
    EXPECT_EQ(reached_faces(given.domain.bodies[0].shape), 0b10u);  // x max
    EXPECT_NEAR(volume(given.domain.bodies[0].shape), 0.2 * 0.4 * 0.4, 1e-15);
    EXPECT_LT(distance(given.domain.bodies[0].shape.centre, {0.9, 0.5, 0.4}), 1e-15);
    const std::string written = to_toml(given);
    EXPECT_NE(written.find("cut = true"), std::string::npos);
    EXPECT_EQ(to_toml(parse_case(written, "elsewhere/case.toml")), written);
    EXPECT_EQ(reached_faces(read(body).domain.bodies[0].shape), 0u);
    const std::string in_face = "file = \"cube.obj\"\nscale = 0.4\ncentre = [0.8, 0.3, 0]\ncut = true";
    const std::string told = refusal(in_face);
    EXPECT_NE(told.find("case.toml: body[0].cut (line 10): a part of its surface lies in the wall z min, at (0.8, 0.7, 0) m; "
                        "it is to end before, or to reach through"), std::string::npos) << told;
}

TEST_F(CaseSurface, FaultsOfTheFileAreToldWithPlaceAndCount) {
    put("open.obj", cube);
    const std::string told = refusal("file = \"open.obj\"\nscale = 0.1\ncentre = [0.5, 0.5, 0.5]");
    EXPECT_NE(told.find("case.toml: body[0].file (line 7): "), std::string::npos) << told;
    EXPECT_NE(told.find("open.obj: the surface is not closed: the edge from point "), std::string::npos) << told;
    EXPECT_NE(told.find("of such edges there are 4"), std::string::npos) << told;
    EXPECT_NE(told.find("0.1"), std::string::npos) << told;
    EXPECT_NE(refusal("file = \"none.stl\"\ncentre = [0, 0, 0]").find("none.stl"), std::string::npos);
    EXPECT_NE(refusal("file = \"a.step\"\ncentre = [0, 0, 0]").find("a surface is an .stl or .obj file"), std::string::npos);
    EXPECT_NE(refusal("radius = 1\ncentre = [0, 0, 0]").find("a surface has file"), std::string::npos);
    EXPECT_NE(refusal("centre = [0, 0, 0]").find("body[0]"), std::string::npos);
}

}  // namespace kropla
