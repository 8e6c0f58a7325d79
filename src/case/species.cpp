// [[species]]: what is dissolved in materials, where it begins and how it comes in.
#include "case/species.h"

#include "case/heat.h"
#include "case/noted_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace kropla {
namespace {

SpeciesRegion read_region(NotedTable table) {
    table.table().allow({"diffusivity", "initial", "source"});
    SpeciesRegion region;
    if (!(table.table().number("diffusivity") > 0)) table.table().refuse_value("diffusivity", "must be positive");
    region.diffusivity = table.number("diffusivity");
    if (table.table().holds_text("initial")) region.initial = table.quantity("initial", Variables::place);
    else region.initial = table.number("initial");
    region.source = table.quantity("source");
    return region;
}

SpeciesSurface read_surface(NotedTable table) {
    table.table().allow({"flux", "per_heat"});
    SpeciesSurface surface;
    surface.flux = table.quantity("flux");
    if (table.has("per_heat")) surface.per_heat = table.number("per_heat");
    return surface;
}

HeatFace read_face(const CaseTable& faces, std::string_view key, const Vec3& probe, WrittenKeys& written) {
    if (!faces.holds_table(key)) faces.refuse_value(key, "must be { value = ... } [kg/m^3] or { flux = ... } [kg/(m^2 s)]");
    const CaseTable table = faces.table(key);
    table.allow({"value", "flux"});
    if (table.has("value") == table.has("flux"))
        faces.refuse(key, "must have either a value [kg/m^3] or a flux [kg/(m^2 s)]");
    WrittenKeys keys;
    NotedTable face(table, probe, keys);
    HeatFace read;
    read.kind = table.has("value") ? HeatFace::Kind::value : HeatFace::Kind::flux;
    read.quantity = face.quantity(table.has("value") ? "value" : "flux");
    written.emplace_back(key, inline_table(keys));
    return read;
}

/// Of arrays in frames and of columns, as is a species' name with `_within`.
constexpr std::array<std::string_view, 10> names_of_frames = {"region", "aspect_ratio", "min_dihedral", "layer", "temperature",
                                                              "energy", "velocity", "pressure", "pressure_mean", "density"};

/// A name that can be that of a column and of an array, and is not taken.
std::string read_name(const CaseTable& table, const Case& given) {
    const std::string name = table.text("name");
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    if (name.empty() || !std::ranges::all_of(name, is_plain))
        table.refuse_value("name", "must be of letters, digits and underscores");
    const bool taken = std::ranges::find(names_of_frames, name) != names_of_frames.end() || name.ends_with("_within") ||
                       std::ranges::any_of(given.species, [&](const Species& other) { return other.name == name; });
    if (taken) table.refuse_value("name", "must be one that is not taken yet");
    return name;
}

Species read_one(const CaseTable& table, const Case& given, WrittenSpecies& written) {
    table.allow({"name", "region", "surface", "face"});
    Species species{.name = read_name(table, given), .regions = {}};
    const Vec3 probe = probe_of(given.domain.box);
    std::vector<std::string> names;
    for (std::size_t r = 0; r <= given.domain.bodies.size(); ++r) names.push_back(region_name(given.domain, r));
    species.regions.resize(names.size());
    species.surfaces.resize(given.domain.bodies.size());
    written = {std::vector<WrittenKeys>(names.size()), std::vector<WrittenKeys>(given.domain.bodies.size()), {}};

    const CaseTable regions = table.table("region");
    regions.allow(names);
    for (std::size_t r = 0; r < names.size(); ++r) {
        if (!regions.has(names[r])) continue;
        const CaseTable region = regions.table(names[r]);
        species.regions[r] = read_region(NotedTable(region, probe, written.regions[r]));
    }
    if (std::ranges::none_of(species.regions, [](const auto& region) { return region.has_value(); }))
        table.refuse("region", "must name at least one region that the species is in");

    if (table.has("surface")) {
        const CaseTable surfaces = table.table("surface");
        surfaces.allow(std::vector<std::string>(names.begin() + 1, names.end()));
        for (std::size_t body = 0; body < given.domain.bodies.size(); ++body) {
            if (!surfaces.has(names[body + 1])) continue;
            const CaseTable surface = surfaces.table(names[body + 1]);
            species.surfaces[body] = read_surface(NotedTable(surface, probe, written.surfaces[body]));
            if (species.surfaces[body].per_heat != 0 && !given.heat) surface.refuse("per_heat", "needs heat in the case");
        }
    }
    if (!table.has("face")) return species;
    const CaseTable faces = table.table("face");
    faces.allow(std::vector<std::string>(face_keys.begin(), face_keys.end()));
    for (std::size_t f = 0; f < face_keys.size(); ++f)
        if (faces.has(face_keys[f])) species.faces[f] = read_face(faces, face_keys[f], probe, written.faces);
    const auto meets_faces = [&](std::size_t r) {
        return r == 0 || given.mesh || given.domain.bodies[r - 1].shape.cut;
    };
    bool there = false;
    for (std::size_t r = 0; r < names.size(); ++r) there = there || (species.regions[r] && meets_faces(r));
    if (!written.faces.empty() && !there)
        table.refuse("face", "needs the species in the surroundings, or in a body that reaches through faces of the box");
    return species;
}

}  // namespace

void read_species(const CaseTable& file, Case& given) {
    for (const CaseTable& table : file.tables("species")) {
        given.written_species.emplace_back();
        given.species.push_back(read_one(table, given, given.written_species.back()));
    }
}

}  // namespace kropla
