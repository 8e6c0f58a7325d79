#include "app/case_heat.h"

#include "simulate/step_mean.h"

#include <fmt/format.h>

#include <algorithm>

namespace kropla {
namespace {

Quantity quantity(const Formula& formula) {
    if (!formula.written.starts_with('"')) return Constant{formula.value(0)};
    return [f = formula.value](const Vec3& place, double t) { return f(t, place); };
}

HeatRegion read_region(const CaseTable& table, const Vec3& probe, std::string& written_source) {
    table.allow({"conductivity", "density", "specific_heat", "initial", "source"});
    HeatRegion region;
    region.material = {table.positive("conductivity"), table.positive("density"),
                       table.positive("specific_heat")};
    region.initial = table.number("initial");
    if (!table.has("source")) return region;
    const Formula source = table.formula("source", Variables::time_and_place, probe);
    written_source = source.written;
    region.source = quantity(source);
    return region;
}

HeatFace read_face(const CaseTable& faces, std::string_view key, const Vec3& probe, std::string& written) {
    if (faces.holds_text(key) && faces.text(key) == "insulated") {
        written = "\"insulated\"";
        return {};
    }
    if (!faces.holds_table(key)) {
        faces.refuse_value(key, "must be \"insulated\", { value = ... } [K] or { flux = ... } [W/m^2]");
    }
    const CaseTable face = faces.table(key);
    face.allow({"value", "flux"});
    if (face.has("value") == face.has("flux"))
        faces.refuse(key, "must have either a value [K] or a flux [W/m^2]");
    const bool is_value = face.has("value");
    const char* name = is_value ? "value" : "flux";
    const Formula formula = face.formula(name, Variables::time_and_place, probe);
    written = fmt::format("{{ {} = {} }}", name, formula.written);
    return {is_value ? HeatFace::Kind::value : HeatFace::Kind::flux, quantity(formula)};
}

/// A place that is special to no formula: expressions are tried there.
Vec3 probe_of(const Box& box) {
    const Vec3 span = box.max - box.min;
    return box.min + Vec3{0.37 * span.x, 0.41 * span.y, 0.43 * span.z};
}

}  // namespace

std::string region_name(const Domain& domain, std::size_t region) {
    return region == 0 ? "surroundings" : domain.bodies[region - 1].name;
}

HeatOptions read_heat(const CaseTable& table, const Domain& domain, WrittenHeat& written) {
    table.allow({"region", "face"});
    const CaseTable regions = table.table("region");
    std::vector<std::string> names;
    for (std::size_t r = 0; r <= domain.bodies.size(); ++r) names.push_back(region_name(domain, r));
    regions.allow(names);

    const Vec3 probe = probe_of(domain.box);
    HeatOptions heat;
    written.sources.assign(names.size(), "");
    for (std::size_t r = 0; r < names.size(); ++r) {
        heat.regions.push_back(read_region(regions.table(names[r]), probe, written.sources[r]));
        heat.regions[r].name = names[r];
        heat.regions[r].carried = r == 0 ? Carried::at_rest : Carried::with_mesh;
    }

    written.faces.fill("\"insulated\"");
    if (!table.has("face")) return heat;
    const CaseTable faces = table.table("face");
    faces.allow(std::vector<std::string>(face_keys.begin(), face_keys.end()));
    for (std::size_t f = 0; f < face_keys.size(); ++f) {
        if (faces.has(face_keys[f])) heat.faces[f] = read_face(faces, face_keys[f], probe, written.faces[f]);
    }
    return heat;
}

}  // namespace kropla
