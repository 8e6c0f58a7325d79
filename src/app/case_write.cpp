// The case as it is run, written so that it reads as the same case again.
#include "app/case.h"

#include "app/case_body.h"
#include "app/case_heat.h"
#include "app/case_table.h"

#include <fmt/format.h>

namespace kropla {
namespace {

/// `key = value`, or as it was written if that is an expression, with the value behind it.
template <class Value>
std::string line(const Case& it, const std::string& table, std::string_view key, const Value& value) {
    const auto written = it.written_numbers.find(fmt::format("{}.{}", table, key));
    return written == it.written_numbers.end() ? fmt::format("{} = {}\n", key, value)
                                               : fmt::format("{} = {}  # = {}\n", key, written->second, value);
}

std::string vec3(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string keys(const Case& it, const std::string& table, const WrittenKeys& written) {
    std::string text;
    for (const auto& [key, value] : written) text += line(it, table, key, value);
    return text;
}

std::string layer(const Case& it, const LayerOptions& layer, const std::string& table) {
    return "[body.layer]\n" + line(it, table, "count", layer.count) +
           line(it, table, "first_height", layer.first_height) + line(it, table, "growth", layer.growth) +
           fmt::format("side = \"{}\"\n", side_names[static_cast<std::size_t>(layer.side)]) +
           line(it, table, "min_gap", least_gap(layer));
}

std::string body(const Case& it, std::size_t number) {
    const Body& body = it.domain.bodies[number];
    const WrittenBody& written = it.written_bodies[number];
    const std::string table = fmt::format("body[{}]", number);
    std::string text = fmt::format("\n[[body]]\nname = {}\nshape = \"{}\"\n", toml_text(body.name), written.shape);
    const bool by_formula = written.surface.empty();  // of those that may be
    if (by_formula && (written.shape == "sphere" || written.shape == "ellipsoid"))
        text += line(it, table, "centre", vec3(body.shape.centre));
    if (written.shape == "region") {
        text += fmt::format("region = {}\n", written.region);
    } else if (by_formula && written.shape == "sphere") {
        text += line(it, table, "radius", body.shape.semi_axes.x);
    } else {
        if (by_formula && written.shape == "ellipsoid") text += line(it, table, "axes", vec3(body.shape.semi_axes));
        text += keys(it, table, written.surface);
        if (!written.rotation.empty()) text += line(it, table, "rotation", written.rotation);
    }
    if (body.size) text += line(it, table, "size", *body.size);
    const auto& [x, y, z] = written.motion;
    if (!x.empty()) text += fmt::format("[body.motion]\nx = {}\ny = {}\nz = {}\n", x, y, z);
    if (!written.free.empty()) text += "[body.motion]\nkind = \"free\"\n" + keys(it, table + ".motion", written.free);
    if (!written.velocity.empty())
        text += "[body.motion]\nkind = \"field\"\n" + line(it, table + ".motion", "velocity", written.velocity);
    if (it.liquid[number] != 0) text += "[body.motion]\nkind = \"flow\"\n";
    if (!written.angle.empty()) text += fmt::format("angle = {}\naxis = {}\n", written.angle, written.axis);
    if (body.layer) text += layer(it, *body.layer, table + ".layer");
    return text;
}

std::string heat(const Case& it) {
    const WrittenHeat& written = it.written_heat;
    std::string text;
    const auto add = [&](const char* kind, std::size_t region, const WrittenKeys& of) {
        const std::string name = region_name(it.domain, region);
        if (of.empty()) return;
        text += fmt::format("\n[heat.{}.{}]\n", kind, toml_text(name)) + keys(it, fmt::format("heat.{}.{}", kind, name), of);
    };
    for (std::size_t r = 0; r < written.regions.size(); ++r) add("region", r, written.regions[r]);
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) add("surface", body + 1, written.surfaces[body]);
    text += "\n[heat.face]\n";
    for (std::size_t f = 0; f < face_keys.size(); ++f) text += fmt::format("{} = {}\n", face_keys[f], written.faces[f]);
    return text;
}

std::string species(const Case& it, std::size_t number) {
    const WrittenSpecies& written = it.written_species[number];
    const std::string table = fmt::format("species[{}]", number);
    std::string text = fmt::format("\n[[species]]\nname = {}\n", toml_text(it.species[number].name));
    const auto add = [&](const char* kind, std::size_t region, const WrittenKeys& of) {
        const std::string name = region_name(it.domain, region);
        if (of.empty()) return;
        text += fmt::format("[species.{}.{}]\n", kind, toml_text(name)) +
                keys(it, fmt::format("{}.{}.{}", table, kind, name), of);
    };
    for (std::size_t r = 0; r < written.regions.size(); ++r) add("region", r, written.regions[r]);
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) add("surface", body + 1, written.surfaces[body]);
    if (!written.faces.empty()) text += "[species.face]\n" + keys(it, table + ".face", written.faces);
    return text;
}

std::string flow(const Case& it) {
    const WrittenFlow& written = it.written_flow;
    std::string text = "\n[flow]\n" + keys(it, "flow", written.general);
    for (std::size_t r = 0; r < written.regions.size(); ++r) {
        const std::string name = region_name(it.domain, r);
        if (!written.regions[r].empty())
            text += fmt::format("\n[flow.region.{}]\n", toml_text(name)) + keys(it, "flow.region." + name, written.regions[r]);
    }
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) {
        const std::string name = region_name(it.domain, body + 1);
        if (!written.surfaces[body].empty())
            text += fmt::format("\n[flow.surface.{}]\n", toml_text(name)) + keys(it, "flow.surface." + name, written.surfaces[body]);
    }
    text += "\n[flow.face]\n";
    for (std::size_t f = 0; f < face_keys.size(); ++f) text += fmt::format("{} = {}\n", face_keys[f], written.faces[f]);
    return text;
}

std::string contact(const Case& it) {
    const ContactOptions& options = *it.contact;
    return fmt::format("\n[contact]\nlubrication = {}\n", options.lubrication) +
           line(it, "contact", "restitution", options.restitution) + line(it, "contact", "gap", options.gap);
}

std::string quality(const Case& it) {
    const QualityPlan& plan = it.quality;
    const std::string text = "\n[quality]\n" + line(it, "quality", "max_aspect_ratio", plan.max_aspect_ratio);
    if (!plan.paper) return text + "method = \"kropla\"\n";
    const auto& [x1, x2] = plan.paper->weights;
    return text + "method = \"paper\"\n" + line(it, "quality", "weights", fmt::format("[{}, {}]", x1, x2));
}

std::string parameters(const Case& it) {
    std::string text = it.parameters.empty() ? "" : "\n[parameters]\n";
    for (const Parameter& parameter : it.parameters)
        text += line(it, "parameters", parameter.name.c_str(), parameter.value);
    return text;
}

}  // namespace

std::string to_toml(const Case& it) {
    std::string text = "# The case as run, defaults filled in. Lengths in metres, times in seconds.\n";
    text += parameters(it);
    if (it.mesh)
        text += fmt::format("\n[domain]\nmesh = {}\n", toml_text(it.mesh->file));
    else
        text += "\n[domain]\n" + line(it, "domain", "min", vec3(it.domain.box.min)) +
                line(it, "domain", "max", vec3(it.domain.box.max));
    for (std::size_t b = 0; b < it.domain.bodies.size(); ++b) text += body(it, b);
    const SizeField& size = it.domain.size;
    text += "\n[size]\n" + line(it, "size", "surface", size.surface) + line(it, "size", "growth", size.growth) +
            line(it, "size", "far", size.far) +
            (size.least ? line(it, "size", "least", *size.least) : "");
    text += quality(it);
    text += "\n[time]\n" + line(it, "time", "end", it.time.end) + line(it, "time", "steps", it.time.steps);
    if (it.time.courant) text += line(it, "time", "courant", *it.time.courant);
    if (it.heat) text += heat(it);
    for (std::size_t s = 0; s < it.species.size(); ++s) text += species(it, s);
    if (it.flow) text += flow(it);
    if (it.contact) text += contact(it);
    text += "\n[output]\n" + line(it, "output", "every", it.output.every);
    return text + "\n[random]\n" + line(it, "random", "seed", it.random.seed);
}

}  // namespace kropla
