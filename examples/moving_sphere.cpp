// A sphere that crosses a box, its mesh following step by step, with the mesh library alone: prints for each
// step how many cells there are, how bad the worst is (R/r: 3 is perfect) and how many the step touched.
#include <kropla/mesh/quality.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

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

int main() try {
    const Domain domain = sphere_in_a_box();
    MovingMesh moving(domain, initial_mesh(domain, 1), 0);
    Fields fields;  // none are carried here
    std::printf("time   tets  worst R/r  touched\n");
    const double end = 3, wanted = 0.25;
    for (double dt = wanted; moving.time() < end;) {
        const Advanced step = advance(moving, fields, std::min(dt, end - moving.time()), {});
        dt = std::min(wanted, next_dt(step, dt));
        const QualitySummary quality = summarise_quality(moving.reference());
        std::printf("%4.2f %6d %10.2f %8d\n", moving.time(), quality.tets, quality.max_aspect_ratio, step.cells_touched);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
