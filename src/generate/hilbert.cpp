// Spatial orders of points, after
//   [Hamilton 2006] Compact Hilbert indices (the curve by entry corner and direction, here as a table of
//   states);
//   [Amenta, Choi, Rote 2003] Incremental constructions con BRIO.

#include "generate/hilbert.h"

#include <kropla/generate/generate.h>

#include "base/random.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

namespace kropla {

namespace {

/// Where the curve is inside a cube: a state says at which corner it enters (3 bits) and along which axis it
/// leaves. For each octant of the cube: its place on the curve, and the state inside it.
struct Step {
    std::uint8_t place;
    std::uint8_t state;
};
using States = std::array<std::array<Step, 8>, 24>;

constexpr unsigned rotated_left(unsigned bits, unsigned by) {
    return ((bits << by) | (bits >> (3 - by))) & 7;
}
constexpr unsigned gray(unsigned i) { return i ^ (i >> 1); }

/// The corner at which the curve enters the octant it visits as the i-th, in the standard position.
constexpr unsigned entry(unsigned i) { return i == 0 ? 0 : gray((i - 1) & ~1u); }

/// The axis along which it leaves that octant.
constexpr unsigned direction(unsigned i) {
    if (i == 0) return 0;
    return static_cast<unsigned>(std::countr_one(i % 2 == 0 ? i - 1 : i)) % 3;
}

constexpr States hilbert_states() {
    States states{};
    for (unsigned corner = 0; corner < 8; ++corner)
        for (unsigned axis = 0; axis < 3; ++axis)
            for (unsigned i = 0; i < 8; ++i) {
                const unsigned turn = (axis + 1) % 3;
                const unsigned octant = rotated_left(gray(i), turn) ^ corner;
                const unsigned next_corner = corner ^ rotated_left(entry(i), turn);
                const unsigned next_axis = (axis + direction(i) + 1) % 3;
                states[3 * corner + axis][octant] = {static_cast<std::uint8_t>(i),
                                                     static_cast<std::uint8_t>(3 * next_corner + next_axis)};
            }
    return states;
}

constexpr States states = hilbert_states();

struct Placed {
    std::uint64_t place;
    Vertex point;
};

/// The places on the curve of all points, not sorted.
std::vector<Placed> places(std::span<const Vec3> points) {
    Vec3 low = points[0], high = points[0];
    for (const Vec3& p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3 extent = high - low;
    const double side = std::max({extent.x, extent.y, extent.z});
    const double scale = side > 0 ? ((1 << hilbert_bits) - 1) / side : 0;
    std::vector<Placed> result(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 r = scale * (points[i] - low);
        const auto cell = [](double x) { return static_cast<std::uint32_t>(x); };
        result[i] = {hilbert_index({cell(r.x), cell(r.y), cell(r.z)}), Vertex(i)};
    }
    return result;
}

/// Sorts by place, points of one place staying in order: by digits, the least first.
void sort_by_place(std::vector<Placed>& placed) {
    constexpr int digit_bits = 10;
    constexpr std::size_t digits = 1 << digit_bits;
    const auto digit = [](const Placed& p, int shift) { return p.place >> shift & (digits - 1); };
    std::vector<Placed> sorted(placed.size());
    for (int shift = 0; shift < 3 * hilbert_bits; shift += digit_bits) {
        std::array<std::size_t, digits> first{};
        for (const Placed& p : placed) ++first[digit(p, shift)];
        std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
        for (const Placed& p : placed) sorted[first[digit(p, shift)]++] = p;
        std::swap(placed, sorted);
    }
}

}  // namespace

std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& cell) {
    std::uint64_t index = 0;
    unsigned state = 0;
    for (int bit = hilbert_bits - 1; bit >= 0; --bit) {
        const unsigned x = cell[0] >> bit & 1, y = cell[1] >> bit & 1, z = cell[2] >> bit & 1;
        const unsigned octant = x | y << 1 | z << 2;
        const Step step = states[state][octant];
        index = index << 3 | step.place;
        state = step.state;
    }
    return index;
}

SpatialOrder hilbert_order(std::span<const Vec3> points) {
    SpatialOrder result;
    result.same_as.resize(points.size());
    if (points.empty()) return result;
    std::vector<Placed> placed = places(points);
    const auto point_of = [&](const Placed& p) { return points[static_cast<std::size_t>(p.point.value)]; };
    sort_by_place(placed);
    for (auto run = placed.begin(); run != placed.end();) {  // equal points have one place, maybe with others
        const auto elsewhere = [place = run->place](const Placed& p) { return p.place != place; };
        const auto end = std::find_if(run, placed.end(), elsewhere);
        std::sort(run, end, [&](const Placed& a, const Placed& b) {
            const Vec3 p = point_of(a), q = point_of(b);
            return std::tie(p.x, p.y, p.z, a.point) < std::tie(q.x, q.y, q.z, b.point);
        });
        run = end;
    }
    result.order.reserve(points.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const bool seen = i > 0 && point_of(placed[i]) == point_of(placed[i - 1]);
        if (seen) result.same_as[placed[i].point] = result.order.back();
        else result.order.push_back(placed[i].point);
    }
    return result;
}

std::vector<Vertex> in_random_rounds(std::span<const Vertex> order) {
    constexpr std::size_t first_round = 500;  // about so many points, which need no random order
    int rounds = 1;
    for (std::size_t n = order.size(); n > 8 * first_round; n /= 8) ++rounds;
    // The last round is number 0, and each point is put off to an earlier one with a chance of one in eight.
    const auto round_of = [&](Vertex v) {
        const std::uint64_t seed = 0;  // any: it changes the speed a little, never the triangulation
        const std::uint64_t bits = random_bits(seed, static_cast<std::uint64_t>(v.value));
        return std::min(std::countr_zero(bits) / 3, rounds - 1);
    };
    std::vector<std::size_t> place(static_cast<std::size_t>(rounds) + 1, 0);
    for (const Vertex v : order) ++place[static_cast<std::size_t>(rounds - round_of(v))];
    for (std::size_t r = 1; r < place.size(); ++r) place[r] += place[r - 1];
    std::vector<Vertex> result(order.size());
    for (const Vertex v : order) result[place[static_cast<std::size_t>(rounds - 1 - round_of(v))]++] = v;
    return result;
}

Mesh in_spatial_order(const Mesh& mesh) {
    std::vector<Vertex> alive_ones;
    std::vector<Vec3> places;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v)) {
            alive_ones.push_back(v);
            places.push_back(mesh.position[v]);
        }
    Array<Vertex, Vertex> vertices;
    Array<Vertex, std::int32_t> rank(mesh.position.size());
    for (Vertex place : hilbert_order(places).order) {
        const Vertex v = alive_ones[static_cast<std::size_t>(place.value)];
        rank[v] = vertices.push_back(v).value;
    }
    // Cells follow their first vertex.
    Array<Tet, Tet> tets;
    Array<Tet, std::array<std::int32_t, 4>> ranks(mesh.tets.size());
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        tets.push_back(t);
        std::ranges::transform(mesh.tets[t], ranks[t].begin(), [&](Vertex v) { return rank[v]; });
        std::ranges::sort(ranks[t]);
    }
    std::ranges::sort(tets, {}, [&](Tet t) { return ranks[t]; });
    return reorder(mesh, std::move(vertices), std::move(tets)).mesh;
}

}  // namespace kropla
