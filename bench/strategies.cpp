// kropla_strategies [STEPS]: the same motion, that of cases/droplet.toml in STEPS steps (50 unless told), by several ways to
// keep a mesh good. Two are methods of the library, taken step by step by `advance`, as a case file chooses them:
//   kropla     spread displacement, optimised places, adaptation to size, local operators, the repair ladder;
//   paper      the paper's own: weighted smoothing, its three modification steps, local clusters.
// The others are plainer, to tell what the parts are worth:
//   Laplacian  the body moves, its surroundings follow by sweeps of the standard Laplacian; the domain is meshed anew
//              where R/r would pass 10;
//   weighted   the same with the paper's steps: sweeps that equalise volumes, then sweeps that smooth, each guarded;
//   local      no vertex of the surroundings moves; clusters of cells that are bad are cut out and meshed anew.
// All obey the same rule: a step changes places only, and ends with every cell valid and R/r at most 10, or it is refused;
// then the mesh is remeshed at the step's beginning and the step tried again, then with a part of the way. A plain way is
// given up after a minute of processor time.

#include "adapt/stepping.h"
#include <kropla/step/initial_mesh.h>
#include <kropla/step/stuck.h>
#include <kropla/base/error.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>

namespace kropla {
namespace {

constexpr double limit = 10;         // of R/r
constexpr int most_sweeps = 10;      // of smoothing, in a step; it ends where R/r is at most the limit
constexpr double local_floor = 8;    // [-] R/r: worse cells are cut out where there is no smoothing
constexpr double reach_in_sizes = 5;  // around the body, where local remeshing looks
constexpr double end = 0.01;         // [s]
constexpr double patience = 60;      // [s] of the processor, after which a way is given up

Domain droplet(Motion motion) {
    Domain domain;
    domain.box = {{-0.004, -0.004, 0}, {0.004, 0.004, 0.016}};
    domain.size = {.surface = 2e-4, .growth = 0.1, .far = 8e-4};
    domain.bodies.push_back({"droplet", {{0, 0, 0.013}, {0.001, 0.001, 0.001}, {}}, std::move(motion)});
    return domain;
}

Pose of_the_case(double t) {
    return {{0.0003 * std::sin(4 * std::numbers::pi * t / end), 0, -t}, {}};
}

/// What a run by one of the ways came to.
struct Outcome {
    int accepted = 0, refused = 0, global_remeshes = 0, local_remeshes = 0;
    long operations = 0;      // swaps, splits, collapses
    long cells_replaced = 0;
    std::vector<double> worst, mean;  // R/r after each accepted step
    double cpu_seconds = 0;
    double way = 0;           // share of the whole that it came
};

void note_quality(const Mesh& mesh, Outcome& outcome) {
    const QualitySummary quality = summarise_quality(mesh);
    outcome.worst.push_back(quality.max_aspect_ratio);
    outcome.mean.push_back(quality.mean_aspect_ratio);
}

void note_changes(const Changes& changes, Outcome& outcome) {
    outcome.operations += changes.swaps + changes.splits + changes.collapses;
    outcome.cells_replaced += changes.cells_replaced;
    outcome.local_remeshes += changes.local_remeshes;
    outcome.global_remeshes += changes.global_remeshes;
}

// ---- the plain ways

bool is_good(const Mesh& mesh) { return worst_aspect_ratio(mesh, all_tets(mesh)) <= limit; }

/// The vertices of bodies' cells, and those of the surroundings alone.
struct Parts {
    std::vector<Vertex> bodies, surroundings;
};

Parts parts_of(const Mesh& mesh) {
    Array<Vertex, char> in_body(mesh.position.size(), 0);
    for (Tet t : all_tets(mesh))
        if (mesh.region[t] != surroundings)
            for (Vertex v : mesh.tets[t]) in_body[v] = 1;
    Parts parts;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v)) (in_body[v] != 0 ? parts.bodies : parts.surroundings).push_back(v);
    return parts;
}

/// Moves vertices of the surroundings after the body has moved.
using Follow = void (*)(Mesh&, std::span<const Vertex>);

void by_laplacian(Mesh& mesh, std::span<const Vertex> vertices) {
    for (int sweep = 0; sweep < most_sweeps && (sweep == 0 || !is_good(mesh)); ++sweep)
        smooth_laplacian(mesh, vertices, {.x1 = 1, .x2 = 0});
}

/// Modification steps 2 and 3 of the paper's Fig. 5; step 1 is the motion of the interior with the body.
void by_weights(Mesh& mesh, std::span<const Vertex> vertices) {
    for (int sweep = 0; sweep < most_sweeps && (sweep == 0 || !is_good(mesh)); ++sweep) {
        smooth_laplacian(mesh, vertices, {.x1 = 0, .x2 = 1});
        smooth_guarded(mesh, vertices, {.x1 = 1, .x2 = 1});
    }
}

void not_at_all(Mesh&, std::span<const Vertex>) {}

/// Makes the mesh at time `t` better, without a step.
using Remesh = void (*)(Mesh&, const Domain&, double t, Outcome&);

void all_anew(Mesh& mesh, const Domain& domain, double t, Outcome& outcome) {
    const Pose pose = domain.bodies.front().motion(t);
    outcome.cells_replaced += count_tets(mesh);
    ++outcome.global_remeshes;
    mesh = initial_mesh(droplet([pose](double) { return pose; }), 1);
}

void clusters(Mesh& mesh, const Domain& domain, double t, Outcome& outcome) {
    const Snapshot at = snapshot(domain, t);
    std::vector<Tet> cells;
    for (Tet c : all_tets(mesh))
        if (mesh.region[c] == surroundings &&
            distance_to_bodies(at, centroid(mesh, c)) < reach_in_sizes * domain.size.surface)
            cells.push_back(c);
    const AdaptOptions options{.floor = local_floor, .largest_ring = 3, .whole_region = false};
    const Changes sized = adapt_to_size(mesh, cells, at, options);
    cells.insert(cells.end(), sized.cells.begin(), sized.cells.end());
    note_changes(sized, outcome);
    note_changes(repair(mesh, cells, at, options), outcome);
}

void nothing(Mesh&, const Domain&, double, Outcome&) {}

struct Way {
    const char* name;
    Follow follow;
    Remesh on_refusal, after_step;
};

constexpr Way plain_ways[] = {{"Laplacian, all meshed anew", by_laplacian, all_anew, nothing},
                              {"weighted smoothing, all meshed anew", by_weights, all_anew, nothing},
                              {"local remeshing, no smoothing", not_at_all, clusters, clusters}};

/// The mesh at t1, if all is good there.
std::optional<Mesh> attempt(const Way& way, const Mesh& mesh, const Domain& domain, double t0, double t1) {
    Mesh moved = mesh;
    const Parts parts = parts_of(mesh);
    const Motion& motion = domain.bodies.front().motion;
    const Vec3 displacement = motion(t1).displacement - motion(t0).displacement;
    for (Vertex v : parts.bodies) moved.position[v] += displacement;
    way.follow(moved, parts.surroundings);
    if (!is_good(moved)) return std::nullopt;
    return moved;
}

Outcome run(const Way& way, const Mesh& start, int steps) {
    const Domain domain = droplet(of_the_case);
    const double wanted = end / steps;
    Outcome outcome;
    Mesh mesh = start;
    double t = 0, dt = wanted;
    for (bool fresh = false; t < end - 1e-9 * end;) {
        const std::clock_t begin = std::clock();
        const double next = std::min({t + dt, wanted * (std::floor(t / wanted + 1e-6) + 1), end});
        auto moved = attempt(way, mesh, domain, t, next);
        if (moved) {
            mesh = std::move(*moved);
            t = next;
            way.after_step(mesh, domain, t, outcome);
            dt = std::min(wanted, 2 * dt);
            ++outcome.accepted;
        } else {
            ++outcome.refused;
            if (fresh) dt = (next - t) / 2;
            else way.on_refusal(mesh, domain, t, outcome);
        }
        outcome.cpu_seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        fresh = !moved;
        if (moved) note_quality(mesh, outcome);
        std::printf("\r%s: t = %.4f of %.4f s, %d accepted, %d refused, %d times all anew  ", way.name, t, end,
                    outcome.accepted, outcome.refused, outcome.global_remeshes);
        std::fflush(stdout);
        outcome.way = t / end;
        if (dt < 1e-3 * wanted || outcome.cpu_seconds > patience) break;
    }
    std::printf("\n");
    return outcome;
}

// ---- the methods

struct Method {
    const char* name;
    AdaptOptions options;
};

const Method methods[] = {{"kropla", {}}, {"paper", {.paper = PaperMethod{}}}};

Outcome run(const Method& method, const Mesh& start, int steps) {
    MovingMesh moving(droplet(of_the_case), start, 0, method.options);
    Outcome outcome;
    try {
        for (int i = 1; i <= steps; ++i) {
            const StepCost cost = step_to(moving, end * i / steps);
            outcome.accepted += cost.accepted;
            outcome.refused += cost.attempts - cost.accepted;
            outcome.cpu_seconds += cost.cpu_seconds;
            note_changes(cost.changes, outcome);
            note_quality(moving.reference(), outcome);
            outcome.way = static_cast<double>(i) / steps;
            std::printf("\r%s: step %d of %d, %d accepted, %d refused  ", method.name, i, steps, outcome.accepted,
                        outcome.refused);
            std::fflush(stdout);
        }
    } catch (const StuckError& error) {
        std::printf("\n%s", error.what());
    }
    std::printf("\n");
    return outcome;
}

// ---- the largest step

bool takes(const Method& method, const Mesh& start, const Domain& domain) {
    MovingMesh moving(domain, start, 0, method.options);
    return !move_bodies(Attempt(moving), 1).refusal();
}

bool takes(const Way& way, const Mesh& start, const Domain& domain) {
    return attempt(way, start, domain, 0, 1).has_value();
}

/// In surface sizes, straight down from the start: the longest that is taken at once, as all shorter ones are.
template <class How>
double largest_step(const Mesh& start, const How& how) {
    constexpr double rise = 0.25, most = 10;
    double taken = 0;
    for (double sizes = rise; sizes <= most; sizes += rise) {
        const Domain domain = droplet([sizes](double t) { return Pose{{0, 0, -sizes * 2e-4 * t}, {}}; });
        if (!takes(how, start, domain)) break;
        taken = sizes;
    }
    return taken;
}

void print_row(const char* name, const Outcome& o, double largest, int steps) {
    auto worst = o.worst, mean = o.mean;
    std::ranges::sort(worst);
    std::ranges::sort(mean);
    const auto middle = [](const std::vector<double>& v) { return v.empty() ? 0 : v[v.size() / 2]; };
    std::printf("| %s | %.0f %% | %d | %d | %d | %d | %ld | %ld | %.2f / %.2f | %.2f | %.3f | %.3g |\n", name, 100 * o.way,
                o.accepted, o.refused, o.global_remeshes, o.local_remeshes, o.operations, o.cells_replaced / 1000,
                middle(worst), worst.empty() ? 0 : worst.back(), middle(mean), o.cpu_seconds / (o.way * steps), largest);
}

}  // namespace
}  // namespace kropla

int main(int count, char** arguments) try {
    using namespace kropla;
    const int steps = count > 1 ? std::atoi(arguments[1]) : 50;
    if (steps < 1) return std::fprintf(stderr, "kropla_strategies [STEPS]\n"), 2;
    const Mesh start = initial_mesh(droplet(of_the_case), 1);
    std::vector<Outcome> by_methods, by_plain_ways;
    for (const Method& method : methods) by_methods.push_back(run(method, start, steps));
    for (const Way& way : plain_ways) by_plain_ways.push_back(run(way, start, steps));

    std::printf("\n| way | share of the motion done | steps accepted | refused | meshed anew | clusters remeshed | swaps, splits, collapses | cells replaced "
                "[1000] | worst R/r: median / of the run | mean R/r | mesh, CPU s per wanted step | largest step "
                "[surface sizes] |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < std::size(methods); ++i)
        print_row(methods[i].name, by_methods[i], largest_step(start, methods[i]), steps);
    for (std::size_t i = 0; i < std::size(plain_ways); ++i)
        print_row(plain_ways[i].name, by_plain_ways[i], largest_step(start, plain_ways[i]), steps);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "kropla_strategies: %s\n", error.what());
    return 1;
}
