// A sphere that crosses a box, its mesh following step by step, with the mesh library alone: prints for each
// step how many cells there are, how bad the worst is (R/r: 3 is perfect) and how many the step touched.
#include "adapt/moving_mesh.h"
#include "base/error.h"
#include "generate/generate.h"
#include "mesh/quality.h"

#include <algorithm>
#include <cstdio>
#include <exception>

using namespace kropla;

Domain sphere_in_a_box() {
    Domain domain;
    domain.box = {{-2, -2, 0}, {2, 2, 6}};
    domain.size = {.surface = 0.4, .growth = 0.2, .far = 1};
    const Shape ball{.centre = {0, 0, 4.5}, .semi_axes = {1, 1, 1}, .orientation = {}};
    domain.bodies.push_back({"sphere", ball, [](double t) { return Pose{{0, 0, -t}, {}}; }});
    return domain;
}

/// Moves on to time `end`, in steps of at most `dt`; shorter ones where the mesh would not keep its floors.
void move_to(MovingMesh& moving, double end, double dt) {
    while (moving.time() < end) {
        moving.begin_step();
        moving.refine();
        moving.move_boundary(std::min(moving.time() + dt, end));
        moving.optimise();
        if (const auto refusal = moving.refusal()) {
            moving.refuse();
            dt = std::min(dt / 2, refusal->advised_dt);
            if (dt < 1e-4) throw FloorError(refusal->why);
        } else {
            moving.accept();
        }
    }
}

int main() try {
    const Domain domain = sphere_in_a_box();
    Mesh mesh = generate_mesh(domain, 1);
    improve(mesh, all_tets(mesh), snapshot(domain, 0));
    repair(mesh, all_tets(mesh), snapshot(domain, 0));
    MovingMesh moving(domain, mesh, 0);
    std::printf("time   tets  worst R/r  touched\n");
    for (int step = 1; step <= 12; ++step) {
        move_to(moving, 0.25 * step, 0.25);
        const auto quality = summarise_quality(moving.reference());
        std::printf("%4.2f %6d %10.2f %8d\n", moving.time(), quality.tets, quality.max_aspect_ratio,
                    moving.statistics().cells_touched);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
