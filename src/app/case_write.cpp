// The case as it is run, written so that it reads as the same case again.
#include "app/case.h"

#include "app/case_body.h"
#include "app/case_heat.h"
#include "app/case_table.h"

#include <fmt/format.h>

namespace kropla {
namespace {

std::string vec3(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string layer(const LayerOptions& it) {
    return fmt::format(
        "[body.layer]\ncount = {}\nfirst_height = {}\ngrowth = {}\nside = \"{}\"\nmin_gap = {}\n", it.count,
        it.first_height, it.growth, side_names[static_cast<std::size_t>(it.side)], least_gap(it));
}

std::string body(const Body& it, const WrittenBody& written) {
    std::string text = fmt::format("\n[[body]]\nname = {}\nshape = \"{}\"\ncentre = {}\n", toml_text(it.name),
                                   written.shape, vec3(it.shape.centre));
    if (written.shape == "sphere") {
        text += fmt::format("radius = {}\n", it.shape.semi_axes.x);
    } else {
        text += fmt::format("axes = {}\n", vec3(it.shape.semi_axes));
        if (!written.rotation.empty()) text += fmt::format("rotation = {}\n", written.rotation);
    }
    const auto& [x, y, z] = written.motion;
    if (!x.empty()) text += fmt::format("[body.motion]\nx = {}\ny = {}\nz = {}\n", x, y, z);
    if (!written.angle.empty()) text += fmt::format("angle = {}\naxis = {}\n", written.angle, written.axis);
    if (it.layer) text += layer(*it.layer);
    return text;
}

std::string keys(const WrittenKeys& written) {
    std::string text;
    for (const auto& [key, value] : written) text += fmt::format("{} = {}\n", key, value);
    return text;
}

std::string heat(const Domain& domain, const WrittenHeat& written) {
    std::string text;
    const auto add = [&](const char* kind, std::size_t region, const WrittenKeys& of) {
        if (!of.empty()) text += fmt::format("\n[heat.{}.{}]\n{}", kind, toml_text(region_name(domain, region)), keys(of));
    };
    for (std::size_t r = 0; r < written.regions.size(); ++r) add("region", r, written.regions[r]);
    for (std::size_t body = 0; body < written.surfaces.size(); ++body) add("surface", body + 1, written.surfaces[body]);
    text += "\n[heat.face]\n";
    for (std::size_t f = 0; f < face_keys.size(); ++f) text += fmt::format("{} = {}\n", face_keys[f], written.faces[f]);
    return text;
}

std::string quality(const QualityPlan& it) {
    const std::string text = fmt::format("\n[quality]\nmax_aspect_ratio = {}\n", it.max_aspect_ratio);
    if (!it.paper) return text + "method = \"kropla\"\n";
    const auto& [x1, x2] = it.paper->weights;
    return text + fmt::format("method = \"paper\"\nweights = [{}, {}]\n", x1, x2);
}

}  // namespace

std::string to_toml(const Case& it) {
    std::string text = "# The case as run, defaults filled in. Lengths in metres, times in seconds.\n";
    text += fmt::format("\n[domain]\nmin = {}\nmax = {}\n", vec3(it.domain.box.min), vec3(it.domain.box.max));
    for (std::size_t b = 0; b < it.domain.bodies.size(); ++b) {
        text += body(it.domain.bodies[b], it.written_bodies[b]);
    }
    const SizeField& size = it.domain.size;
    text +=
        fmt::format("\n[size]\nsurface = {}\ngrowth = {}\nfar = {}\n", size.surface, size.growth, size.far);
    text += quality(it.quality);
    text += fmt::format("\n[time]\nend = {}\nsteps = {}\n", it.time.end, it.time.steps);
    if (it.heat) text += heat(it.domain, it.written_heat);
    text += fmt::format("\n[output]\nevery = {}\n\n[random]\nseed = {}\n", it.output.every, it.random.seed);
    return text;
}

}  // namespace kropla
