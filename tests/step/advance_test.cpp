#include <kropla/step/advance.h>

#include "adapt/cases.h"
#include <kropla/base/error.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace kropla {
namespace {

/// The sphere of `sphere_in_box`, falling at this speed.
Domain falling_sphere(double speed = 1) {
    Domain domain = sphere_in_box();
    domain.bodies[0].motion = [speed](double t) { return Pose{{0, 0, -speed * t}, {}}; };
    return domain;
}

double wave(const Vec3& x) { return 2 + std::sin(3 * x.x) * std::cos(2 * x.z); }

struct Journey {
    Domain domain;
    MovingMesh moving{domain, improved_mesh(domain, 1), 0};
    Array<Vertex, double> values = nodal(moving.reference());
    Array<Tet, double> marks = Array<Tet, double>(moving.reference().tets.size(), 1);
    Fields fields = both();

    static Array<Vertex, double> nodal(const Mesh& mesh) {
        Array<Vertex, double> values(mesh.position.size());
        for (Vertex v : all_vertices(mesh)) values[v] = wave(mesh.position[v]);
        return values;
    }
    Fields both() {
        Fields all;
        all.per_vertex(values);
        all.per_cell(marks);
        return all;
    }
    [[nodiscard]] double content(const Mesh& mesh) const {
        double sum = 0;
        for (Tet t : all_tets(mesh))
            for (Vertex v : mesh.tets[t]) sum += volume(mesh, t) / 4 * values[v];
        return sum;
    }
    explicit Journey(Domain of) : domain(std::move(of)) {}
    Journey(const Journey&) = delete;
};

const Solve nothing = [](const StepToSolve&) -> Answer { return Solved{}; };

TEST(Advance, TakesMeshAndFieldsOneStepOn) {
    Journey run(falling_sphere());
    const double held = region_volume(run.moving.reference(), Region(1));
    for (int i = 1; i <= 5; ++i) {
        int asked = 0;
        const auto solve = [&](const StepToSolve& step) -> Answer {
            ++asked;
            EXPECT_EQ(step.before.tets, step.current.tets);
            EXPECT_NEAR(step.time, 0.1 * (i - 1), 1e-15);
            EXPECT_NEAR(step.dt, 0.1, 1e-15);
            EXPECT_EQ(step.round, 1);
            return Solved{};
        };
        AdvanceOptions options;
        options.contents = {[&](const Mesh& mesh) { return run.content(mesh); }};
        const Advanced done = advance(run.moving, run.fields, 0.1, solve, options);
        EXPECT_EQ(asked, 1);
        EXPECT_EQ(done.attempts, 1);
        EXPECT_EQ(done.refused, "");
        EXPECT_EQ(done.time, run.moving.time());
        ASSERT_EQ(done.contents.size(), 1u);
        EXPECT_NEAR(done.contents[0].by_transfer / done.contents[0].after, 0, 1e-13);
        EXPECT_EQ(done.contents[0].after, run.content(run.moving.reference()));
        EXPECT_GT(done.cells_touched, 0);
        EXPECT_EQ(verify(run.moving.reference()), "");
        EXPECT_EQ(run.values.size(), run.moving.reference().position.size());
    }
    EXPECT_NEAR(region_volume(run.moving.reference(), Region(1)) / held, 1, 1e-12);
}

TEST(Advance, DoesTheSameWhateverWasRefusedBefore) {
    Journey once(falling_sphere()), again(falling_sphere());
    for (int i = 0; i < 3; ++i) {
        (void)advance(once.moving, once.fields, 0.1, nothing);
        // An exception of the solver's, and one when all was done.
        const auto throws = [&](const StepToSolve&) -> Answer {
            for (double& value : again.values) value = -1;
            throw SolverError("no convergence");
        };
        EXPECT_THROW((void)advance(again.moving, again.fields, 0.1, throws), SolverError);
        AdvanceOptions options;
        options.last_look = [](const Mesh&) { throw FieldError("a last look"); };
        EXPECT_THROW((void)advance(again.moving, again.fields, 0.1, nothing, options), FieldError);
        (void)advance(again.moving, again.fields, 0.1, nothing);
        ASSERT_EQ(again.moving.reference(), once.moving.reference());
        ASSERT_TRUE(std::ranges::equal(again.values, once.values));
        ASSERT_TRUE(std::ranges::equal(again.marks, once.marks));
    }
}

TEST(Advance, CutsAStepThatTheSolverRefuses) {
    for (const auto& [advised, expected] : {std::pair{0.0, 0.05}, {0.03, 0.03}, {0.09, 0.05}, {1e-6, 0.0125}}) {
        Journey run(falling_sphere());
        const Array<Vertex, double> start = run.values;
        int asked = 0;
        const auto solve = [&](const StepToSolve& step) -> Answer {
            EXPECT_TRUE(std::ranges::equal(run.values, start));  // as it was, each time
            run.values[Vertex(0)] = 1e9;
            if (asked++ == 0) return NotSolved{"the flow does not converge", advised};
            run.values = start;
            EXPECT_NEAR(step.dt, expected, 1e-15);
            return Solved{};
        };
        const Advanced done = advance(run.moving, run.fields, 0.1, solve);
        EXPECT_EQ(done.attempts, 2);
        EXPECT_EQ(done.refused, "the flow does not converge");
        EXPECT_NEAR(done.dt, expected, 1e-15);
        EXPECT_EQ(next_dt(done, 0.1), done.dt);
    }
}

TEST(Advance, GivesUpWhereNothingHelps) {
    Journey run(falling_sphere());
    const Mesh start = run.moving.reference();
    const auto never = [](const StepToSolve&) -> Answer { return NotSolved{"it never does"}; };
    try {
        (void)advance(run.moving, run.fields, 0.1, never);
        FAIL();
    } catch (const StuckError& error) {
        EXPECT_NE(std::string(error.what()).find("cannot go on from t = 0 s, even by "), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find(": it never does"), std::string::npos) << error.what();
    }
    EXPECT_EQ(run.moving.reference(), start);
    EXPECT_EQ(run.moving.time(), 0);
    EXPECT_TRUE(std::ranges::equal(run.values, Journey::nodal(start)));
}

TEST(Advance, RemeshesWhereItStuckThenCuts) {
    Journey run(falling_sphere(8));
    double dt = 0.15;
    int cut = 0, tried = 0;
    while (run.moving.time() < 0.16) {
        const Advanced done = advance(run.moving, run.fields, dt, nothing);
        tried += done.attempts;
        cut += done.dt < dt;
        EXPECT_EQ(done.refused.empty(), done.attempts == 1);
        EXPECT_EQ(verify(run.moving.reference()), "");
        EXPECT_LE(worst_of(run.moving.reference()), AdaptOptions{}.floor);
        dt = std::min(0.15, next_dt(done, done.dt));
    }
    EXPECT_GE(cut, 1);
    EXPECT_GE(tried, 3);
}

TEST(Advance, WrongCallsAreStoppedAtOnce) {
    Journey run(falling_sphere());
    for (const double dt : {0.0, -1.0, std::nan("")})
        EXPECT_THROW((void)advance(run.moving, run.fields, dt, nothing), std::logic_error) << dt;
    {
        const Attempt open(run.moving);
        EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, nothing), std::logic_error);
    }
    const auto within = [&](const StepToSolve&) -> Answer {
        (void)advance(run.moving, run.fields, 0.1, nothing);  // from within a step
        return Solved{};
    };
    EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, within), std::logic_error);
    run.values.resize(3);
    EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, nothing), std::logic_error);
    EXPECT_EQ(run.moving.time(), 0);
}

TEST(Advance, HeedsItsWatch) {
    Journey run(falling_sphere());
    const Mesh start = run.moving.reference();
    Watch watch;
    AdvanceOptions options;
    options.watch = &watch;
    const auto solve = [&](const StepToSolve&) -> Answer {
        watch.stop = true;
        return Solved{};
    };
    EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, solve, options), Interrupted);
    EXPECT_EQ(run.moving.reference(), start);
}

/// A body on a spring: pulled to `rest` by a force that is known only where the body really is at the end of the step,
/// so that the solver shifts it until it stands.
struct Spring {
    Vec3 rest, place;  // displacements [m]
    double stiffness = 0.2;
    std::vector<Vec3> told = {};

    Answer operator()(const StepToSolve& step) {
        if (step.round == 1) told.clear();
        const Vec3 at_end = told.empty() ? place : told.back();
        const Vec3 wanted = place + stiffness * (rest - at_end);  // backward Euler, iterated
        if (!told.empty() && norm(wanted - at_end) < 1e-10) {
            place = at_end;
            return Solved{};
        }
        told.push_back(wanted);
        return BodiesMoved{{{0, pose(wanted)}}};
    }
    [[nodiscard]] static Pose pose(const Vec3& displacement) {
        return {displacement, rotation_about({0, 0, 1}, displacement.x)};
    }
};

/// The centre of the body's cells.
Vec3 centre_of(const Mesh& mesh, Region region) {
    Vec3 moment;
    for (Tet t : all_tets(mesh))
        if (mesh.region[t] == region) moment += volume(mesh, t) * centroid(mesh, t);
    return moment / region_volume(mesh, region);
}

TEST(Advance, FollowsABodyThatTheSolverMoves) {
    Journey run(sphere_in_box());  // whose body is at rest, if nobody says otherwise
    const Vec3 start = centre_of(run.moving.reference(), Region(1));
    const double held = region_volume(run.moving.reference(), Region(1));
    Spring spring{{0.5, -0.2, -0.4}, {}};
    Vec3 expected;
    int rounds = 0;
    for (int i = 1; i <= 8; ++i) {
        const auto solve = [&](const StepToSolve& step) {
            rounds = std::max(rounds, step.round);
            EXPECT_EQ(step.before.tets, step.current.tets);
            return spring(step);
        };
        const Advanced done = advance(run.moving, run.fields, 0.1, solve);
        ASSERT_EQ(done.attempts, 1) << done.refused;
        expected = (expected + spring.stiffness * spring.rest) / (1 + spring.stiffness);
        const Vec3 there = placed(run.domain.bodies[0].shape, Spring::pose(expected), start);
        ASSERT_NEAR(distance(centre_of(run.moving.reference(), Region(1)), there), 0, 1e-9) << "step " << i;
        ASSERT_NEAR(distance(shape_at(run.moving.domain().bodies[0], run.moving.time()).centre,
                             run.domain.bodies[0].shape.centre + spring.place), 0, 1e-12);
        ASSERT_EQ(verify(run.moving.reference()), "");
        ASSERT_LE(worst_of(run.moving.reference()), AdaptOptions{}.floor);
        ASSERT_NEAR(region_volume(run.moving.reference(), Region(1)) / held, 1, 1e-12);
    }
    EXPECT_GT(rounds, 10);
    // It stays there when nobody moves it any more, and goes back where it was told if a step is dropped.
    const auto drops = [](const StepToSolve& step) -> Answer {
        if (step.round == 2) throw SolverError("no");
        return BodiesMoved{{{0, Pose{}}}};
    };
    EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, drops), SolverError);
    (void)advance(run.moving, run.fields, 0.1, nothing);
    const Vec3 there = placed(run.domain.bodies[0].shape, Spring::pose(expected), start);
    EXPECT_NEAR(distance(centre_of(run.moving.reference(), Region(1)), there), 0, 1e-9);
}

TEST(Advance, ASolverThatNeverStandsIsRefused) {
    Journey run(sphere_in_box());
    int told = 0;
    const auto wanders = [&](const StepToSolve&) -> Answer {
        return BodiesMoved{{{0, Pose{{0.01 * (++told % 3), 0, 0}, {}}}}};
    };
    AdvanceOptions options;
    options.rounds = 4;
    options.least_dt = 0.05;
    EXPECT_THROW((void)advance(run.moving, run.fields, 0.1, wanders, options), StuckError);
    EXPECT_EQ(told, 8);
}

TEST(InitialMesh, IsOnePerSeedAndMeetsItsFloor) {
    const Domain domain = sphere_in_box();
    const Mesh mesh = initial_mesh(domain, 1);
    EXPECT_EQ(mesh, initial_mesh(domain, 1));
    EXPECT_NE(mesh, initial_mesh(domain, 2));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_LE(worst_of(mesh), AdaptOptions{}.good_enough * 1.1);
    try {
        (void)initial_mesh(domain, {.floor = 3.5});
        FAIL();
    } catch (const StuckError& error) {
        EXPECT_TRUE(error.place);
        ASSERT_TRUE(error.mesh);
        EXPECT_GT(worst_of(*error.mesh), 3.5);
    }
}

}  // namespace
}  // namespace kropla
