// Transfers to and fro between two independent meshes of the unit cube: what is left of a smooth field, of a
// narrow one and of a discontinuous one after 1, 10, 100 and 1000 of them, by interpolation and by projection
// without and with its limiter. Prints tables in Markdown. First it intersects meshes, degenerate ones among
// them, and tells how far the parts are from making up the cells.

#include "base/random.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include "transfer/geometry.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>

namespace kropla {
namespace {

using Field = std::function<double(const Vec3&)>;
using Values = Array<Vertex, double>;

Mesh cube(double size, std::uint64_t seed) {
    Domain domain;
    domain.box = {{0, 0, 0}, {1, 1, 1}};
    domain.size = {size, 0, size};
    return generate_mesh(domain, seed);
}

/// A grid of n^3 cubes, each cut into 6 tets: with another grid it has planes, edges and vertices in common.
Mesh grid(int n, bool turned) {
    const auto number = [n](int i, int j, int k) { return Vertex(i + (n + 1) * (j + (n + 1) * k)); };
    Array<Vertex, Vec3> position;
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const Vec3 x = {1.0 * i / n, 1.0 * j / n, 1.0 * k / n};
                position.push_back(turned ? Vec3{x.y, 1 - x.x, x.z} : x);
            }
    Array<Tet, std::array<Vertex, 4>> tets;
    for (int cell = 0; cell < n * n * n; ++cell) {
        std::array<int, 3> axes = {0, 1, 2};
        do {  // along the three axes, in each order
            std::array<int, 3> at = {cell % n, cell / n % n, cell / (n * n)};
            std::array<Vertex, 4> corners;
            for (std::size_t c = 0; c < 4; ++c) {
                corners[c] = number(at[0], at[1], at[2]);
                if (c < 3) ++at[static_cast<std::size_t>(axes[c])];
            }
            const Vec3 o = position[corners[0]];
            if (determinant(position[corners[1]] - o, position[corners[2]] - o, position[corners[3]] - o) < 0)
                std::swap(corners[2], corners[3]);
            tets.push_back(corners);
        } while (std::ranges::next_permutation(axes).found);
    }
    Array<Tet, Region> region(tets.size(), surroundings);
    return make_mesh(std::move(position), std::move(tets), std::move(region));
}

void shift(Mesh& mesh, double by) {
    Random random{1};
    for (Vec3& x : mesh.position)
        for (int axis = 0; axis < 3; ++axis)
            if (x[axis] > 0 && x[axis] < 1) x[axis] += random.uniform(-by, by);
}

void flatten(Mesh& mesh) {
    for (Vec3& x : mesh.position) x.z *= 1e-3;
}

void report_intersections(const char* name, const Mesh& a, const Mesh& b) {
    for (const auto& [from, to] : {std::pair{&a, &b}, {&b, &a}}) {
        const TransferPlan plan = plan_transfer(*from, *to);
        std::size_t pairs = 0;
        for (const Overlaps::Chunk& chunk : plan.geometry->overlaps.chunks) pairs += chunk.cell.size();
        std::printf("| %s | %zu | %zu | %.1e | %zu |\n", name, plan.geometry->changed.come.size(), pairs,
                    plan.geometry->overlaps.worst_gap, plan.geometry->overlaps.searched);
    }
}

void intersections(const Mesh& a, const Mesh& b) {
    std::printf(
        "| intersections of | cells | parts | worst of 1 - sum of a cell's parts | cells that needed a search |\n"
        "|---|---|---|---|---|\n");
    report_intersections("independent meshes", a, b);
    report_intersections("grids of 16 and 24, turned", grid(16, false), grid(24, true));
    report_intersections("grids of 20, turned", grid(20, false), grid(20, true));
    for (const double by : {1e-16, 1e-12, 1e-6}) {
        Mesh shifted = grid(20, false);
        shift(shifted, by);
        char name[60];
        std::snprintf(name, sizeof name, "a grid of 20, and shifted by %.0e", by);
        report_intersections(name, grid(20, false), shifted);
    }
    Mesh flat_a = a, flat_b = b;
    flatten(flat_a);
    flatten(flat_b);
    report_intersections("independent meshes, flattened to 1/1000", flat_a, flat_b);
}

Values values_of(const Mesh& mesh, const Field& field) {
    Values values(mesh.position.size());
    for (Vertex v : mesh.position.indices()) values[v] = field(mesh.position[v]);
    return values;
}

/// The norm in the mean square of the field less what the values make, or of the field; by 20 points per
/// cell.
double norm_of(const Mesh& mesh, const Field& field, const Values* values) {
    double sum = 0;
    for (Tet t : all_tets(mesh)) {
        const auto& c = mesh.tets[t];
        double cell = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; i + j < 4; ++j)
                for (int k = 0; i + j + k < 4; ++k) {
                    const std::array<double, 4> w = {(i + 0.25) / 4, (j + 0.25) / 4, (k + 0.25) / 4,
                                                     (3 - i - j - k + 0.25) / 4};
                    Vec3 x;
                    double value = 0;
                    for (std::size_t n = 0; n < 4; ++n) {
                        x += w[n] * mesh.position[c[n]];
                        if (values != nullptr) value += w[n] * (*values)[c[n]];
                    }
                    cell += std::pow(field(x) - value, 2) / 20;
                }
        sum += cell * volume(mesh, t);
    }
    return std::sqrt(sum);
}

double integral(const Mesh& mesh, const Values& values) {
    double sum = 0;
    for (Tet t : all_tets(mesh))
        for (Vertex v : mesh.tets[t]) sum += values[v] * volume(mesh, t) / 4;
    return sum;
}

/// Linear interpolation at the vertices of the other mesh.
std::vector<Location> places_in(const Mesh& mesh, const Mesh& other) {
    std::vector<Location> places;
    Tet last = all_tets(mesh).front();
    for (const Vec3& x : other.position) {
        places.push_back(locate(mesh, x, last));
        last = places.back().tet;
    }
    return places;
}

Values interpolated(const Mesh& mesh, const Values& values, const std::vector<Location>& places) {
    Values result(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k)
            result[Vertex(i)] += places[i].weights[k] * values[mesh.tets[places[i].tet][k]];
    return result;
}

struct Pair {
    Mesh a, b;
    TransferPlan there, back;
    std::vector<Location> a_in_b, b_in_a;
};

enum class Scheme { interpolation, unlimited, limited };

void transfer(const Pair& pair, bool to_b, Scheme scheme, Values& values) {
    if (scheme == Scheme::interpolation)
        values = interpolated(to_b ? pair.a : pair.b, values, to_b ? pair.b_in_a : pair.a_in_b);
    else
        (void)project(to_b ? pair.there : pair.back, values,
                      {.limit = scheme == Scheme::limited, .weight = {}});
}

void study(const Pair& pair, const char* name, const Field& field, Scheme scheme) {
    constexpr std::array<const char*, 3> schemes = {"interpolation", "projection", "projection, limited"};
    Values values = values_of(pair.a, field);
    const double content = integral(pair.a, values), size = norm_of(pair.a, field, nullptr);
    const auto [least, most] = std::ranges::minmax(values);
    std::printf("| %s | %s | %.2e |", name, schemes[static_cast<std::size_t>(scheme)],
                norm_of(pair.a, field, &values) / size);
    double beyond = 0;
    for (int n = 1; n <= 1000; ++n) {
        transfer(pair, n % 2 == 1, scheme, values);
        const auto [low, high] = std::ranges::minmax(values);
        beyond = std::max({beyond, least - low, high - most});
        if (n == 1 || n == 10 || n == 100 || n == 1000)
            std::printf(" %.2e |", norm_of(n % 2 == 1 ? pair.b : pair.a, field, &values) / size);
    }
    const auto [low, high] = std::ranges::minmax(values);
    std::printf(" %+.1e | %.1e | %.3f / %.3f |\n", integral(pair.a, values) / content - 1,
                beyond / (most - least), low, high);
    std::fflush(stdout);
}

double smooth(const Vec3& x) {
    constexpr double turn = 2 * std::numbers::pi;
    return 1 + std::sin(turn * x.x) * std::sin(turn * x.y) * std::sin(turn * x.z);
}
double narrow(const Vec3& x) { return std::exp(-squared_norm(x - Vec3{0.5, 0.5, 0.5}) / (2 * 0.1 * 0.1)); }
double ball(const Vec3& x) { return distance(x, {0.5, 0.5, 0.5}) < 0.25 ? 1 : 0; }

void studies(const Pair& pair) {
    std::printf(
        "\n| field | way | 0 | 1 | 10 | 100 | 1000 | integral after 1000 | most beyond the bounds | least / "
        "most after 1000 |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& [name, field] : {std::pair<const char*, Field>{"1 + sin sin sin", smooth},
                                      {"Gaussian, s = 0.1", narrow},
                                      {"ball, radius 0.25", ball}})
        for (const Scheme scheme : {Scheme::interpolation, Scheme::unlimited, Scheme::limited})
            study(pair, name, field, scheme);
}

/// The smooth field after 10 transfers, on finer and finer meshes.
void orders() {
    std::printf(
        "\n| edge length | vertices | interpolation | projection | projection, limited |\n|---|---|---|---|---|\n");
    for (const int n : {8, 12, 16, 24}) {
        const Mesh a = cube(1.0 / n, 1), b = cube(1.0 / n, 2);
        Pair pair{a, b, {}, {}, places_in(b, a), places_in(a, b)};
        pair.there = plan_transfer(pair.a, pair.b);
        pair.back = plan_transfer(pair.b, pair.a);
        std::printf("| 1/%d | %d |", n, count_vertices(a));
        for (const Scheme scheme : {Scheme::interpolation, Scheme::unlimited, Scheme::limited}) {
            Values values = values_of(pair.a, smooth);
            for (int i = 0; i < 10; ++i) transfer(pair, i % 2 == 0, scheme, values);
            std::printf(" %.2e |", norm_of(pair.a, smooth, &values) / norm_of(pair.a, smooth, nullptr));
        }
        std::printf("\n");
        std::fflush(stdout);
    }
}

void run() {
    Pair pair{cube(1.0 / 16, 1), cube(1.0 / 16, 2), {}, {}, {}, {}};
    std::printf("Two meshes of the unit cube, edge length 1/16: %d and %d vertices, %d and %d tets.\n\n",
                count_vertices(pair.a), count_vertices(pair.b), count_tets(pair.a), count_tets(pair.b));
    intersections(pair.a, pair.b);
    pair.there = plan_transfer(pair.a, pair.b);
    pair.back = plan_transfer(pair.b, pair.a);
    pair.a_in_b = places_in(pair.b, pair.a);
    pair.b_in_a = places_in(pair.a, pair.b);
    studies(pair);
    orders();
}

}  // namespace
}  // namespace kropla

int main() { kropla::run(); }
