// [heat]: materials, sources, and what happens at surfaces and faces.
#include "case/heat.h"

#include "case/noted_table.h"
#include "simulate/step_mean.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace kropla {
namespace {

HeatExchange read_exchange(NotedTable& noted) {
    const CaseTable& table = noted.table();
    HeatExchange exchange{noted.quantity("coefficient"), noted.quantity("emissivity"), {}};
    const bool is_some = exchange.coefficient || exchange.emissivity;
    if (is_some && !table.has("ambient"))
        table.refuse("ambient", "is missing; it must be the temperature [K] with which heat is exchanged");
    if (!is_some && table.has("ambient"))
        table.refuse("ambient", "needs a coefficient [W/(m^2 K)] or an emissivity beside it");
    if (exchange.coefficient && noted.at_probe(exchange.coefficient) < 0)
        table.refuse_value("coefficient", "must be at least 0");
    if (exchange.emissivity && !(noted.at_probe(exchange.emissivity) >= 0 && noted.at_probe(exchange.emissivity) <= 1))
        table.refuse_value("emissivity", "must be from 0 to 1");
    exchange.ambient = noted.quantity("ambient");
    if (exchange.emissivity && noted.at_probe(exchange.ambient) < 0)
        table.refuse_value("ambient", "must be at least 0 [K] where something radiates");
    return exchange;
}

/// A distribution, and the whole of it.
std::pair<Quantity, Quantity> flux_and_power(NotedTable& noted, std::string_view key) {
    Quantity flux = noted.quantity(key), power = noted.quantity("power", Variables::time);
    const Constant* spread = flux.target<Constant>();
    if (power && spread != nullptr && spread->value == 0)
        noted.table().refuse_value(key, "must not be zero beside power, which is spread by it; leave it out to spread it evenly");
    return {std::move(flux), std::move(power)};
}

HeatStart read_start(NotedTable& table) {
    if (table.table().holds_text("initial") && table.table().text("initial") == "steady") {
        table.note("initial", "\"steady\"");
        HeatStart start;
        start.steady = true;
        return start;
    }
    if (table.table().holds_text("initial")) return table.quantity("initial", Variables::place);
    return table.number("initial");
}

void read_latent_heat(NotedTable& table, HeatMaterial& material) {
    const CaseTable& given = table.table();
    const bool any = given.has("latent_heat") || given.has("solidus") || given.has("liquidus");
    if (!any) return;
    if (given.number("latent_heat") < 0) given.refuse_value("latent_heat", "must be at least 0");
    material.latent_heat = table.number("latent_heat");
    material.solidus = table.number("solidus");
    material.liquidus = table.number("liquidus");
    if (!(material.solidus < material.liquidus))
        given.refuse_value("solidus", fmt::format("must be below liquidus, {}", toml_number(material.liquidus)));
}

HeatRegion read_region(NotedTable table) {
    const CaseTable& given = table.table();
    given.allow({"conductivity", "density", "specific_heat", "latent_heat", "solidus", "liquidus", "initial", "source",
                 "power", "held"});
    HeatRegion region;
    if (given.has("held")) region.held = table.number("held");
    else if (!given.has("initial"))
        given.refuse("initial", "is missing; it must be a number [K], an expression of x, y, z, \"steady\", or instead "
                                "`held` a temperature");
    if (given.has("initial")) region.initial = read_start(table);
    const double usual = region.held ? *region.held : region.initial.value > 0 ? region.initial.value : 300;
    region.material.conductivity = table.property("conductivity", usual);
    region.material.density = table.property("density", usual);
    region.material.specific_heat = table.property("specific_heat", usual);
    read_latent_heat(table, region.material);
    std::tie(region.source, region.power) = flux_and_power(table, "source");
    return region;
}

HeatSurface read_surface(NotedTable table) {
    table.table().allow({"flux", "power", "coefficient", "emissivity", "ambient"});
    HeatSurface surface;
    std::tie(surface.flux, surface.power) = flux_and_power(table, "flux");
    surface.exchange = read_exchange(table);
    return surface;
}

HeatFace read_face(const CaseTable& faces, std::string_view key, const Vec3& probe, std::string& written) {
    if (faces.holds_text(key) && faces.text(key) == "insulated") {
        written = "\"insulated\"";
        return {};
    }
    if (!faces.holds_table(key)) {
        faces.refuse_value(key, "must be \"insulated\", { value = ... } [K], { flux = ... } [W/m^2] or { coefficient = ... "
                                "[W/(m^2 K)], emissivity = ..., ambient = ... [K] }");
    }
    const CaseTable table = faces.table(key);
    WrittenKeys keys;
    NotedTable face(table, probe, keys);
    table.allow({"value", "flux", "power", "coefficient", "emissivity", "ambient"});
    const bool value = table.has("value"), flux = table.has("flux") || table.has("power");
    const bool exchange = table.has("coefficient") || table.has("emissivity") || table.has("ambient");
    if (int{value} + int{flux} + int{exchange} != 1)
        faces.refuse(key, "must have one condition: a value [K], a flux [W/m^2] (or its power [W]), or an exchange of heat "
                          "by a coefficient or an emissivity with an ambient");
    HeatFace read;
    if (value) {
        read.kind = HeatFace::Kind::value;
        read.quantity = face.quantity("value");
    } else if (flux) {
        read.kind = HeatFace::Kind::flux;
        std::tie(read.quantity, read.power) = flux_and_power(face, "flux");
    } else {
        read.kind = HeatFace::Kind::exchange;
        read.exchange = read_exchange(face);
    }
    written = inline_table(keys);
    return read;
}

}  // namespace

std::string region_name(const Domain& domain, std::size_t region) {
    return region == 0 ? "surroundings" : domain.bodies[region - 1].name;
}

Carried carried_in(const Domain& domain, std::size_t region) {
    return region == 0 || domain.bodies[region - 1].deformation ? Carried::with_flow : Carried::with_mesh;
}

HeatOptions read_heat(const CaseTable& table, const Domain& domain, WrittenHeat& written) {
    table.allow({"region", "surface", "face"});
    const CaseTable regions = table.table("region");
    std::vector<std::string> names;
    for (std::size_t r = 0; r <= domain.bodies.size(); ++r) names.push_back(region_name(domain, r));
    regions.allow(names);

    const Vec3 probe = probe_of(domain.box);
    HeatOptions heat;
    written.regions.assign(names.size(), {});
    for (std::size_t r = 0; r < names.size(); ++r) {
        const CaseTable region = regions.table(names[r]);
        heat.regions.push_back(read_region(NotedTable(region, probe, written.regions[r])));
        heat.regions[r].name = names[r];
        heat.regions[r].carried = carried_in(domain, r);
    }

    heat.surfaces.resize(domain.bodies.size());
    written.surfaces.assign(domain.bodies.size(), {});
    if (table.has("surface")) {
        const CaseTable surfaces = table.table("surface");
        surfaces.allow(std::vector<std::string>(names.begin() + 1, names.end()));
        for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
            if (!surfaces.has(names[body + 1])) continue;
            const CaseTable surface = surfaces.table(names[body + 1]);
            heat.surfaces[body] = read_surface(NotedTable(surface, probe, written.surfaces[body]));
        }
    }

    written.faces.fill("\"insulated\"");
    if (table.has("face")) {
        const CaseTable faces = table.table("face");
        faces.allow(std::vector<std::string>(face_keys.begin(), face_keys.end()));
        for (std::size_t f = 0; f < face_keys.size(); ++f)
            if (faces.has(face_keys[f])) heat.faces[f] = read_face(faces, face_keys[f], probe, written.faces[f]);
    }
    if (!has_steady_state(heat))
        regions.table("surroundings")
            .refuse("initial", "there is no steady state, or more than one, as nothing says how warm it is: give a region "
                               "a temperature, or a face a value or an exchange of heat");
    return heat;
}

}  // namespace kropla
