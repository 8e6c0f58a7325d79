// Normals of triangulated surfaces by quadric height functions (paper 1.4).
//
// Over the tangent plane, by the mean of the triangles' normals weighted by their angles [Thurmer, Wuthrich
// 1998], the height function a s^2 + b s t + c t^2 + d s + e t is fitted to the neighbours by least squares;
// its gradient (d, e) tilts the normal. Fewer than five neighbours: their neighbours too. Where the normal
// sees a triangle badly, it is drawn to that triangle's normal, in the end to the direction that sees the
// worst triangle best ("most normal" in [Aubry, Lohner 2008, "On the most normal normal"], found there by a
// search).

#include "generate/normals.h"

#include <kropla/base/index.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kropla {

namespace {

/// What stands at each point of the surface.
struct Rings {
    std::vector<std::vector<int>> points, triangles;
};

Rings rings(std::size_t points, std::span<const std::array<int, 3>> triangles) {
    Rings found{std::vector<std::vector<int>>(points), std::vector<std::vector<int>>(points)};
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const int v = triangles[t][i];
            // the next corner only: so each neighbour is there once, as the surface is closed
            found.points[as_size(v)].push_back(triangles[t][(i + 1) % 3]);
            found.triangles[as_size(v)].push_back(static_cast<int>(t));
        }
    return found;
}

std::vector<int> fitted_points(const Rings& around, int v) {
    constexpr std::size_t unknowns = 5;
    std::vector<int> found = around.points[as_size(v)];
    if (found.size() >= unknowns) return found;
    for (int w : around.points[as_size(v)])
        found.insert(found.end(), around.points[as_size(w)].begin(), around.points[as_size(w)].end());
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::erase(found, v);
    return found;
}

using Row = std::array<double, 6>;  // the five unknowns' factors and the right side

/// The solution of the symmetric positive definite system whose rows are `m`, by elimination.
std::array<double, 5> solve(std::array<Row, 5> m) {
    for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t i = k + 1; i < 5; ++i) {
            const double factor = m[i][k] / m[k][k];
            for (std::size_t j = k; j < 6; ++j) m[i][j] -= factor * m[k][j];
        }
    std::array<double, 5> x{};
    for (std::size_t k = 5; k-- > 0;) {
        x[k] = m[k][5];
        for (std::size_t j = k + 1; j < 5; ++j) x[k] -= m[k][j] * x[j];
        x[k] /= m[k][k];
    }
    return x;
}

/// The normal at `p` of the quadric through it that is fitted to `others`, a height function over the plane
/// across `up`.
Vec3 quadric_normal(const Vec3& p, const Vec3& up, std::span<const Vec3> others) {
    constexpr double damping = 1e-12;  // of the system's size: picks the flattest quadric where many fit
    double scale = 0;
    for (const Vec3& q : others) scale = std::max(scale, distance(p, q));
    const Vec3 u = normalised(cross(up, std::abs(up.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               v = cross(up, u);
    std::array<Row, 5> m{};
    for (std::size_t i = 0; i < 5; ++i) m[i][i] = damping;
    for (const Vec3& q : others) {
        const Vec3 to = (q - p) / scale;
        const double s = dot(to, u), t = dot(to, v), height = dot(to, up);
        const Row row = {s * s, s * t, t * t, s, t, height};
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t j = 0; j < 6; ++j) m[i][j] += row[i] * row[j];
    }
    const auto x = solve(m);
    return normalised(up - x[3] * u - x[4] * v);
}

/// Turns `normal` until its angle to each of `sides` has a cosine of `enough`, or as near to that as rounds
/// allow.
Vec3 made_to_see(Vec3 normal, std::span<const Vec3> sides) {
    constexpr double enough = 0.5;
    constexpr int rounds = 200;
    const auto worst = [&] {
        return *std::ranges::min_element(sides, {}, [&](const Vec3& side) { return dot(side, normal); });
    };
    for (int i = 0; i < rounds; ++i) {
        const Vec3 side = worst();
        if (dot(side, normal) >= enough) break;
        normal = normalised(normal + side / (i + 1.0));  // ever smaller steps: to the best if none is enough
    }
    return normal;
}

}  // namespace

std::vector<Vec3> surface_normals(std::span<const Vec3> points,
                                  std::span<const std::array<int, 3>> triangles) {
    const Rings around = rings(points.size(), triangles);
    std::vector<Vec3> normals, sides, others;
    for (int v = 0; v < static_cast<int>(points.size()); ++v) {
        const Vec3& p = points[as_size(v)];
        sides.clear();
        Vec3 mean;
        for (int t : around.triangles[as_size(v)]) {
            const auto& corners = triangles[as_size(t)];
            const auto here = static_cast<std::size_t>(std::ranges::find(corners, v) - corners.begin());
            const Vec3 a = points[as_size(corners[(here + 1) % 3])] - p,
                       b = points[as_size(corners[(here + 2) % 3])] - p;
            sides.push_back(normalised(cross(a, b)));
            mean += std::atan2(norm(cross(a, b)), dot(a, b)) * sides.back();
        }
        others.clear();
        for (int w : fitted_points(around, v)) others.push_back(points[as_size(w)]);
        normals.push_back(made_to_see(quadric_normal(p, normalised(mean), others), sides));
    }
    return normals;
}

}  // namespace kropla
