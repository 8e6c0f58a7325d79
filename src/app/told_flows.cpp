#include "app/told_flows.h"

#include "base/for_all.h"
#include "simulate/cells.h"

namespace kropla {
namespace {

/// The derivatives along x, y and z of what is of a place, by central differences.
template <class Of>
std::array<Vec3, 3> slopes(const Of& of, const Vec3& x, double size) {
    constexpr double share = 1e-3;  // of the size
    std::array<Vec3, 3> slope;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 aside;
        aside[axis] = share * size;
        slope[as_size(axis)] = (of(x + aside) - of(x - aside)) / (2 * share * size);
    }
    return slope;
}

/// How much of what is at x at t1 was not there at t0, as a share: one less the determinant of the way back.
double grown(const Deformation& deformation, const Vec3& x, double t0, double t1, double size) {
    const auto slope = slopes([&](const Vec3& place) { return deformation(place, t1, t0); }, x, size);
    return 1 - determinant(slope[0], slope[1], slope[2]);
}

/// By three places on the way, within the step: before it and after it nothing need be known.
Vec3 velocity_at(const Deformation& deformation, const Vec3& x, double t, double t0, double t1) {
    constexpr double share = 1e-3;  // of the step
    const double step = (t < 0.5 * (t0 + t1) ? share : -share) * (t1 - t0);
    return (4 * deformation(x, t, t + step) - deformation(x, t, t + 2 * step) - 3 * x) / (2 * step);
}

}  // namespace

bool is_told(const Case& given, std::size_t body) {
    return given.domain.bodies[body].deformation && given.liquid[body] == 0 && !rests_on_faces(given, body);
}

std::vector<ToldFlow> told_flows(const Case& given, const Mesh& current, double t0, double t1) {
    std::vector<ToldFlow> flows;
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body) {
        if (!is_told(given, body)) continue;
        const Deformation& deformation = given.domain.bodies[body].deformation;
        const bool may_expand = !given.written_bodies[body].velocity.empty();  // paths are rigid
        const std::vector<Vertex> vertices = vertices_of(current, living_cells(current, region_of_body(body)));
        ToldFlow& flow = flows.emplace_back(region_of_body(body), Array<Vertex, Vec3>(current.position.size()));
        if (may_expand) flow.expansion.resize(current.position.size(), 0.0);
        for_all(vertices.size(), [&](std::size_t k) {
            const Vec3& x = current.position[vertices[k]];
            flow.velocity[vertices[k]] = (x - deformation(x, t1, t0)) / (t1 - t0);
            if (may_expand)
                flow.expansion[vertices[k]] = grown(deformation, x, t0, t1, asked_size(given.domain, body)) / (t1 - t0);
        });
    }
    return flows;
}

std::vector<VectorField> told_surfaces(const Case& given, double t0, double t1) {
    std::vector<VectorField> surfaces(given.domain.bodies.size());
    for (std::size_t body = 0; body < surfaces.size(); ++body) {
        if (!is_told(given, body)) continue;
        surfaces[body] = [&deformation = given.domain.bodies[body].deformation, t0, t1](const Vec3& x, double t) {
            return velocity_at(deformation, x, t, t0, t1);
        };
    }
    return surfaces;
}

Vec3 told_spin(const Case& given, std::size_t body, const Vec3& centre, double t0, double t1) {
    const Deformation& deformation = given.domain.bodies[body].deformation;
    const auto slope = slopes([&](const Vec3& x) { return velocity_at(deformation, x, t1, t0, t1); }, centre,
                              asked_size(given.domain, body));
    return 0.5 * Vec3{slope[1].z - slope[2].y, slope[2].x - slope[0].z, slope[0].y - slope[1].x};
}

}  // namespace kropla
