#include "app/flow_fields.h"

#include "case/heat.h"
#include "app/species_fields.h"
#include "simulate/cells.h"
#include "simulate/step_mean.h"
#include <kropla/mesh/prisms.h>

#include <fmt/format.h>

#include <array>

namespace kropla {
namespace {

constexpr std::array<const char*, 3> components = {"velocity_x", "velocity_y", "velocity_z"};

Vec3 middle_of_surface(const Mesh& mesh, Region body) {
    Vec3 sum;
    double area = 0;
    for (const auto& facet : region_surface(mesh, body).interface) {
        const double size = norm(area_vector(mesh, facet));
        for (Vertex v : facet) sum += size / 3 * mesh.position[v];
        area += size;
    }
    return area > 0 ? sum / area : Vec3{};
}

/// The pressure of what rests under gravity, of a liquid such that it is that around at the middle of its surface: so the first
/// step has to find what moves alone, and what rests does from the start. `of` is of the surroundings, then of liquids.
void start_at_rest(const Mesh& mesh, const Case& given, const std::vector<NodalField*>& of) {
    const FlowOptions& flow = given.flow->options;
    const Vec3 middle = 0.5 * (given.domain.box.min + given.domain.box.max);
    const double outer = flow.regions[0]->density(0);
    std::vector<Region> regions = liquids_of(given);
    regions.insert(regions.begin(), Region(0));
    for (std::size_t k = 0; k < regions.size(); ++k) {
        const double density = flow.regions[as_size(regions[k].value)]->density(0);
        const double level = k == 0 ? 0 : (outer - density) * dot(flow.gravity, middle_of_surface(mesh, regions[k]) - middle);
        for (Vertex v : vertices_of(mesh, living_cells(mesh, regions[k])))
            of[k]->values[v] = level + density * dot(flow.gravity, mesh.position[v] - middle);
    }
}

}  // namespace

std::size_t place_of_flow(const Case& given) { return (given.heat ? 1 : 0) + species_fields(given).size(); }

std::size_t count_flow_fields(const Case& given) {
    const std::size_t liquids = liquids_of(given).size();
    return (expands(given) ? 5 : 4) + (liquids > 0 ? liquids + 3 : 0);
}

std::vector<Region> liquids_of(const Case& given) {
    std::vector<Region> liquids;
    for (std::size_t body = 0; body < given.liquid.size(); ++body)
        if (given.liquid[body] != 0) liquids.push_back(region_of_body(body));
    return liquids;
}

std::vector<Carrying> carrying_of_flow(const Case& given) {
    const std::vector<Region> liquids = liquids_of(given);
    std::vector<Carrying> how(count_flow_fields(given), {.only = Region(0), .limit = false});
    if (expands(given)) how[4].limit = true;  // the density has no new extrema
    if (liquids.empty()) return how;
    Carrying of_all{.limit = false};  // momentum is kept
    for (const auto& region : given.flow->options.regions) of_all.weight.push_back(region ? region->density(0) : 1);
    for (std::size_t k = 0; k < 3; ++k) how[k] = how[how.size() - 3 + k] = of_all;
    for (std::size_t k = 0; k < liquids.size(); ++k) how[how.size() - 3 - liquids.size() + k].only = liquids[k];
    return how;
}

Array<Vertex, Vec3> flow_rate(const Case& given, std::span<const NodalField> fields) {
    const auto rate = fields.subspan(place_of_flow(given) + count_flow_fields(given) - 3, 3);
    Array<Vertex, Vec3> all(rate[0].values.size());
    for (Vertex v : all.indices()) all[v] = {rate[0].values[v], rate[1].values[v], rate[2].values[v]};
    return all;
}

void keep_flow_rate(const Case& given, const Array<Vertex, Vec3>& rate, std::span<NodalField> fields) {
    const auto kept = fields.subspan(place_of_flow(given) + count_flow_fields(given) - 3, 3);
    for (Vertex v : rate.indices())
        for (int axis = 0; axis < 3; ++axis) kept[as_size(axis)].values[v] = rate[v][axis];
}

bool expands(const Case& given) { return given.flow && !given.flow->options.regions[0]->density.constant(); }

std::vector<NodalField> initial_flow(const Mesh& mesh, const Case& given, const Array<Vertex, double>& temperature) {
    std::vector<NodalField> fields;
    const std::size_t vertices = mesh.position.size();
    for (const char* name : components) fields.push_back({name, "m/s", Array<Vertex, double>(vertices, 0.0)});
    fields.push_back({"pressure", "Pa", Array<Vertex, double>(vertices, 0.0)});
    if (expands(given)) {
        fields.push_back({"density", "kg/m^3", Array<Vertex, double>(vertices, 0.0)});
        for (Vertex v : mesh.position.indices()) fields.back().values[v] = given.flow->options.regions[0]->density(temperature[v]);
    }
    const std::vector<Region> liquids = liquids_of(given);
    for (Region liquid : liquids)
        fields.push_back({"pressure_" + region_name(given.domain, as_size(liquid.value)), "Pa", Array<Vertex, double>(vertices, 0.0)});
    for (const char* name : {"rate_x", "rate_y", "rate_z"})
        if (!liquids.empty()) fields.push_back({name, "m/s^2", Array<Vertex, double>(vertices, 0.0)});
    if (!expands(given)) {
        std::vector<NodalField*> pressures = {&fields[3]};
        for (std::size_t k = 0; k < liquids.size(); ++k) pressures.push_back(&fields[4 + k]);
        start_at_rest(mesh, given, pressures);
    }
    for (std::size_t r = 0; r < given.flow->initial.size(); ++r) {
        const std::string key = fmt::format("flow.region.{}.initial", region_name(given.domain, r));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Quantity& start = given.flow->initial[r][axis];
            if (!start) continue;
            for_each_cell(living_cells(mesh, Region(r)), [&](const auto& cell) {
                for (Vertex v : cell_vertices(mesh, cell)) fields[axis].values[v] = value_at(start, mesh.position[v], 0, key);
            });
        }
    }
    return fields;
}

std::vector<NodalField> shown_pressures(const Mesh& mesh, const Case& given, std::span<const NodalField> fields) {
    FlowState flow = flow_state(given, fields);
    std::vector<NodalField> shown = {{"pressure", "Pa", std::move(flow.pressure)}};
    if (flow.within.empty()) return shown;
    NodalField within{"pressure_within", "Pa", shown[0].values};
    for (Region liquid : liquids_of(given))
        for_each_cell(living_cells(mesh, liquid), [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell)) within.values[v] = flow.within[as_size(liquid.value - 1)][v];
        });
    Array<Vertex, char> outside(mesh.position.size(), 0);
    for_each_cell(living_cells(mesh, Region(0)), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) outside[v] = 1;
    });
    for (Vertex v : outside.indices())
        if (!outside[v]) shown[0].values[v] = within.values[v];
    shown.push_back(std::move(within));
    return shown;
}

CellField mean_pressure(const Mesh& mesh, const Case& given, std::span<const NodalField> fields) {
    const FlowState flow = flow_state(given, fields);
    CellField means{"pressure_mean", "Pa", {}};
    const auto add = [&](Region region, const auto& vertices) {
        const bool in_liquid = region.value > 0 && given.liquid[as_size(region.value - 1)] != 0;
        const Array<Vertex, double>& pressure = in_liquid ? flow.within[as_size(region.value - 1)] : flow.pressure;
        double sum = 0;
        for (Vertex v : vertices) sum += pressure[v];
        means.values.push_back(sum / static_cast<double>(vertices.size()));
    };
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t)) add(mesh.region[t], mesh.tets[t]);
    for (const Prism& prism : all_prisms(mesh)) add(layer_of(mesh, prism.layer).region, prism_vertices(mesh, prism));
    return means;
}

FlowState flow_state(const Case& given, std::span<const NodalField> fields) {
    const auto flow = fields.subspan(place_of_flow(given), count_flow_fields(given));
    FlowState state{Array<Vertex, Vec3>(flow[0].values.size()), flow[3].values};
    if (expands(given)) state.density = flow[4].values;
    const std::vector<Region> liquids = liquids_of(given);
    if (!liquids.empty()) state.within.assign(given.domain.bodies.size(), state.pressure);
    for (std::size_t k = 0; k < liquids.size(); ++k)
        state.within[as_size(liquids[k].value - 1)] = flow[flow.size() - 3 - liquids.size() + k].values;
    for (Vertex v : state.velocity.indices()) state.velocity[v] = {flow[0].values[v], flow[1].values[v], flow[2].values[v]};
    return state;
}

void keep_flow(const Case& given, const FlowState& flow, std::span<NodalField> fields) {
    const auto kept = fields.subspan(place_of_flow(given), count_flow_fields(given));
    for (Vertex v : flow.velocity.indices())
        for (int axis = 0; axis < 3; ++axis) kept[as_size(axis)].values[v] = flow.velocity[v][axis];
    kept[3].values = flow.pressure;
    if (expands(given)) kept[4].values = flow.density;
    const std::vector<Region> liquids = liquids_of(given);
    for (std::size_t k = 0; k < liquids.size(); ++k)
        kept[kept.size() - 3 - liquids.size() + k].values = flow.within[as_size(liquids[k].value - 1)];
}

}  // namespace kropla
