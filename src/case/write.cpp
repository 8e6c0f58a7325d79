// The case as it is run, written so that it reads as the same case again.
#include "case/case.h"

#include "case/body.h"
#include "case/heat.h"
#include "case/table.h"

#include <fmt/format.h>

namespace kropla {
namespace {

/// `key = value`, or as it was written if that is an expression, with the value behind it.
template <class Value>
std::string line(const Case& given, const std::string& table, std::string_view key, const Value& value) {
    const auto written = given.written_numbers.find(fmt::format("{}.{}", table, key));
    return written == given.written_numbers.end() ? fmt::format("{} = {}\n", key, value)
                                               : fmt::format("{} = {}  # = {}\n", key, written->second, value);
}

std::string vec3(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string keys(const Case& given, const std::string& table, const WrittenKeys& written) {
    std::string text;
    for (const auto& [key, value] : written) text += line(given, table, key, value);
    return text;
}

std::string layer(const Case& given, const LayerOptions& layer, const std::string& table) {
    return "[body.layer]\n" + line(given, table, "count", layer.count) +
           line(given, table, "first_height", layer.first_height) + line(given, table, "growth", layer.growth) +
           fmt::format("side = \"{}\"\n", side_names[static_cast<std::size_t>(layer.side)]) +
           line(given, table, "min_gap", least_gap(layer));
}

std::string body(const Case& given, std::size_t number) {
    const Body& body = given.domain.bodies[number];
    const WrittenBody& written = given.written_bodies[number];
    const std::string table = fmt::format("body[{}]", number);
    std::string text = fmt::format("\n[[body]]\nname = {}\nshape = \"{}\"\n", toml_text(body.name), written.shape);
    const bool by_formula = written.surface.empty();  // of those that may be
    if (by_formula && (written.shape == "sphere" || written.shape == "ellipsoid"))
        text += line(given, table, "centre", vec3(body.shape.centre));
    if (written.shape == "region") {
        text += fmt::format("region = {}\n", written.region);
    } else if (by_formula && written.shape == "sphere") {
        text += line(given, table, "radius", body.shape.semi_axes.x);
    } else {
        if (by_formula && written.shape == "ellipsoid") text += line(given, table, "axes", vec3(body.shape.semi_axes));
        text += keys(given, table, written.surface);
        if (!written.rotation.empty()) text += line(given, table, "rotation", written.rotation);
    }
    if (body.size) text += line(given, table, "size", *body.size);
    const auto& [x, y, z] = written.motion;
    if (!x.empty()) text += fmt::format("[body.motion]\nx = {}\ny = {}\nz = {}\n", x, y, z);
    if (!written.free.empty()) text += "[body.motion]\nkind = \"free\"\n" + keys(given, table + ".motion", written.free);
    if (!written.velocity.empty())
        text += "[body.motion]\nkind = \"field\"\n" + line(given, table + ".motion", "velocity", written.velocity);
    if (given.liquid[number] != 0) text += "[body.motion]\nkind = \"flow\"\n";
    if (!written.angle.empty()) text += fmt::format("angle = {}\naxis = {}\n", written.angle, written.axis);
    if (body.layer) text += layer(given, *body.layer, table + ".layer");
    return text;
}

std::string heat(const Case& given) {
    const WrittenHeat& written = given.written_heat;
    std::string text;
    const auto add = [&](const char* kind, std::size_t region, const WrittenKeys& of) {
        const std::string name = region_name(given.domain, region);
        if (of.empty()) return;
        text += fmt::format("\n[heat.{}.{}]\n", kind, toml_text(name)) + keys(given, fmt::format("heat.{}.{}", kind, name), of);
    };
    for (std::size_t r = 0; r < written.regions.size(); ++r) add("region", r, written.regions[r]);
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) add("surface", body + 1, written.surfaces[body]);
    text += "\n[heat.face]\n";
    for (std::size_t f = 0; f < face_keys.size(); ++f) text += fmt::format("{} = {}\n", face_keys[f], written.faces[f]);
    return text;
}

std::string species(const Case& given, std::size_t number) {
    const WrittenSpecies& written = given.written_species[number];
    const std::string table = fmt::format("species[{}]", number);
    std::string text = fmt::format("\n[[species]]\nname = {}\n", toml_text(given.species[number].name));
    const auto add = [&](const char* kind, std::size_t region, const WrittenKeys& of) {
        const std::string name = region_name(given.domain, region);
        if (of.empty()) return;
        text += fmt::format("[species.{}.{}]\n", kind, toml_text(name)) +
                keys(given, fmt::format("{}.{}.{}", table, kind, name), of);
    };
    for (std::size_t r = 0; r < written.regions.size(); ++r) add("region", r, written.regions[r]);
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) add("surface", body + 1, written.surfaces[body]);
    if (!written.faces.empty()) text += "[species.face]\n" + keys(given, table + ".face", written.faces);
    return text;
}

std::string flow(const Case& given) {
    const WrittenFlow& written = given.written_flow;
    std::string text = "\n[flow]\n" + keys(given, "flow", written.general);
    for (std::size_t r = 0; r < written.regions.size(); ++r) {
        const std::string name = region_name(given.domain, r);
        if (!written.regions[r].empty())
            text += fmt::format("\n[flow.region.{}]\n", toml_text(name)) + keys(given, "flow.region." + name, written.regions[r]);
    }
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) {
        const std::string name = region_name(given.domain, body + 1);
        if (!written.surfaces[body].empty())
            text += fmt::format("\n[flow.surface.{}]\n", toml_text(name)) + keys(given, "flow.surface." + name, written.surfaces[body]);
    }
    text += "\n[flow.face]\n";
    for (std::size_t f = 0; f < face_keys.size(); ++f) text += fmt::format("{} = {}\n", face_keys[f], written.faces[f]);
    return text;
}

std::string contact(const Case& given) {
    const ContactOptions& options = *given.contact;
    return fmt::format("\n[contact]\nlubrication = {}\n", options.lubrication) +
           line(given, "contact", "restitution", options.restitution) + line(given, "contact", "gap", options.gap);
}

std::string quality(const Case& given) {
    const QualityPlan& plan = given.quality;
    const std::string text = "\n[quality]\n" + line(given, "quality", "max_aspect_ratio", plan.max_aspect_ratio);
    if (!plan.paper) return text + "method = \"kropla\"\n";
    const auto& [x1, x2] = plan.paper->weights;
    return text + "method = \"paper\"\n" + line(given, "quality", "weights", fmt::format("[{}, {}]", x1, x2));
}

std::string parameters(const Case& given) {
    std::string text = given.parameters.empty() ? "" : "\n[parameters]\n";
    for (const Parameter& parameter : given.parameters)
        text += line(given, "parameters", parameter.name.c_str(), parameter.value);
    return text;
}

}  // namespace

std::string to_toml(const Case& given) {
    std::string text = "# The case as run, defaults filled in. Lengths in metres, times in seconds.\n";
    text += parameters(given);
    if (given.mesh)
        text += fmt::format("\n[domain]\nmesh = {}\n", toml_text(given.mesh->file));
    else
        text += "\n[domain]\n" + line(given, "domain", "min", vec3(given.domain.box.min)) +
                line(given, "domain", "max", vec3(given.domain.box.max));
    for (std::size_t b = 0; b < given.domain.bodies.size(); ++b) text += body(given, b);
    const SizeField& size = given.domain.size;
    text += "\n[size]\n" + line(given, "size", "surface", size.surface) + line(given, "size", "growth", size.growth) +
            line(given, "size", "far", size.far) +
            (size.least ? line(given, "size", "least", *size.least) : "");
    text += quality(given);
    text += "\n[time]\n" + line(given, "time", "end", given.time.end) + line(given, "time", "steps", given.time.steps);
    if (given.time.courant) text += line(given, "time", "courant", *given.time.courant);
    if (given.heat) text += heat(given);
    for (std::size_t s = 0; s < given.species.size(); ++s) text += species(given, s);
    if (given.flow) text += flow(given);
    if (given.contact) text += contact(given);
    text += "\n[output]\n" + line(given, "output", "every", given.output.every);
    return text + "\n[random]\n" + line(given, "random", "seed", given.random.seed);
}

}  // namespace kropla
