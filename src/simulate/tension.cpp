#include "simulate/tension.h"

#include <algorithm>

namespace kropla {
namespace {

/// A triangle, seen from its corners.
struct Facet {
    std::array<std::size_t, 3> at;     // places of its corners
    Vec3 area;                         // vector [m^2]
    std::array<Vec3, 3> area_gradient;  // A grad_S phi_i [m]: along the plane, from the opposite edge to the corner
};

Facet facet_of(std::span<const Vertex> vertices, const std::array<Vertex, 3>& corner, const Array<Vertex, Vec3>& position) {
    Facet facet;
    std::array<Vec3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
        facet.at[i] = place_of(vertices, corner[i]);
        x[i] = position[corner[i]];
    }
    facet.area = 0.5 * cross(x[1] - x[0], x[2] - x[0]);
    const Vec3 unit = facet.area / norm(facet.area);
    for (std::size_t i = 0; i < 3; ++i) facet.area_gradient[i] = 0.5 * cross(unit, x[(i + 2) % 3] - x[(i + 1) % 3]);
    return facet;
}

/// Adds up bonds between the same two vertices.
void sum_up(std::vector<SurfaceTension::Bond>& bonds) {
    std::ranges::stable_sort(bonds, [](const auto& a, const auto& b) {
        return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    std::size_t count = 0;
    for (const SurfaceTension::Bond& bond : bonds) {
        if (count > 0 && bonds[count - 1].row == bond.row && bonds[count - 1].column == bond.column)
            bonds[count - 1].stiffness += bond.stiffness;
        else bonds[count++] = bond;
    }
    bonds.resize(count);
}

/// The x of a x = b, a symmetric by its rows.
Vec3 solved(const std::array<Vec3, 3>& a, const Vec3& b) {
    const Vec3 yz = cross(a[1], a[2]), zx = cross(a[2], a[0]), xy = cross(a[0], a[1]);
    return (b.x * yz + b.y * zx + b.z * xy) / dot(a[0], yz);
}

/// Makes forces have no sum, by what is along the normals, as they are: a part along the surface would keep a drop at rest
/// swimming for ever.
void take_off_sum(const std::vector<Vec3>& normal, const std::vector<double>& share, std::vector<Vec3>& force) {
    Vec3 sum;
    std::array<Vec3, 3> spread = {};
    for (std::size_t i = 0; i < force.size(); ++i) {
        sum += force[i];
        for (int m = 0; m < 3; ++m) spread[static_cast<std::size_t>(m)] += share[i] * normal[i][m] * normal[i];
    }
    const Vec3 push = solved(spread, sum);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= share[i] * dot(push, normal[i]) * normal[i];
}

/// Makes forces without a sum have no moment, by what a turn does to masses as large as the shares.
void take_off_moment(const std::vector<Vec3>& place, const std::vector<double>& share, std::vector<Vec3>& force) {
    Vec3 moment, middle;
    double mass = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        middle += share[i] * place[i];
        mass += share[i];
    }
    middle = middle / mass;
    std::array<Vec3, 3> inertia = {};
    for (std::size_t i = 0; i < place.size(); ++i) {
        const Vec3 r = place[i] - middle;
        moment += cross(r, force[i]);
        for (int m = 0; m < 3; ++m) {
            inertia[static_cast<std::size_t>(m)] -= share[i] * r[m] * r;
            inertia[static_cast<std::size_t>(m)][m] += share[i] * squared_norm(r);
        }
    }
    const Vec3 turning = solved(inertia, moment);
    for (std::size_t i = 0; i < place.size(); ++i) force[i] -= share[i] * cross(turning, place[i] - middle);
}

}  // namespace

std::vector<Vertex> vertices_of(std::span<const std::array<Vertex, 3>> facets) {
    std::vector<Vertex> vertices;
    for (const auto& facet : facets) vertices.insert(vertices.end(), facet.begin(), facet.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

std::size_t place_of(std::span<const Vertex> vertices, Vertex v) {
    return static_cast<std::size_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
}

std::vector<Vec3> surface_normals(std::span<const std::array<Vertex, 3>> facets, std::span<const Vertex> vertices,
                                  const Array<Vertex, Vec3>& position) {
    std::vector<Vec3> normal(vertices.size());
    for (const auto& [a, b, c] : facets) {
        const Vec3 area = cross(position[b] - position[a], position[c] - position[a]);
        for (Vertex v : {a, b, c}) normal[place_of(vertices, v)] += area;
    }
    for (Vec3& n : normal) n = n / norm(n);
    return normal;
}

SurfaceTension surface_tension(const LiquidSurface& surface, const Array<Vertex, Vec3>& position) {
    constexpr double rounding = 1e-9;  // [-] of the area
    const std::size_t count = surface.vertices.size();
    SurfaceTension acts{std::vector<Vec3>(count), surface_normals(surface.facets, surface.vertices, position), {}, 0, 0};
    std::vector<Vec3> pull(count), along(count);  // of the whole tension; of its gradient
    std::vector<double> share(count, 0);          // of the area
    Vec3 all_together;                            // areas as vectors [m^2]
    for (const auto& corners : surface.facets) {
        const Facet facet = facet_of(surface.vertices, corners, position);
        const double area = norm(facet.area);
        double tension = 0;
        Vec3 gradient;  // times the area
        for (std::size_t i = 0; i < 3; ++i) {
            tension += surface.tension[facet.at[i]] / 3;
            gradient += surface.tension[facet.at[i]] * facet.area_gradient[i];
        }
        acts.area += area;
        all_together += facet.area;
        acts.energy += tension * area;
        for (std::size_t i = 0; i < 3; ++i) {
            pull[facet.at[i]] -= tension * facet.area_gradient[i];
            along[facet.at[i]] += gradient / 3;
            share[facet.at[i]] += area / 3;
            for (std::size_t j = 0; j < 3; ++j)
                acts.bonds.push_back({facet.at[i], facet.at[j],
                                      tension / area * dot(facet.area_gradient[i], facet.area_gradient[j])});
        }
    }
    sum_up(acts.bonds);
    const bool is_closed = norm(all_together) <= rounding * acts.area;
    std::vector<Vec3> place;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3& n = acts.normal[i];
        acts.force[i] = dot(pull[i], n) * n + along[i] - dot(along[i], n) * n;
        place.push_back(position[surface.vertices[i]]);
    }
    if (is_closed) {
        take_off_sum(acts.normal, share, acts.force);
        take_off_moment(place, share, acts.force);
    }
    return acts;
}

}  // namespace kropla
