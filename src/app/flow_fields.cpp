#include "app/flow_fields.h"

#include "app/case_heat.h"
#include "app/species_fields.h"
#include "simulate/cells.h"
#include "simulate/step_mean.h"

#include <fmt/format.h>

#include <array>

namespace kropla {
namespace {

constexpr std::array<const char*, 3> components = {"velocity_x", "velocity_y", "velocity_z"};

}  // namespace

std::size_t place_of_flow(const Case& it) { return (it.heat ? 1 : 0) + species_fields(it).size(); }

std::size_t count_flow_fields(const Case& it) { return expands(it) ? 5 : 4; }

bool expands(const Case& it) { return it.flow && !it.flow->options.regions[0]->density.constant(); }

std::vector<NodalField> initial_flow(const Mesh& mesh, const Case& it, const Array<Vertex, double>& temperature) {
    std::vector<NodalField> fields;
    const std::size_t vertices = mesh.position.size();
    for (const char* name : components) fields.push_back({name, "m/s", Array<Vertex, double>(vertices, 0.0)});
    fields.push_back({"pressure", "Pa", Array<Vertex, double>(vertices, 0.0)});
    if (expands(it)) {
        fields.push_back({"density", "kg/m^3", Array<Vertex, double>(vertices, 0.0)});
        for (Vertex v : mesh.position.indices()) fields.back().values[v] = it.flow->options.regions[0]->density(temperature[v]);
    }
    for (std::size_t r = 0; r < it.flow->initial.size(); ++r) {
        const std::string key = fmt::format("flow.region.{}.initial", region_name(it.domain, r));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Quantity& start = it.flow->initial[r][axis];
            if (!start) continue;
            for_each_cell(living_cells(mesh, Region(r)), [&](const auto& cell) {
                for (Vertex v : cell_vertices(mesh, cell)) fields[axis].values[v] = value_at(start, mesh.position[v], 0, key);
            });
        }
    }
    return fields;
}

FlowState flow_state(const Case& it, std::span<const NodalField> fields) {
    const auto flow = fields.subspan(place_of_flow(it), count_flow_fields(it));
    FlowState state{Array<Vertex, Vec3>(flow[0].values.size()), flow[3].values};
    if (expands(it)) state.density = flow[4].values;
    for (Vertex v : state.velocity.indices()) state.velocity[v] = {flow[0].values[v], flow[1].values[v], flow[2].values[v]};
    return state;
}

void keep_flow(const Case& it, const FlowState& flow, std::span<NodalField> fields) {
    const auto kept = fields.subspan(place_of_flow(it), count_flow_fields(it));
    for (Vertex v : flow.velocity.indices())
        for (int axis = 0; axis < 3; ++axis) kept[as_size(axis)].values[v] = flow.velocity[v][axis];
    kept[3].values = flow.pressure;
    if (expands(it)) kept[4].values = flow.density;
}

// The derivative of the motion by differences over a small part of the step; of the rotation, R' R^T is the spin's cross.
RigidVelocity velocity_of(const Body& body, double t, double dt) {
    constexpr double part = 1e-3;  // [-] of the step: the cube of it is lost, as is rounding over it
    const double h = part * dt;
    const Pose before = body.motion(t - h), after = body.motion(t + h), now = body.motion(t);
    RigidVelocity velocity{body.shape.centre + now.displacement, (after.displacement - before.displacement) / (2 * h), {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit;
        unit[axis] = 1;
        const Vec3 e = rotated(now.rotation, unit);
        const Vec3 rate = (rotated(after.rotation, unit) - rotated(before.rotation, unit)) / (2 * h);
        velocity.spin += 0.5 * cross(e, rate);
    }
    return velocity;
}

}  // namespace kropla
