// The quadric over the tangent plane is that of [Meek, Walton 2000, "On surface normal and Gaussian curvature
// approximations given data sampled from a smooth surface"], by weighted least squares, with the vertex itself left out:
// it is to be found.

#include "adapt/surface_star.h"

#include "adapt/constants.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr std::size_t unknowns = 6;  // of a quadric over a plane

using Row = std::array<double, unknowns + 1>;  // and the right side

/// Solves the system by elimination with pivots on the diagonal, as it is symmetric and positive; only the first unknown
/// is wanted, so it is eliminated last.
std::optional<double> first_unknown(std::array<Row, unknowns> m) {
    double largest = 0;
    for (std::size_t i = 0; i < unknowns; ++i) largest = std::max(largest, m[i][i]);
    for (std::size_t i = unknowns; i-- > 0;) {
        if (!(m[i][i] > least_quadric_pivot * largest)) return std::nullopt;
        for (std::size_t k = 0; k < i; ++k) {
            const double factor = m[k][i] / m[i][i];
            for (std::size_t j = 0; j < i; ++j) m[k][j] -= factor * m[i][j];
            m[k][unknowns] -= factor * m[i][unknowns];
        }
    }
    return m[0][unknowns] / m[0][0];
}

void sort_once(std::vector<Vertex>& vertices) {
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

/// Any two axes across the normal.
std::array<Vec3, 2> tangents(const Vec3& normal) {
    const Vec3 off = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 first = normalised(cross(normal, off));
    return {first, cross(normal, first)};
}

}  // namespace

Freedom free_on_patches(const Mesh& mesh, Vertex v, std::span<const Tet> ball) {
    return freedom(Constraint{constraint(mesh, v, ball).patches, false});
}

SurfaceStar surface_star(const Mesh& mesh, Vertex v, Region region) {
    SurfaceStar star{v, ball(mesh, v), {}};
    std::ranges::sort(star.cells);
    star.free = free_on_patches(mesh, v, star.cells);
    for (Tet t : star.cells) {
        if (mesh.region[t] != region) continue;
        for (int corner = 0; corner < 4; ++corner) {
            if (mesh.tets[t][as_size(corner)] == v) continue;
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (!n.exists() || mesh.region[n] == region) continue;
            auto f = facet_vertices(mesh, {t, corner});
            while (f[0] != v) f = {f[1], f[2], f[0]};
            star.sides.push_back({f[1], f[2]});
        }
    }
    return star;
}

Vec3 twice_area(const SurfaceStar& star, const Mesh& mesh) {
    Vec3 sum;
    for (const auto& [a, b] : star.sides)
        sum += twice_area(mesh.position[star.vertex], mesh.position[a], mesh.position[b]);
    return sum;
}

bool is_sharp(const Vec3& one_normal, const Vec3& other_normal, double sharp) {
    return dot(one_normal, other_normal) < sharp * norm(one_normal) * norm(other_normal);
}

std::vector<Vertex> sharp_ends(const SurfaceStar& star, const Mesh& mesh, double sharp) {
    const auto normal = [&](const std::array<Vertex, 2>& side) {
        return twice_area(mesh.position[star.vertex], mesh.position[side[0]], mesh.position[side[1]]);
    };
    std::vector<Vertex> ends;
    for (const auto& side : star.sides)
        for (const auto& next : star.sides)
            if (next[0] == side[1] && is_sharp(normal(side), normal(next), sharp)) ends.push_back(side[1]);
    return ends;
}

std::vector<Vertex> ring(const SurfaceStar& star) {
    std::vector<Vertex> vertices;
    for (const auto& side : star.sides) vertices.insert(vertices.end(), side.begin(), side.end());
    sort_once(vertices);
    return vertices;
}

std::vector<Vertex> two_rings(const Mesh& mesh, const SurfaceStar& star, const SurfaceOf& of) {
    std::vector<Vertex> vertices = ring(star);
    const std::vector<Vertex> first = vertices;
    for (Vertex v : first)
        if (const SurfaceStar next = surface_star(mesh, v, of.region); !is_sharp(next, mesh, of.sharp))
            for (const auto& side : next.sides) vertices.insert(vertices.end(), side.begin(), side.end());
    sort_once(vertices);
    std::erase(vertices, star.vertex);
    return vertices;
}

std::optional<double> height_of_quadric(const Mesh& mesh, const SurfaceStar& star, const SurfaceOf& of) {
    const std::vector<Vertex> around = two_rings(mesh, star, of);
    if (around.size() < least_quadric_points) return std::nullopt;
    const Vec3 here = mesh.position[star.vertex], normal = normalised(twice_area(star, mesh));
    const auto [e, f] = tangents(normal);
    double scale = 0;
    for (Vertex v : around) scale = std::max(scale, distance(mesh.position[v], here));
    std::array<Row, unknowns> system{};
    for (Vertex v : around) {
        const Vec3 to = (mesh.position[v] - here) / scale;
        const double x = dot(to, e), y = dot(to, f), weight = 1 / (0.01 + squared_norm(to));
        const Row row = {1, x, y, x * x, x * y, y * y, dot(to, normal)};
        for (std::size_t i = 0; i < unknowns; ++i)
            for (std::size_t j = 0; j <= unknowns; ++j) system[i][j] += weight * row[i] * row[j];
    }
    const auto height = first_unknown(system);
    return height ? std::optional(*height * scale) : std::nullopt;
}

}  // namespace kropla
