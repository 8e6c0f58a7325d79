#include "simulate/tension.h"

#include <algorithm>
#include <iterator>

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

/// What of a vector is in directions that are 1, not 0.
Vec3 within(const Vec3& free, const Vec3& vector) { return {free.x * vector.x, free.y * vector.y, free.z * vector.z}; }

/// The spin that does this moment to an inertia about each axis about which a motion in the free directions may turn.
Vec3 spin_of(const std::array<Vec3, 3>& inertia, const Vec3& moment, const Vec3& free) {
    if (free == Vec3{1, 1, 1}) return solved(inertia, moment);
    Vec3 spin;
    for (int m = 0; m < 3; ++m)
        if (free[(m + 1) % 3] * free[(m + 2) % 3] != 0) spin[m] = moment[m] / inertia[as_size(m)][m];
    return spin;
}

/// Makes forces have no sum in the free directions, by what is along the directions in which the vertices go: a part along the
/// surface would keep a drop at rest swimming for ever.
void take_off_sum(const std::vector<Vec3>& direction, const std::vector<double>& share, const Vec3& free,
                  std::vector<Vec3>& force) {
    constexpr double rounding = 1e-16;
    Vec3 sum;
    std::array<Vec3, 3> spread = {};
    double all = 0;
    for (std::size_t i = 0; i < force.size(); ++i) {
        sum += within(free, force[i]);
        all += share[i];
        const Vec3 goes = within(free, direction[i]);
        for (int m = 0; m < 3; ++m) spread[as_size(m)] += share[i] * goes[m] * goes;
    }
    for (int m = 0; m < 3; ++m) spread[as_size(m)][m] += (free[m] != 0 ? rounding : 1) * all;  // no direction may have it
    const Vec3 push = solved(spread, sum);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= share[i] * dot(push, direction[i]) * direction[i];
}

/// Makes forces without a sum have no moment, by what a turn in the free directions does to masses as large as the shares.
void take_off_moment(const std::vector<Vec3>& place, const std::vector<double>& share, const Vec3& free,
                     std::vector<Vec3>& force) {
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
        moment += cross(r, within(free, force[i]));
        for (int m = 0; m < 3; ++m) {
            inertia[static_cast<std::size_t>(m)] -= share[i] * r[m] * r;
            inertia[static_cast<std::size_t>(m)][m] += share[i] * squared_norm(r);
        }
    }
    const Vec3 turning = spin_of(inertia, moment, free);
    for (std::size_t i = 0; i < place.size(); ++i) force[i] -= share[i] * cross(turning, place[i] - middle);
}

/// Adds Young's force on a line that moves along its face; returns the energy of what of the face is wetted [J].
double add_young(const LiquidSurface& surface, const ContactLine& line, const Array<Vertex, Vec3>& position,
                 std::vector<Vec3>& young) {
    double tension = 0, area = 0;
    for (Vertex v : line.vertices) tension += surface.tension[place_of(surface.vertices, v)];
    tension /= static_cast<double>(line.vertices.size());
    for (const auto& corners : line.wetted) {
        const Facet facet = facet_of(line.vertices, corners, position);
        area += norm(facet.area);
        for (std::size_t i = 0; i < 3; ++i)
            if (std::ranges::binary_search(line.vertices, corners[i])) {
                const std::size_t at = place_of(surface.vertices, corners[i]);
                young[at] += *line.cosine * surface.tension[at] * facet.area_gradient[i];
            }
    }
    return -*line.cosine * tension * area;
}

/// The directions in which the surface may go as a whole: none across faces on which it ends, and none if it is pinned.
Vec3 free_as_a_whole(const LiquidSurface& surface) {
    Vec3 all{1, 1, 1};
    for (const ContactLine& line : surface.lines)
        if (!line.cosine) return {};
    for (const Vec3& free : surface.free) all = within(all, free);
    return all;
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

std::array<ContactLine, 6> contact_lines(const Mesh& mesh, Region body, std::span<const Vertex> surface) {
    std::array<ContactLine, 6> lines;
    FaceFacets facets = facets_of_faces(mesh, living_cells(mesh, body));
    for (std::size_t face = 0; face < lines.size(); ++face) {
        std::ranges::set_intersection(vertices_of(facets[face]), surface, std::back_inserter(lines[face].vertices));
        lines[face].face = face;
        lines[face].wetted = std::move(facets[face]);
    }
    return lines;
}

std::vector<Vec3> free_directions(std::span<const Vertex> surface, const std::array<ContactLine, 6>& lines) {
    std::vector<Vec3> free;
    for (std::size_t face = 0; face < lines.size(); ++face) {
        if (lines[face].vertices.empty()) continue;
        if (free.empty()) free.assign(surface.size(), {1, 1, 1});
        for (Vertex v : lines[face].vertices) free[place_of(surface, v)][static_cast<int>(face / 2)] = 0;
    }
    return free;
}

std::vector<Vec3> along_faces(std::vector<Vec3> normals, std::span<const Vec3> free) {
    for (std::size_t i = 0; i < free.size(); ++i) {
        if (free[i] == Vec3{1, 1, 1}) continue;
        const Vec3 along = within(free[i], normals[i]);
        normals[i] = norm(along) > 0 ? along / norm(along) : Vec3{};
    }
    return normals;
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
    const std::size_t count = surface.vertices.size();
    SurfaceTension acts{std::vector<Vec3>(count), surface_normals(surface.facets, surface.vertices, position), {}, 0, 0};
    std::vector<Vec3> pull(count), along(count), young(count);  // of the whole tension; of its gradient; of walls
    std::vector<double> share(count, 0);          // of the area
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
    for (const ContactLine& line : surface.lines)
        if (line.cosine) acts.energy += add_young(surface, line, position, young);
    const std::vector<Vec3> direction = along_faces(acts.normal, surface.free);
    std::vector<Vec3> place;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3& n = direction[i];
        const Vec3 free = surface.free.empty() ? Vec3{1, 1, 1} : surface.free[i];
        const Vec3 slides = within(free, along[i]);
        acts.force[i] = dot(pull[i] + young[i], n) * n + slides - dot(slides, n) * n + (pull[i] - within(free, pull[i])) - young[i];
        place.push_back(position[surface.vertices[i]]);
    }
    const Vec3 whole = free_as_a_whole(surface);
    take_off_sum(direction, share, whole, acts.force);
    take_off_moment(place, share, whole, acts.force);
    for (std::size_t i = 0; i < count; ++i) acts.force[i] += young[i];  // which may pull the surface as a whole
    return acts;
}

}  // namespace kropla
