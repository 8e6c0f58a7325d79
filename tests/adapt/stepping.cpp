#include "adapt/stepping.h"

#include "base/error.h"
#include "generate/generate.h"

#include <chrono>
#include <ctime>

namespace kropla {
namespace {

void add_accepted(const MovingMesh& moving, StepCost& cost) {
    const StepStatistics& done = moving.statistics();
    cost.changes += done.refined;
    cost.changes += done.optimised;
    cost.changes += done.remeshed;
    cost.cells_touched += done.cells_touched;
    ++cost.accepted;
}

/// Whether the attempt was accepted; if not, `why` tells.
bool attempt(MovingMesh& moving, double t, StepCost& cost, std::string& why) {
    ++cost.attempts;
    moving.begin_step();
    moving.refine();
    moving.move_boundary(t);
    moving.optimise();
    if (const auto refusal = moving.refusal()) {
        why = refusal->why;
        moving.refuse();
        return false;
    }
    moving.accept();
    add_accepted(moving, cost);
    return true;
}

}  // namespace

Mesh starting_mesh(const Domain& domain, std::uint64_t seed, const AdaptOptions& options) {
    Mesh mesh = generate_mesh(domain, seed);
    const Snapshot at = snapshot(domain, 0);
    improve(mesh, all_tets(mesh), at, options);
    repair(mesh, all_tets(mesh), at, options);
    return in_spatial_order(mesh);
}

StepCost step_to(MovingMesh& moving, double t) {
    const double wanted = t - moving.time(), least = 1e-3 * wanted;
    const auto wall = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    StepCost cost;
    double dt = wanted;
    for (int refused = 0; t - moving.time() > 1e-9 * wanted;) {
        std::string why;
        dt = std::min(dt, t - moving.time());
        const bool all_the_way = dt > (1 - 1e-9) * (t - moving.time());
        if (attempt(moving, all_the_way ? t : moving.time() + dt, cost, why)) {
            refused = 0;
            continue;
        }
        if (++refused > 1) dt /= 2;
        if (dt < least) throw FloorError(why);
    }
    cost.cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    cost.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    return cost;
}

}  // namespace kropla
