#pragma once

#include "domain/triangulated_surface.h"

#include <algorithm>
#include <map>
#include <utility>

namespace kropla {

/// Points and triangles that bound something.
struct Triangles {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
};

/// The box between two corners, two triangles per side, seen counter-clockwise from outside.
inline Triangles box_of_triangles(const Vec3& min, const Vec3& max) {
    Triangles box;
    for (int i = 0; i < 8; ++i)
        box.points.push_back({(i & 1) ? max.x : min.x, (i & 2) ? max.y : min.y, (i & 4) ? max.z : min.z});
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return box;
}

/// Both, beside each other or in each other.
inline Triangles together(Triangles a, const Triangles& b) {
    const int before = static_cast<int>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + before, j + before, k + before});
    return a;
}

inline Triangles turned_round(Triangles a) {
    for (auto& triangle : a.triangles) std::swap(triangle[1], triangle[2]);
    return a;
}

/// The unit sphere: an octahedron whose triangles are cut in four `levels` times.
inline Triangles sphere_of_triangles(int levels) {
    Triangles s{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (; levels > 0; --levels) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [known, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(s.points.size()));
            const auto at = [&](int i) { return s.points[static_cast<std::size_t>(i)]; };
            if (is_new) s.points.push_back(normalised(at(a) + at(b)));
            return known->second;
        };
        std::vector<std::array<int, 3>> finer;
        for (const auto& [a, b, c] : s.triangles) {
            const int d = middle(a, b), e = middle(b, c), f = middle(c, a);
            finer.insert(finer.end(), {{a, d, f}, {d, b, e}, {f, e, c}, {d, e, f}});
        }
        s.triangles = std::move(finer);
    }
    return s;
}

inline TriangulatedSurface surface_of(const Triangles& t) { return make_surface(t.points, t.triangles); }

}  // namespace kropla
