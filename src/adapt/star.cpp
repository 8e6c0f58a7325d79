// The place of a vertex at which the worst of its tets is best: minimisation of the maximum of the aspect
// ratios, by steepest descent of that maximum. The descent direction is the shortest vector of the convex
// hull of the gradients of the worst tets, after [Freitag, Ollivier-Gooch 1997], "Tetrahedral mesh
// improvement using swapping and smoothing"; found here by the iteration of [Frank, Wolfe 1956] instead of
// their active-set search, as three figures are enough for a direction.

#include "adapt/star.h"

#include "adapt/constants.h"
#include "base/tetrahedron.h"

#include <algorithm>

namespace kropla {
namespace {

Vec3 shortest_in_hull(std::span<const Vec3> gradients) {
    Vec3 p = gradients.front();
    for (int i = 0; i < hull_iterations; ++i) {
        const auto least = std::ranges::min_element(gradients, {}, [&](const Vec3& g) { return dot(p, g); });
        const Vec3 towards = *least - p;
        const double length = squared_norm(towards);
        if (length == 0 || -dot(p, towards) < hull_tolerance * squared_norm(p)) break;
        p += std::clamp(-dot(p, towards) / length, 0.0, 1.0) * towards;
    }
    return p;
}

/// As worst_in_star; if `bound` is not exceeded, the ratios are there afterwards.
double find_all_ratios(std::span<FourFacets> star, const Vec3& x, double bound) {
    double worst = 0;
    for (FourFacets& four : star) {
        find_ratios(four, x);
        const FourNumbers& r = four.ratios;
        worst = std::max({worst, r[0], r[1], r[2], r[3]});
        if (worst > bound) return worst;
    }
    return worst;
}

/// The direction of steepest descent of the worst ratio; its length is the slope along it. `fours` has the ratios at `x`.
Vec3 descent(std::span<const StarFacet> star, std::span<const FourFacets> fours, const Vec3& x, double worst,
             const Freedom& f) {
    std::array<Vec3, 16> gradients;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4 * fours.size() && count < gradients.size(); ++i) {
        if (fours[i / 4].ratios[i % 4] < active_share * worst) continue;
        const auto& [a, b, c] = star[std::min(i, star.size() - 1)];
        gradients[count++] = restricted(tet_aspect_gradient(x, a, b, c).gradient, f);
    }
    return -shortest_in_hull({gradients.data(), count});
}

double shortest_distance(std::span<const StarFacet> star, const Vec3& x) {
    double least = infinity;
    for (const auto& s : star) least = std::min({least, distance(x, s.a), distance(x, s.b), distance(x, s.c)});
    return least;
}

}  // namespace

void star_of_ball(const Mesh& mesh, const Array<Vertex, Vec3>& places, Vertex v, std::span<const Tet> ball,
                  std::vector<StarFacet>& star) {
    star.clear();
    for (Tet t : ball) {
        const auto [a, b, c] = facet_vertices(mesh, {t, corner_of(mesh, t, v)});
        star.push_back({places[a], places[b], places[c]});
    }
}

Freedom freedom(const Constraint& c) {
    Freedom f;
    for (int axis = 0; axis < 3; ++axis)
        f.along[as_size(axis)] = !c.rigid() && (c.patches & (3u << (2 * axis))) == 0;
    return f;
}

Vec3 restricted(const Vec3& a, const Freedom& f) {
    return {f.along[0] ? a.x : 0, f.along[1] ? a.y : 0, f.along[2] ? a.z : 0};
}

double worst_in_star(std::span<const StarFacet> star, const Vec3& x, double bound) {
    double worst = 0;
    for (const auto& [a, b, c] : star) {
        worst = std::max(worst, tet_aspect_ratio(x, a, b, c));
        if (worst > bound) return worst;
    }
    return worst;
}

Place best_place(std::span<const StarFacet> star, const Vec3& start, const Freedom& f, double good_enough) {
    auto fours = by_fours(star);
    Place best{start, find_all_ratios(fours, start, infinity)};
    double reach = first_step * shortest_distance(star, start);
    for (int step = 0; step < most_steps && best.worst > good_enough; ++step) {
        const Vec3 slope = descent(star, fours, best.x, best.worst, f);
        const double steepness = norm(slope);
        if (!(steepness > 0) || !std::isfinite(steepness)) break;
        // As far as the linear model takes the worst ratio to the goal, but within reach.
        double length = std::min(reach, overshoot * (best.worst - descent_goal * good_enough) / steepness);
        bool improved = false;
        for (int halving = 0; halving < most_halvings && !improved; ++halving, length /= 2) {
            const Vec3 x = best.x + length / steepness * slope;
            const double worst = find_all_ratios(fours, x, (1 - least_smoothing_gain) * best.worst);
            if (worst < (1 - least_smoothing_gain) * best.worst) {
                best = {x, worst};
                improved = true;
                reach = 2 * length;
            }
        }
        if (!improved) break;
    }
    return best;
}

Place better_place(const Mesh& mesh, Vertex v, std::span<const Tet> ball, double good_enough) {
    const Freedom f = freedom(constraint(mesh, v, ball));
    if (f.none()) return {mesh.position[v], infinity};
    std::vector<StarFacet> star;
    star_of_ball(mesh, mesh.position, v, ball, star);
    return best_place(star, mesh.position[v], f, good_enough);
}

}  // namespace kropla
