// Relaxation of a triangulated surface.
//
// Points move to the area-weighted mean of their triangles' centres and back onto the surface, as in the
// optimal Delaunay triangulation of [Chen, Xu 2004]. Edges flip in turn with that: first to even out the
// valences, as in [Botsch, Kobbelt 2004, "A remeshing approach to multiresolution modeling"], then while that
// raises the least angle [Lawson 1977, "Software for C1 surface interpolation"]. Changed: the centre is half
// way between circumcentre and centroid, since the first alone evens out the edges and the second the angles.

#include "generate/skin.h"

#include "generate/triangle.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kropla {

namespace {

constexpr std::size_t after(std::size_t corner) { return (corner + 1) % 3; }
constexpr std::size_t before(std::size_t corner) { return (corner + 2) % 3; }

/// An edge as one of its triangles sees it: the one opposite `corner`.
struct Side {
    Triangle triangle;
    std::size_t corner;
};

Side other_side(const Skin& skin, Side side) {
    const Triangle t = skin.across[side.triangle][side.corner];
    const Vertex first = skin.triangles[side.triangle][after(side.corner)];
    for (std::size_t i = 0; i < 3; ++i)
        if (skin.triangles[t][before(i)] == first) return {t, i};
    return {};
}

bool faces_outwards(const Skin& skin, Vertex a, Vertex b, Vertex c) {
    const Vec3& o = skin.inside;
    return determinant(skin.points[a] - o, skin.points[b] - o, skin.points[c] - o) > 0;
}

/// The greatest cosine of the triangle's angles: that of the least angle.
double least_angle_cosine(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = normalised(b - a), v = normalised(c - b), w = normalised(a - c);
    return std::max({-dot(u, v), -dot(v, w), -dot(w, u)});
}

/// The four corners around an edge bc: a before it, d across it.
struct Diamond {
    Vertex a, b, c, d;
};
Diamond diamond(const Skin& skin, Side side, Side other) {
    const auto& corners = skin.triangles[side.triangle];
    return {corners[side.corner], corners[after(side.corner)], corners[before(side.corner)],
            skin.triangles[other.triangle][other.corner]};
}

bool flip_pays(const Skin& skin, const Diamond& q) {
    const Vec3 &a = skin.points[q.a], &b = skin.points[q.b], &c = skin.points[q.c], &d = skin.points[q.d];
    // Opposite angles of less than pi together: the flip cannot pay in the plane, and hardly on the surface.
    const Vec3 ab = b - a, ac = c - a, db = b - d, dc = c - d;
    if (dot(ab, ac) * norm(cross(db, dc)) + dot(db, dc) * norm(cross(ab, ac)) >= 0) return false;
    if (!faces_outwards(skin, q.a, q.b, q.d) || !faces_outwards(skin, q.a, q.d, q.c)) return false;
    return std::max(least_angle_cosine(a, b, d), least_angle_cosine(a, d, c)) <
           std::max(least_angle_cosine(a, b, c), least_angle_cosine(b, d, c));
}

/// Replaces the triangles abc and bdc by abd and adc.
void flip(Skin& skin, Side side, Side other) {
    const Diamond q = diamond(skin, side, other);
    const Triangle t = side.triangle, s = other.triangle;
    const Triangle at_ab = skin.across[t][before(side.corner)], at_ca = skin.across[t][after(side.corner)];
    const Triangle at_bd = skin.across[s][after(other.corner)], at_dc = skin.across[s][before(other.corner)];
    skin.triangles[t] = {q.a, q.b, q.d};
    skin.across[t] = {at_bd, s, at_ab};
    skin.triangles[s] = {q.a, q.d, q.c};
    skin.across[s] = {at_dc, at_ca, t};
    std::ranges::replace(skin.across[at_bd], s, t);
    std::ranges::replace(skin.across[at_ca], t, s);
}

/// Flips edges where that brings the counts of edges at the four vertices nearer to six.
void equalise_valences(Skin& skin) {
    Array<Vertex, int> excess(skin.points.size(), -6);
    for (const auto& corners : skin.triangles)
        for (Vertex v : corners) ++excess[v];
    for (Triangle t : skin.triangles.indices())
        for (std::size_t i = 0; i < 3; ++i) {
            const Side side{t, i}, other = other_side(skin, side);
            const Diamond q = diamond(skin, side, other);
            // The sum of squares falls: (e + 1)^2 - e^2 = 2 e + 1 at a and d, (e - 1)^2 - e^2 = 1 - 2 e at b
            // and c.
            if (excess[q.a] + excess[q.d] - excess[q.b] - excess[q.c] + 2 >= 0) continue;
            if (!faces_outwards(skin, q.a, q.b, q.d) || !faces_outwards(skin, q.a, q.d, q.c)) continue;
            flip(skin, side, other);
            ++excess[q.a], ++excess[q.d], --excess[q.b], --excess[q.c];
        }
}

/// Each point's place after a move to the mean of its triangles' centres, weighted by area in squares of the size there.
Array<Vertex, Vec3> relaxed_places(const Skin& skin, const Shape& shape, const SurfaceSize& size) {
    Array<Vertex, Vec3> sum(skin.points.size());
    Array<Vertex, double> weight(skin.points.size());
    for (const auto& [i, j, k] : skin.triangles) {
        const Vec3 &a = skin.points[i], &b = skin.points[j], &c = skin.points[k];
        const double finer = size.local ? size.most / size.local((a + b + c) / 3) : 1;
        const double area = norm(cross(b - a, c - a)) * finer * finer;
        const Vec3 centre = 0.5 * (triangle_circumcentre(a, b, c) + (a + b + c) / 3);
        for (Vertex v : {i, j, k}) {
            sum[v] += area * (centre - skin.points[v]);
            weight[v] += area;
        }
    }
    for (Vertex v : skin.points.indices()) sum[v] = closest_point(shape, skin.points[v] + sum[v] / weight[v]);
    return sum;
}

/// Moves all points to `places`, but for those of triangles that would turn over.
void move_points(Skin& skin, const Array<Vertex, Vec3>& places) {
    const Array<Vertex, Vec3> old = skin.points;
    skin.points = places;
    for (bool turned = true; turned;) {
        turned = false;
        for (const auto& [i, j, k] : skin.triangles) {
            if (faces_outwards(skin, i, j, k)) continue;
            for (Vertex v : {i, j, k}) {
                if (skin.points[v] == old[v]) continue;
                skin.points[v] = old[v];
                turned = true;
            }
        }
    }
}

}  // namespace

Skin make_skin(const Surface& surface, const Vec3& inside) {
    Skin skin{inside, Array<Vertex, Vec3>(surface.points.size()), {}, {}};
    std::ranges::copy(surface.points, skin.points.begin());
    for (const auto& [a, b, c] : surface.triangles)
        skin.triangles.push_back({Vertex(a), Vertex(b), Vertex(c)});
    skin.across.resize(skin.triangles.size());
    struct Half {
        Vertex low, high;
        Triangle triangle;
        std::size_t corner;
    };
    std::vector<Half> halves;
    for (Triangle t : skin.triangles.indices())
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(skin.triangles[t][after(i)], skin.triangles[t][before(i)]);
            halves.push_back({low, high, t, i});
        }
    std::ranges::sort(halves, {}, [](const Half& h) { return std::tuple(h.low, h.high, h.triangle); });
    for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
        skin.across[halves[i].triangle][halves[i].corner] = halves[i + 1].triangle;
        skin.across[halves[i + 1].triangle][halves[i + 1].corner] = halves[i].triangle;
    }
    return skin;
}

Surface surface_of(const Skin& skin) {
    Surface surface;
    surface.points.assign(skin.points.begin(), skin.points.end());
    for (const auto& [a, b, c] : skin.triangles) surface.triangles.push_back({a.value, b.value, c.value});
    return surface;
}

Vertex split_longest_edge(Skin& skin, const Shape& shape, Triangle t) {
    const auto length = [&](std::size_t i) {
        return distance(skin.points[skin.triangles[t][after(i)]], skin.points[skin.triangles[t][before(i)]]);
    };
    Side side{t, 0};
    for (std::size_t i : {1u, 2u})
        if (length(i) > length(side.corner)) side.corner = i;
    const Side other = other_side(skin, side);
    const auto [a, b, c, d] = diamond(skin, side, other);
    const Vertex middle =
        skin.points.push_back(closest_point(shape, 0.5 * (skin.points[b] + skin.points[c])));
    // abc keeps its half at b, its half at c is new; the same of bdc.
    const Triangle s = other.triangle;
    const Triangle at_ca = skin.across[t][after(side.corner)], at_dc = skin.across[s][before(other.corner)];
    const Triangle upper(skin.triangles.size()), lower(skin.triangles.size() + 1);
    skin.triangles.push_back({a, middle, c});
    skin.across.push_back({lower, at_ca, t});
    skin.triangles.push_back({d, c, middle});
    skin.across.push_back({upper, s, at_dc});
    skin.triangles[t][before(side.corner)] = middle;
    skin.across[t][after(side.corner)] = upper;
    skin.triangles[s][after(other.corner)] = middle;
    skin.across[s][before(other.corner)] = lower;
    std::ranges::replace(skin.across[at_ca], t, upper);
    std::ranges::replace(skin.across[at_dc], s, lower);
    return middle;
}

int flip_edges(Skin& skin, const Watch* watch) {
    int flips = 0;
    for (bool changed = true; changed;) {
        heed(watch);
        changed = false;
        for (Triangle t : skin.triangles.indices())
            for (std::size_t i = 0; i < 3; ++i) {
                const Side side{t, i}, other = other_side(skin, side);
                if (!flip_pays(skin, diamond(skin, side, other))) continue;
                flip(skin, side, other);
                ++flips;
                changed = true;
            }
    }
    return flips;
}

void relax_skin(Skin& skin, const Shape& shape, const SurfaceSize& size, const Watch* watch) {
    constexpr int rough_rounds = 25, fine_rounds = 15;  // more do not raise the least angle, by measurement
    flip_edges(skin, watch);
    for (int round = 0; round < rough_rounds; ++round) {
        heed(watch);
        equalise_valences(skin);
        move_points(skin, relaxed_places(skin, shape, size));
    }
    for (int round = 0; round < fine_rounds; ++round) {
        flip_edges(skin, watch);
        move_points(skin, relaxed_places(skin, shape, size));
    }
    flip_edges(skin, watch);
}

}  // namespace kropla
