#include "simulate/flow_energy.h"

#include <tuple>
#include <type_traits>

namespace kropla {
namespace {

/// Calls `visit(vertices, points of the cell, material)`.
template <class Visit>
void for_each_points(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& position,
                     const Array<Region, FlowMaterial>& material, const Visit& visit) {
    for_each_cell(cells, [&](const auto& cell) {
        visit(cell_vertices(mesh, cell), cell_points(corners(position, mesh, cell)), material[cell_region(mesh, cell)]);
    });
}

}  // namespace

FlowEnergy flow_energy(const Mesh& mesh, const Cells& cells, const Array<Region, FlowMaterial>& material,
                       const Array<Vertex, Vec3>& velocity, const Vec3& gravity) {
    FlowEnergy energy;
    for_each_points(mesh, cells, mesh.position, material, [&](const auto& vertices, const auto& points, const FlowMaterial& of) {
        constexpr std::size_t n = std::tuple_size_v<std::remove_cvref_t<decltype(vertices)>>;
        const double density = mean_property(of.density, of.densities, vertices);
        const auto u = at_corners(velocity, vertices);
        for (std::size_t k = 0; k < points.size(); ++k)
            for (std::size_t i = 0; i < n; ++i) {
                energy.gravity -= density * points[k].volume * shape_means<n>[k].value[i] * dot(gravity, mesh.position[vertices[i]]);
                for (std::size_t j = 0; j < n; ++j)
                    energy.kinetic += 0.5 * density * points[k].volume * shape_means<n>[k].product[i][j] * dot(u[i], u[j]);
            }
    });
    return energy;
}

Vec3 momentum(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& position,
              const Array<Region, FlowMaterial>& material, const Array<Vertex, Vec3>& velocity) {
    Vec3 sum;
    for_each_points(mesh, cells, position, material, [&](const auto& vertices, const auto& points, const FlowMaterial& of) {
        const double density = mean_property(of.density, of.densities, vertices);
        const auto u = at_corners(velocity, vertices);
        for (std::size_t k = 0; k < points.size(); ++k) sum += density * points[k].volume * mean_value(k, u);
    });
    return sum;
}

Vec3 inertia(const FlowStage& stage, const Cells& cells) {
    Vec3 sum;
    for_each_points(stage.mesh, cells, stage.position, stage.material, [&](const auto& vertices, const auto& points, const FlowMaterial& of) {
        const double density = mean_property(of.density, of.densities, vertices);
        const auto u = at_corners(stage.guess.velocity, vertices);
        auto change = u, past = u;  // since `old`, and the mesh
        for (std::size_t i = 0; i < u.size(); ++i) {
            change[i] -= stage.old[vertices[i]];
            if (!stage.mesh_velocity.empty()) past[i] -= stage.mesh_velocity[vertices[i]];
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            sum += density * points[k].volume * stage.per_time * mean_value(k, change);
            const Vec3 carrying = mean_value(k, past);
            for (std::size_t i = 0; i < u.size(); ++i) sum += density * dot(carrying, points[k].volume_gradient[i]) * u[i];
        }
    });
    return sum;
}

double dissipation(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& position,
                   const Array<Region, FlowMaterial>& material, const Array<Vertex, Vec3>& velocity) {
    double sum = 0;
    for_each_points(mesh, cells, position, material, [&](const auto& vertices, const auto& points, const FlowMaterial& of) {
        const double viscosity = mean_property(of.viscosity, of.viscosities, vertices);
        for (const auto& point : points) {
            std::array<Vec3, 3> slope = {};  // row m: grad u_m
            for (std::size_t i = 0; i < vertices.size(); ++i)
                for (int m = 0; m < 3; ++m)
                    slope[static_cast<std::size_t>(m)] += velocity[vertices[i]][m] / point.volume * point.volume_gradient[i];
            for (int m = 0; m < 3; ++m)
                for (int c = 0; c < 3; ++c) {
                    const double shear = slope[static_cast<std::size_t>(m)][c] + slope[static_cast<std::size_t>(c)][m];
                    sum += 0.5 * viscosity * point.volume * shear * shear;
                }
        }
    });
    return sum;
}

}  // namespace kropla
