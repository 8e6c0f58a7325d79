#include "flow_problems.h"

#include "base/random.h"
#include "simulate/elements.h"
#include <kropla/mesh/prisms.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

constexpr Vec3 middle{0.5, 0.5, 0.5};

double largest_part(const Vec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }

Array<Vertex, char> on_surface(const Mesh& mesh) {
    Array<Vertex, char> on(mesh.position.size(), 0);
    if (count_regions(mesh) < 2) return on;
    for (const auto& facet : region_surface(mesh, Region(1)).interface)
        for (Vertex v : facet) on[v] = 1;
    return on;
}

/// Over vertices of region 0, weighted by their shares of its volume.
double root_mean_square(const Mesh& mesh, const std::function<double(Vertex)>& error) {
    double sum = 0, volume = 0;
    for_each_share(mesh, living_cells(mesh, surroundings), [&](const auto&, Vertex v, double share) {
        sum += share * error(v) * error(v);
        volume += share;
    });
    return std::sqrt(sum / volume);
}

/// Blows the sphere up until the polyhedron has its volume; the layer keeps its shell.
void give_volume(Mesh& mesh, double radius, double thick) {
    double volume = 0;
    for_each_share(mesh, living_cells(mesh, Region(1)),
                   [&](const auto&, Vertex, double share) { volume += share; });
    const double grown = std::cbrt(4 * std::numbers::pi / 3 * radius * radius * radius / volume);
    Array<Vertex, char> of_body(mesh.position.size(), 0);
    for_each_cell(living_cells(mesh, Region(1)), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) of_body[v] = 1;
    });
    for (Vertex v : mesh.position.indices()) {
        const double r = norm(mesh.position[v]);
        if (of_body[v]) mesh.position[v] = grown * mesh.position[v];
        else if (r < thick)
            mesh.position[v] =
                (1 + (grown - 1) * radius / r * (thick - r) / (thick - radius)) * mesh.position[v];
    }
}

/// The same for the sphere around everything; what is within `thick` stays.
void give_outer_volume(Mesh& mesh, double radius, double thick) {
    double volume = 0;
    for_each_share(mesh, living_cells(mesh), [&](const auto&, Vertex, double share) { volume += share; });
    const double grown = std::cbrt(4 * std::numbers::pi / 3 * radius * radius * radius / volume);
    for (Vec3& x : mesh.position)
        x = (1 + (grown - 1) * std::max(norm(x) - thick, 0.0) / (radius - thick)) * x;
}

}  // namespace

VectorQuantity velocity_of(const std::function<Vec3(const Vec3& place, double t)>& velocity) {
    VectorQuantity parts;
    for (int m = 0; m < 3; ++m)
        parts[static_cast<std::size_t>(m)] = [velocity, m](const Vec3& x, double t) {
            return velocity(x, t)[m];
        };
    return parts;
}

VectorQuantity uniform(const Vec3& velocity) {
    return velocity_of([velocity](const Vec3&, double) { return velocity; });
}

FlowOptions fluid(double density, double viscosity, const VectorQuantity& on_faces) {
    FlowOptions options{.regions = {FlowRegion{.density = density, .viscosity = viscosity}}};
    options.faces.fill({.kind = FlowFace::Kind::velocity, .velocity = on_faces});
    return options;
}

Mesh cube_with_layers(int n, bool inside) {
    const Mesh outside = with_layer(unit_cube_with_body(n), middle, surroundings, 2, 0.3);
    return inside ? with_layer(outside, middle, Region(1), 2, 0.24) : outside;
}

Mesh moved(const Mesh& start, const Vec3& shift, double angle, double shake, std::uint64_t seed) {
    Mesh mesh = start;
    Random random{seed};
    const auto rigid = on_surface(start);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 x = start.position[v], r = x - middle;
        const double s = std::clamp((0.5 - largest_part(r)) / 0.25, 0.0, 1.0);
        const double c = std::cos(s * angle), d = std::sin(s * angle);
        Vec3 place = middle + Vec3{c * r.x - d * r.y, d * r.x + c * r.y, r.z} + s * shift;
        for (int axis = 0; axis < 3; ++axis) {
            const double shaken = random.uniform(-shake, shake);
            if (!rigid[v]) place[axis] += shaken;
            if (x[axis] == 0 || x[axis] == 1) place[axis] = x[axis];
        }
        mesh.position[v] = place;
    }
    return mesh;
}

Mesh sphere_in_cube(const SphereInCube& shape) {
    // Shells of cubes around the middle: the body's, one for the layer, and those that go over to the cube.
    const int body = shape.around, count = body + 1 + shape.out;
    const double thick = shape.radius + shape.layer;
    const auto place = [=](int i, int j, int k) {
        const Vec3 p{1.0 * (i - count), 1.0 * (j - count), 1.0 * (k - count)};
        const int shell = static_cast<int>(std::lround(largest_part(p)));
        if (shell == 0) return Vec3{};
        // Even angles, as seen from the middle of a cube's face, make cells alike.
        Vec3 even = p / shell;
        for (int axis = 0; axis < 3; ++axis) even[axis] = std::tan(even[axis] * std::numbers::pi / 4);
        const Vec3 round = normalised(even), square = shape.round ? round : even / largest_part(even);
        if (shell <= body) return (shape.radius * shell / body) * round;
        const double s = 1.0 * (shell - body - 1) / shape.out;  // 0 at the layer's shell, 1 on the cube
        const double grown = thick * std::pow(shape.half / thick, s);
        return ((1 - s) * grown) * round + (s * grown) * square;
    };
    const auto ring = [count](int i) { return i < count ? count - 1 - i : i - count; };
    const Mesh tets = cube_grid(2 * count, 2 * count, 2 * count, place, [&](int i, int j, int k) {
        return std::max({ring(i), ring(j), ring(k)}) <= body ? 1 : 0;
    });
    Mesh mesh = with_layer(tets, {}, surroundings, shape.prisms, shape.layer / thick);
    give_volume(mesh, shape.radius, thick);
    if (shape.round) give_outer_volume(mesh, shape.half, thick);
    return mesh;
}

std::string in_words(const Mesh& mesh) {
    return std::to_string(mesh.layers[0].triangles.size()) + " triangles on the sphere, " +
           std::to_string(count_prisms(mesh)) + " prisms, " + std::to_string(count_tets(mesh)) + " tets";
}

Vec3 stokes_velocity(const Vec3& place, double radius, double speed) {
    const double r = norm(place), a = radius / r, cosine = place.z / r;
    const Vec3 out = place / r;
    const double radial = speed * cosine * (1 - 1.5 * a + 0.5 * a * a * a);
    const double tangential =
        -speed * (1 - 0.75 * a - 0.25 * a * a * a);  // times the sine, towards rising angles
    return radial * out + tangential * (cosine * out - Vec3{0, 0, 1});
}

double stokes_pressure(const Vec3& place, double radius, double speed) {
    return -1.5 * speed * radius * place.z / std::pow(norm(place), 3);
}

double velocity_error(const Mesh& mesh, const FlowState& state,
                      const std::function<Vec3(const Vec3&)>& exact) {
    return root_mean_square(mesh,
                            [&](Vertex v) { return distance(state.velocity[v], exact(mesh.position[v])); });
}

double pressure_error(const Mesh& mesh, const FlowState& state,
                      const std::function<double(const Vec3&)>& exact) {
    return root_mean_square(mesh, [&](Vertex v) { return state.pressure[v] - exact(mesh.position[v]); });
}

}  // namespace kropla
