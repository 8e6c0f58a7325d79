// What acts on a step of a flow: surfaces and what is given there, forces, materials.
#include "simulate/flow_conditions.h"

#include <kropla/base/error.h>
#include <kropla/mesh/cells.h>
#include <kropla/mesh/topology.h>
#include "simulate/elements.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <sstream>

namespace kropla {
namespace {

constexpr double unbalanced =
    0.01;  // [-] of all that passes the boundary: beyond what its facets' shape explains
constexpr double rounding = 1e-12;  // [-] of a place: as far in a step is as good as at rest
constexpr double along = 1e-6;  // [-] of a velocity: with less across a facet it goes along it
constexpr std::array<const char*, 6> face_names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

bool is_fluid(const FlowOptions& options, Region region) {
    return options.regions[static_cast<std::size_t>(region.value)].has_value();
}

Vec3 centre_of(const Mesh& mesh, Region body) {
    Vec3 sum;
    double volume = 0;
    for_each_share(mesh, living_cells(mesh, body), [&](const auto&, Vertex v, double share) {
        sum += share * mesh.position[v];
        volume += share;
    });
    return volume > 0 ? sum / volume : Vec3{};
}

/// The velocity of a body, or nothing: as its surface moves.
const std::function<RigidVelocity(double)>* motion_of(const FlowOptions& options, Region body) {
    const auto number = static_cast<std::size_t>(body.value - 1);
    if (number >= options.bodies.size() || !options.bodies[number]) return nullptr;
    return &options.bodies[number];
}

Vec3 rigid_velocity(const RigidVelocity& body, const Vec3& place) {
    return body.velocity + cross(body.spin, place - body.centre);
}

Vec3 value_of(const VectorQuantity& quantity, const Vec3& place, double t) {
    Vec3 value;
    for (std::size_t m = 0; m < 3; ++m)
        if (quantity[m]) value[static_cast<int>(m)] = quantity[m](place, t);
    return value;
}

[[noreturn]] void refuse(const std::string& key, const Vec3& value, const Vec3& place, double t) {
    std::ostringstream message;
    message << key << " must be finite, got (" << value.x << ", " << value.y << ", " << value.z << ") at ("
            << place.x << ", " << place.y << ", " << place.z << ") m, t = " << t << " s";
    throw CaseError(message.str());
}

/// A step, and what it starts from.
struct Step {
    const Mesh &before, &current;
    const FlowOptions& options;
    const Array<Vertex, Vec3>& velocity;
    double t, dt;
};

/// A velocity that is given at all times, at a vertex on its way: at the step's end, with its rate there by
/// the parabola through three times. A steady state has no rates, and a mesh that stands where it is at the
/// end.
template <class Given>
void fix(const Step& step, Vertex v, const Given& given, const std::string& key, FlowConditions& conditions) {
    const Vec3 &x0 = step.before.position[v], &x1 = step.current.position[v];
    const double end = step.t + step.dt;
    conditions.fixed[v] = {true, true, true};
    conditions.end[v] = given(x1, end);
    conditions.rate[v] = {};
    if (step.options.scheme == FlowScheme::second_order)
        conditions.rate[v] =
            (1 / step.dt) *
            (given(x0, step.t) - 4 * given(0.5 * (x0 + x1), step.t + 0.5 * step.dt) + 3 * conditions.end[v]);
    if (!is_finite(conditions.end[v]) || !is_finite(conditions.rate[v]))
        refuse(key, conditions.end[v], x1, end);
}

void fix_face(const Step& step, std::size_t face, const std::vector<Vertex>& vertices,
              FlowConditions& conditions) {
    const std::string key = step.options.key + ".face." + face_names[face] + ".velocity";
    const VectorQuantity& velocity = step.options.faces[face].velocity;
    for (Vertex v : vertices)
        fix(
            step, v, [&](const Vec3& place, double t) { return value_of(velocity, place, t); }, key,
            conditions);
}

void let_slip(std::size_t face, const std::vector<Vertex>& vertices, FlowConditions& conditions) {
    for (Vertex v : vertices) conditions.fixed[v][face / 2] = true;
}

/// Of the faces of a kind, and of other walls if it is that.
std::vector<std::array<Vertex, 3>> facets_of(FlowFace::Kind kind, const FlowOptions& options, const FlowBoundary& boundary) {
    std::vector<std::array<Vertex, 3>> facets;
    if (kind == FlowFace::Kind::wall) facets = boundary.fixed_walls;
    for (std::size_t face = 0; face < 6; ++face)
        if (options.faces[face].kind == kind)
            facets.insert(facets.end(), boundary.faces[face].begin(), boundary.faces[face].end());
    return facets;
}

/// Of what is given at the marked vertices of the facet, only what goes along it is left.
void keep_along(const std::array<Vertex, 3>& facet, const Array<Vertex, Vec3>& position, const Array<Vertex, char>& marked,
                FlowConditions& conditions) {
    const Vec3 normal = normalised(cross(position[facet[1]] - position[facet[0]], position[facet[2]] - position[facet[0]]));
    for (Vertex v : facet) {
        if (marked[v] == 0) continue;
        for (Vec3* given : {&conditions.end[v], &conditions.rate[v]})
            if (const double through = dot(*given, normal); std::abs(through) > along * norm(*given)) *given -= through * normal;
    }
}

/// The velocity of a body's surface, or nothing: as the mesh moves.
VectorField velocity_of_surface(const FlowOptions& options, Region body) {
    if (const auto number = as_size(body.value - 1); number < options.surfaces.size() && options.surfaces[number])
        return options.surfaces[number];
    const auto* const motion = motion_of(options, body);
    if (motion == nullptr) return {};
    return [motion](const Vec3& place, double t) { return rigid_velocity((*motion)(t), place); };
}

void fix_solid(const Step& step, const SolidSurface& solid, FlowConditions& conditions) {
    if (const VectorField given = velocity_of_surface(step.options, solid.body)) {
        const std::string key =
            step.options.key + ".region." + std::to_string(solid.body.value) + ".velocity";
        for (Vertex v : solid.vertices) fix(step, v, given, key, conditions);
        return;
    }
    for (Vertex v : solid.vertices) {
        conditions.fixed[v] = {true, true, true};
        conditions.end[v] = (step.current.position[v] - step.before.position[v]) / step.dt;
        conditions.rate[v] = (conditions.end[v] - step.velocity[v]) / step.dt;
    }
}

/// Facets of faces that nothing passes have vertices in common with a body that comes in through them: with its velocity there
/// gas would come in beside it.
void fix_solids(const Step& step, const std::vector<SolidSurface>& solids,
                std::initializer_list<const std::vector<std::array<Vertex, 3>>*> not_passed, FlowConditions& conditions) {
    Array<Vertex, char> of_solids(step.current.position.size(), 0);
    for (const SolidSurface& solid : solids) {
        fix_solid(step, solid, conditions);
        for (Vertex v : solid.vertices) of_solids[v] = 1;
    }
    for (const auto* facets : not_passed)
        for (const auto& facet : *facets) keep_along(facet, step.current.position, of_solids, conditions);
}

[[noreturn]] void refuse_net_flux(const Step& step, double net, const Vec3* place) {
    std::ostringstream message;
    message << step.options.key << ": " << std::abs(net) << " m^3/s flow "
            << (net < 0 ? "in without a way out" : "out and nothing in") << " at t = " << step.t + step.dt << " s";
    if (place != nullptr) message << ", in the part at (" << place->x << ", " << place->y << ", " << place->z << ") m";
    message << ": open a face, or let the given velocities balance";
    throw CaseError(message.str());
}

void check_way_out(const Step& step, const Pattern& pattern, const FlowBoundary& boundary,
                   const FlowConditions& conditions) {
    const Array<Vertex, Vec3>& x = step.current.position;
    std::vector<double> net(conditions.closed.size(), 0.0), size(net), noise(net);
    std::vector<Vertex> at(net.size());
    const auto add = [&](const auto& facets) {
        for (const auto& facet : facets) {
            const std::size_t piece = pattern.piece_of(facet[0]);
            const double flux = flux_through({facet}, x, conditions.end);
            net[piece] += flux;
            size[piece] += std::abs(flux);
            noise[piece] += rounding * norm(cross(x[facet[1]] - x[facet[0]], x[facet[2]] - x[facet[0]])) * norm(x[facet[0]]) / step.dt;
            if (flux != 0) at[piece] = facet[0];
        }
    };
    for (std::size_t face = 0; face < 6; ++face)
        if (step.options.faces[face].kind == FlowFace::Kind::velocity) add(boundary.faces[face]);
    for (const SolidSurface& solid : boundary.solids) add(solid.facets);
    for (std::size_t p = 0; p < net.size(); ++p)
        if (conditions.closed[p] != 0 && std::abs(net[p]) > unbalanced * size[p] + noise[p])
            refuse_net_flux(step, net[p], net.size() > 1 ? &x[at[p]] : nullptr);
}

/// Directions out of the bodies whose surfaces are told a velocity at each place, but at faces of the box.
Array<Vertex, Vec3> normals_of_told(const Step& step, const FlowBoundary& boundary) {
    const Array<Vertex, Vec3>& x = step.current.position;
    Array<Vertex, Vec3> normals(x.size());
    for (const SolidSurface& solid : boundary.solids) {
        const auto number = as_size(solid.body.value - 1);
        if (number >= step.options.surfaces.size() || !step.options.surfaces[number]) continue;
        for (const auto& [a, b, c] : solid.facets)
            for (Vertex v : {a, b, c}) normals[v] -= cross(x[b] - x[a], x[c] - x[a]);
    }
    for (const auto& facets : boundary.faces)
        for (Vertex v : vertices_of(facets)) normals[v] = {};
    for (Vec3& normal : normals)
        if (squared_norm(normal) > 0) normal = normalised(normal);
    return normals;
}

/// Between vertices a velocity is straight, and facets let in a little of what it does not where it bends: in parts without a way
/// out that is taken back, evenly along normals.
void balance_surfaces(const Step& step, const Pattern& pattern, const FlowBoundary& boundary, FlowConditions& conditions) {
    if (std::ranges::none_of(step.options.surfaces, [](const VectorField& given) { return bool(given); })) return;
    const Array<Vertex, Vec3> normals = normals_of_told(step, boundary);
    const auto fluxes = [&](const Array<Vertex, Vec3>& velocity) {
        std::vector<double> net(conditions.closed.size(), 0.0);
        const auto add = [&](const auto& facets) {
            for (const auto& facet : facets) net[pattern.piece_of(facet[0])] += flux_through({facet}, step.current.position, velocity);
        };
        for (std::size_t face = 0; face < 6; ++face)
            if (step.options.faces[face].kind == FlowFace::Kind::velocity) add(boundary.faces[face]);
        for (const SolidSurface& solid : boundary.solids) add(solid.facets);
        return net;
    };
    const std::vector<double> out = fluxes(normals);
    for (Array<Vertex, Vec3>* const given : {&conditions.end, &conditions.rate}) {
        const std::vector<double> net = fluxes(*given);
        for (Vertex v : normals.indices()) {
            if (normals[v] == Vec3{}) continue;
            const std::size_t piece = pattern.piece_of(v);
            if (conditions.closed[piece] != 0 && out[piece] != 0) (*given)[v] -= net[piece] / out[piece] * normals[v];
        }
    }
}

/// Where it ends on faces of the box, as the options have it.
void set_lines(const Mesh& mesh, const FlowOptions& options, LiquidSurface& liquid) {
    auto lines = contact_lines(mesh, liquid.body, liquid.vertices);
    liquid.free = free_directions(liquid.vertices, lines);
    const auto number = static_cast<std::size_t>(liquid.body.value - 1);
    for (std::size_t face = 0; face < lines.size(); ++face) {
        if (lines[face].vertices.empty()) continue;
        if (number < options.contact.size())
            if (const auto& angle = options.contact[number][face]) lines[face].cosine = std::cos(*angle * std::numbers::pi / 180);
        liquid.lines.push_back(std::move(lines[face]));
    }
}

LiquidSurface liquid_surface(const Mesh& mesh, const FlowOptions& options, Region body,
                             const Array<Vertex, double>& temperature) {
    LiquidSurface liquid{body, region_surface(mesh, body).interface, {}, {}};
    liquid.vertices = vertices_of(liquid.facets);
    if (const auto &within = options.regions[as_size(body.value)], &around = options.regions.front(); within && around)
        liquid.denser = within->density(0) - around->density(0);
    set_lines(mesh, options, liquid);
    liquid.tension.assign(liquid.vertices.size(), 0);
    const auto number = static_cast<std::size_t>(body.value - 1);
    if (number >= options.tension.size() || !options.tension[number]) return liquid;
    const Property& tension = *options.tension[number];
    const std::string key = options.key + ".surface." + std::to_string(body.value) + ".tension";
    if (temperature.empty() && !tension.constant())
        throw CaseError(key + " depends on the temperature, and there is none");
    for (std::size_t i = 0; i < liquid.vertices.size(); ++i) {
        const double value = tension(temperature.empty() ? 0 : temperature[liquid.vertices[i]]);
        if (!(std::isfinite(value) && value >= 0)) {
            std::ostringstream message;
            message << key << " must not be negative, got " << value;
            if (!temperature.empty()) message << " at " << temperature[liquid.vertices[i]] << " K";
            throw CaseError(message.str());
        }
        liquid.tension[i] = value;
    }
    return liquid;
}

/// The facets between what flows and what does not, or flows as another region; ascending.
std::vector<std::array<Vertex, 3>> ends_of_flow(const Mesh& mesh, const FlowOptions& options) {
    std::vector<std::array<Vertex, 3>> ends;
    for (std::size_t r = 0; r < options.regions.size(); ++r)
        if (is_fluid(options, Region(r)))
            for (const auto& facet : region_surface(mesh, Region(r)).interface) ends.push_back(sorted(facet));
    std::ranges::sort(ends);
    return ends;
}

}  // namespace

Cells flow_cells(const Mesh& mesh, const FlowOptions& options) {
    Cells all = living_cells(mesh), cells;
    for (Tet t : all.tets)
        if (is_fluid(options, cell_region(mesh, t))) cells.tets.push_back(t);
    for (const Prism& prism : all.prisms)
        if (is_fluid(options, cell_region(mesh, prism))) cells.prisms.push_back(prism);
    return cells;
}

FlowBoundary flow_boundary(const Mesh& mesh, const FlowOptions& options, double t,
                           const Array<Vertex, double>& temperature) {
    FlowBoundary boundary;
    const Cells cells = flow_cells(mesh, options);
    boundary.faces = facets_of_faces(mesh, cells);
    boundary.fixed_walls = facets_of_fixed_walls(mesh, cells);
    const auto ends = ends_of_flow(mesh, options);
    for (std::size_t r = 1; r < options.regions.size(); ++r) {
        const Region body(r);
        if (is_fluid(options, body)) {
            LiquidSurface liquid = liquid_surface(mesh, options, body, temperature);
            if (!liquid.facets.empty()) boundary.liquids.push_back(std::move(liquid));
            continue;
        }
        const auto* const motion = motion_of(options, body);
        SolidSurface solid{body, motion != nullptr ? (*motion)(t).centre : centre_of(mesh, body),
                           region_surface(mesh, body).interface, {}};
        for (auto& facet : solid.facets) std::swap(facet[1], facet[2]);
        std::erase_if(solid.facets, [&](const auto& facet) { return !std::ranges::binary_search(ends, sorted(facet)); });
        solid.vertices = vertices_of(solid.facets);
        if (!solid.facets.empty()) boundary.solids.push_back(std::move(solid));
    }
    return boundary;
}

FlowConditions flow_conditions(const Mesh& before, const Mesh& current, const FlowOptions& options,
                               const Pattern& pattern, const FlowBoundary& boundary,
                               const Array<Vertex, Vec3>& velocity, double t, double dt) {
    const std::size_t count = current.position.size();
    FlowConditions conditions{Array<Vertex, std::array<bool, 3>>(count, {false, false, false}),
                              Array<Vertex, Vec3>(count), Array<Vertex, Vec3>(count), {},
                              std::vector<char>(as_size(pattern.rows.pieces), 1)};
    const Step step{before, current, options, velocity, t, dt};
    std::array<std::vector<Vertex>, 6> vertices;
    for (std::size_t face = 0; face < 6; ++face) vertices[face] = vertices_of(boundary.faces[face]);
    for (std::size_t face = 0; face < 6; ++face) {
        if (options.faces[face].kind == FlowFace::Kind::slip) let_slip(face, vertices[face], conditions);
        conditions.open[face] = options.faces[face].kind == FlowFace::Kind::open;
        if (conditions.open[face])
            for (Vertex v : vertices[face]) conditions.closed[pattern.piece_of(v)] = 0;
    }
    Array<Vertex, char> passing(count, 0);  // vertices at which what is given passes its face
    for (std::size_t face = 6; face-- > 0;)
        if (options.faces[face].kind == FlowFace::Kind::velocity) {
            fix_face(step, face, vertices[face], conditions);
            for (Vertex v : vertices[face]) passing[v] = conditions.end[v][static_cast<int>(face / 2)] != 0 ? 1 : 0;
        }
    const auto walls = facets_of(FlowFace::Kind::wall, options, boundary),
               slipping = facets_of(FlowFace::Kind::slip, options, boundary);
    for (const auto* facets : {&walls, &slipping})
        for (const auto& facet : *facets) keep_along(facet, current.position, passing, conditions);
    const auto at_rest = [](const Vec3&, double) { return Vec3{}; };
    for (Vertex v : vertices_of(walls))
        if (passing[v] == 0) fix(step, v, at_rest, "", conditions);
    for (const LiquidSurface& liquid : boundary.liquids)
        for (const ContactLine& line : liquid.lines)
            if (!line.cosine && options.faces[line.face].kind == FlowFace::Kind::slip)
                for (Vertex v : line.vertices) fix(step, v, at_rest, "", conditions);
    fix_solids(step, boundary.solids, {&walls, &slipping}, conditions);
    check_way_out(step, pattern, boundary, conditions);
    balance_surfaces(step, pattern, boundary, conditions);
    return conditions;
}

std::array<Array<Vertex, double>, 6> open_pressures(const Array<Vertex, Vec3>& position,
                                                    const FlowOptions& options, const FlowBoundary& boundary,
                                                    double t) {
    std::array<Array<Vertex, double>, 6> pressures;
    for (std::size_t face = 0; face < 6; ++face) {
        const Quantity& pressure = options.faces[face].pressure;
        if (options.faces[face].kind != FlowFace::Kind::open || !pressure) continue;
        pressures[face].resize(position.size(), 0.0);
        for (Vertex v : vertices_of(boundary.faces[face])) {
            pressures[face][v] = pressure(position[v], t);
            if (std::isfinite(pressures[face][v])) continue;
            std::ostringstream message;
            message << options.key << ".face." << face_names[face] << ".pressure must be finite, got "
                    << pressures[face][v] << " at t = " << t << " s";
            throw CaseError(message.str());
        }
    }
    return pressures;
}

double flux_through(const std::vector<std::array<Vertex, 3>>& facets, const Array<Vertex, Vec3>& position,
                    const Array<Vertex, Vec3>& velocity) {
    double sum = 0;
    for (const auto& [a, b, c] : facets)
        sum += dot(cross(position[b] - position[a], position[c] - position[a]),
                   velocity[a] + velocity[b] + velocity[c]) / 6;
    return sum;
}

Array<Region, FlowMaterial> flow_materials(const Mesh& mesh, const FlowOptions& options,
                                           const Array<Vertex, double>& temperature) {
    Array<Region, FlowMaterial> materials(options.regions.size());
    const auto set = [&](const Property& property, const std::string& key, double& value,
                         Array<Vertex, double>& values) {
        if (property.constant()) {
            value = property(0);
            return;
        }
        if (temperature.empty()) throw CaseError(key + " depends on the temperature, and there is none");
        values.resize(mesh.position.size(), 0.0);
        for (Vertex v : mesh.position.indices())
            if (alive(mesh, v)) values[v] = property(temperature[v]);
    };
    for (Region r : materials.indices()) {
        if (!is_fluid(options, r)) continue;
        const FlowRegion& region = *options.regions[static_cast<std::size_t>(r.value)];
        const std::string key = options.key + ".region." + std::to_string(r.value);
        set(region.density, key + ".density", materials[r].density, materials[r].densities);
        set(region.viscosity, key + ".viscosity", materials[r].viscosity, materials[r].viscosities);
    }
    return materials;
}

void set_forces(const Mesh& mesh, const Array<Vertex, Vec3>& position, const FlowOptions& options, double t,
                Array<Region, FlowMaterial>& material) {
    for (Region r : material.indices()) {
        if (!is_fluid(options, r)) continue;
        const VectorQuantity& force = options.regions[static_cast<std::size_t>(r.value)]->force;
        if (!force[0] && !force[1] && !force[2]) continue;
        material[r].force.resize(position.size());
        Array<Vertex, char> done(position.size(), 0);
        for_each_cell(living_cells(mesh, r), [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell)) {
                if (done[v]) continue;
                done[v] = 1;
                const Vec3 value = material[r].force[v] = value_of(force, position[v], t);
                if (!is_finite(value))
                    refuse(options.key + ".region." + std::to_string(r.value) + ".force", value, position[v],
                           t);
            }
        });
    }
}

}  // namespace kropla
