// [flow]: what flows, and what happens at the faces.
#include "case/flow.h"

#include "case/heat.h"
#include "case/noted_table.h"
#include <kropla/domain/solids.h>

#include <fmt/format.h>

#include <algorithm>

namespace kropla {
namespace {

/// A constant, or a function of the temperature, which there must be.
Property read_material(NotedTable& table, std::string_view key, const Case& given, std::size_t region) {
    const double usual = given.heat ? given.heat->regions[region].initial.value : 0;
    const Property property = table.property(key, usual > 0 ? usual : 300);
    if (!property.constant() && !given.heat)
        table.table().refuse(key, "depends on T, but there is no heat in the case; give a number or [heat]");
    return property;
}

FlowRegion read_region(NotedTable table, const Case& given, std::size_t region, VectorQuantity& initial) {
    table.table().allow({"density", "viscosity", "initial", "force"});
    FlowRegion read;
    read.density = read_material(table, "density", given, region);
    if (!read.density.constant() && read.density != given.heat->regions[region].material.density)
        table.table().refuse("density", fmt::format("depends on T, so heat.region.{}.density must be the same",
                                                    region_name(given.domain, region)));
    const bool has_liquids = std::ranges::any_of(given.liquid, [](int is_liquid) { return is_liquid != 0; });
    if (!read.density.constant() && has_liquids)
        table.table().refuse("density", "must be a number in a case with liquid bodies, everywhere: none expands there yet");
    if (!read.density.constant() && !given.species.empty())
        table.table().refuse("density", "must be a number in a case with [[species]]: what expands does not carry them yet");
    read.viscosity = read_material(table, "viscosity", given, region);
    initial = table.vector("initial", "[u, v, w] [m/s]", Variables::place);
    read.force = table.vector("force", "[fx, fy, fz] [N/m^3]");
    return read;
}

FlowFace read_face(const CaseTable& faces, std::string_view key, const Vec3& probe, std::string& written) {
    if (faces.holds_text(key)) {
        const std::string kind = faces.text(key);
        written = toml_text(kind);
        if (kind == "wall") return {};
        if (kind == "slip") return {.kind = FlowFace::Kind::slip};
    }
    if (!faces.holds_table(key))
        faces.refuse_value(key, "must be \"wall\", \"slip\", { velocity = [u, v, w] } [m/s] or { pressure = ... } [Pa]");
    const CaseTable table = faces.table(key);
    table.allow({"velocity", "pressure"});
    if (table.has("velocity") == table.has("pressure"))
        faces.refuse(key, "must have one condition: a velocity [m/s], or the pressure [Pa] of an open face");
    WrittenKeys keys;
    NotedTable noted(table, probe, keys);
    FlowFace face;
    face.kind = table.has("velocity") ? FlowFace::Kind::velocity : FlowFace::Kind::open;
    face.velocity = noted.vector("velocity", "[u, v, w] [m/s]");
    face.pressure = noted.quantity("pressure");
    written = inline_table(keys);
    return face;
}

/// The angle in a table or of all faces [degrees]; nothing: pinned.
std::optional<double> read_angle(NotedTable& table, std::string_view key) {
    if (table.table().holds_text(key) && table.table().text(key) == "pinned") {
        table.note(key, "\"pinned\"");
        return {};
    }
    const double angle = table.number(key);
    if (!(angle > 0 && angle < 180))
        table.table().refuse_value(key, "must be \"pinned\", or an angle in the liquid between 0 and 180 degrees");
    return angle;
}

/// How the line of a liquid body moves on the faces through which it reaches.
ContactAngles read_contact(NotedTable& surface, const Case& given, std::size_t body) {
    const std::string_view key = "contact";
    const CaseTable& table = surface.table();
    ContactAngles contact = {};
    if (!table.has(key)) return contact;
    const unsigned reached = reached_faces(given.domain.bodies[body].shape);
    if (reached == 0) table.refuse(key, "is how a surface ends on faces of the box, and this body is wholly in it");
    if (!table.holds_table(key)) {
        const auto angle = read_angle(surface, key);
        for (int face = 0; face < box_faces; ++face)
            if (reaches(reached, face)) contact[as_size(face)] = angle;
        return contact;
    }
    const CaseTable faces = table.table(key);
    faces.allow(std::vector<std::string>(face_keys.begin(), face_keys.end()));
    WrittenKeys keys;
    NotedTable noted(faces, probe_of(given.domain.box), keys);
    for (std::size_t face = 0; face < contact.size(); ++face) {
        if (!faces.has(face_keys[face])) continue;
        if (!reaches(reached, static_cast<int>(face))) faces.refuse(face_keys[face], "is a face through which the body does not reach");
        contact[face] = read_angle(noted, face_keys[face]);
    }
    surface.note(key, inline_table(keys));
    return contact;
}

/// A bit each.
unsigned pinned_faces(const ContactAngles& contact) {
    unsigned pinned = 0;
    for (std::size_t face = 0; face < contact.size(); ++face)
        if (!contact[face]) pinned |= 1u << face;
    return pinned;
}

/// Throws where a face does not let the line of a liquid body do what it should.
void check_contact(const CaseTable& flow, const FlowPlan& plan, const Domain& domain, std::size_t body) {
    const ContactAngles& contact = plan.options.contact[body];
    const Body& liquid = domain.bodies[body];
    const unsigned lines = liquid.shape.cut ? stands_in_box(liquid, 0).faces : 0;  // a pool may be on all of a face
    for (std::size_t face = 0; face < contact.size(); ++face) {
        if (!reaches(reached_faces(liquid.shape), static_cast<int>(face))) continue;
        const FlowFace::Kind kind = plan.options.faces[face].kind;
        const std::string_view name = face_keys[face];
        if (kind != FlowFace::Kind::wall && kind != FlowFace::Kind::slip)
            flow.table("face").refuse(name, fmt::format("must be \"wall\" or \"slip\": liquid body {} reaches through it",
                                                        liquid.name));
        if (contact[face] && kind != FlowFace::Kind::slip && reaches(lines, static_cast<int>(face)))
            flow.table("surface").table(liquid.name)
                .refuse("contact", fmt::format("has the line move along {0}, where a wall without slip holds it: give it "
                                               "flow.face.{0} = \"slip\", or pin it", name));
    }
}

/// [flow.surface.NAME] of bodies that are liquid.
void read_surfaces(const CaseTable& surfaces, Case& given, FlowPlan& plan) {
    std::vector<std::string> names;
    for (std::size_t body = 0; body < given.liquid.size(); ++body) names.push_back(given.domain.bodies[body].name);
    surfaces.allow(names);
    for (std::size_t body = 0; body < names.size(); ++body) {
        if (!surfaces.has(names[body])) continue;
        if (given.liquid[body] == 0)
            surfaces.refuse(names[body], "is of a liquid, and the body is solid: give it motion.kind = \"flow\", or leave this out");
        const CaseTable table = surfaces.table(names[body]);
        NotedTable surface(table, probe_of(given.domain.box), given.written_flow.surfaces[body]);
        table.allow({"tension", "contact"});
        if (table.has("tension")) plan.options.tension[body] = read_material(surface, "tension", given, body + 1);
        plan.options.contact[body] = read_contact(surface, given, body);
    }
}

}  // namespace

void read_flow(const CaseTable& file, Case& given) {
    if (!file.has("flow")) {
        for (std::size_t body = 0; body < given.free.size(); ++body) {
            if (given.free[body])
                file.tables("body")[body].table("motion").refuse("kind", "\"free\" needs [flow]: the forces that move the body");
            if (given.liquid[body] != 0)
                file.tables("body")[body].table("motion").refuse("kind", "\"flow\" needs [flow]: what the body goes with");
        }
        return;
    }
    const CaseTable table = file.table("flow");
    table.allow({"gravity", "convection", "region", "surface", "face"});
    FlowPlan plan;
    WrittenFlow& written = given.written_flow;
    const Vec3 probe = probe_of(given.domain.box);
    NotedTable noted(table, probe, written.general);
    if (table.has("gravity")) {
        const std::vector<double> g = table.numbers("gravity", 3, "[gx, gy, gz] [m/s^2]");
        plan.options.gravity = {g[0], g[1], g[2]};
        noted.note("gravity", fmt::format("[{}, {}, {}]", g[0], g[1], g[2]));
    }
    if (table.has("convection")) {
        plan.options.convection = table.truth("convection");
        noted.note("convection", plan.options.convection ? "true" : "false");
    }

    std::vector<std::string> names;
    for (std::size_t r = 0; r <= given.domain.bodies.size(); ++r) names.push_back(region_name(given.domain, r));
    const CaseTable regions = table.table("region");
    regions.allow(names);
    if (!regions.has(names[0])) table.refuse("region", "must have surroundings: what the bodies are in is to flow");
    plan.options.regions.resize(names.size());
    plan.initial.resize(names.size());
    written.regions.assign(names.size(), {});
    for (std::size_t r = 0; r < names.size(); ++r) {
        if (!regions.has(names[r])) continue;
        const CaseTable region = regions.table(names[r]);
        if (r > 0 && given.liquid[r - 1] == 0)
            regions.refuse(names[r], "is of a liquid, and the body is solid: give it motion.kind = \"flow\", or leave this out");
        plan.options.regions[r] = read_region(NotedTable(region, probe, written.regions[r]), given, r, plan.initial[r]);
    }

    for (std::size_t body = 0; body < given.liquid.size(); ++body)
        if (given.liquid[body] != 0 && !plan.options.regions[body + 1])
            table.refuse("region", fmt::format("must have {}, which goes with the flow (motion.kind = \"flow\"): its density "
                                               "[kg/m^3] and viscosity [Pa s]", names[body + 1]));
    plan.options.tension.resize(given.liquid.size());
    plan.options.contact.resize(given.liquid.size());
    written.surfaces.assign(given.liquid.size(), {});
    if (table.has("surface")) read_surfaces(table.table("surface"), given, plan);

    written.faces.fill("\"wall\"");
    if (table.has("face")) {
        const CaseTable faces = table.table("face");
        faces.allow(std::vector<std::string>(face_keys.begin(), face_keys.end()));
        for (std::size_t f = 0; f < face_keys.size(); ++f)
            if (faces.has(face_keys[f])) plan.options.faces[f] = read_face(faces, face_keys[f], probe, written.faces[f]);
    }
    for (std::size_t body = 0; body < given.liquid.size(); ++body) {
        if (given.liquid[body] == 0) continue;
        check_contact(table, plan, given.domain, body);
        given.domain.bodies[body].pinned = pinned_faces(plan.options.contact[body]);
    }
    const auto is_open = [](const FlowFace& face) { return face.kind == FlowFace::Kind::open; };
    if (!plan.options.regions[0]->density.constant() && std::ranges::none_of(plan.options.faces, is_open))
        regions.table(names[0]).refuse("density", "depends on T, and what expands has no way out: give a face of flow.face a pressure");
    given.flow = std::move(plan);
}

}  // namespace kropla
