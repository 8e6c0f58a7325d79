// Reading [[body]]: shape, motion and prism layer.
#include "app/case_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kropla {
namespace {

std::string read_name(const CaseTable& table, const std::vector<Body>& before) {
    const std::string name = table.text("name");
    if (name.empty()) table.refuse_value("name", "must not be empty");
    if (name == "surroundings") table.refuse("name", "\"surroundings\" is the name of the rest of the box");
    const auto same = std::ranges::find(before, name, &Body::name);
    if (same != before.end()) {
        table.refuse("name", fmt::format("{} is the name of body[{}] already; names must differ",
                                         toml_text(name), same - before.begin()));
    }
    return name;
}

Shape read_sphere(const CaseTable& table) {
    if (table.has("axes")) table.refuse("axes", "a sphere has a radius instead");
    if (table.has("rotation")) table.refuse("rotation", "a sphere has none");
    const double radius = table.positive("radius");
    return {table.vec3("centre"), {radius, radius, radius}, {}};
}

Shape read_ellipsoid(const CaseTable& table, WrittenBody& written) {
    if (table.has("radius")) table.refuse("radius", "an ellipsoid has axes = [a, b, c] instead");
    const Vec3 axes = table.vec3("axes");
    if (!(axes.x > 0 && axes.y > 0 && axes.z > 0)) table.refuse_value("axes", "must all be positive");
    Shape shape{table.vec3("centre"), axes, {}};
    if (table.has("rotation")) {
        const std::vector<double> r = table.numbers("rotation", 4, "[axis x, y, z, degrees]");
        const Vec3 axis{r[0], r[1], r[2]};
        if (!(norm(axis) > 0)) table.refuse_value("rotation", "must have an axis that is not zero");
        shape.orientation = rotation_about(axis, r[3] * std::numbers::pi / 180);
        written.rotation = fmt::format("[{}]", fmt::join(r, ", "));
    }
    return shape;
}

Shape read_shape(const CaseTable& table, WrittenBody& written) {
    written.shape = table.text("shape");
    if (written.shape == "sphere") return read_sphere(table);
    if (written.shape == "ellipsoid") return read_ellipsoid(table, written);
    table.refuse_value("shape", "must be \"sphere\" or \"ellipsoid\"");
}

constexpr std::array<std::string_view, 3> coordinates = {"x", "y", "z"};

/// Where a body is as formulas of t: the displacement, and by how many degrees it is turned about which axis.
struct Path {
    std::vector<Expression> displacement;
    std::optional<Expression> angle;
    std::vector<Expression> axis;
};

/// Not a number where the axis is zero, for check_paths to find.
Rotation turn(const Path& path, double t) {
    constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
    if (!path.angle) return {};
    const Vec3 axis{path.axis[0](t), path.axis[1](t), path.axis[2](t)};
    if (!(squared_norm(axis) > 0)) return {{Vec3{no_number, no_number, no_number}, {}, {}}};
    return rotation_about(axis, (*path.angle)(t) * std::numbers::pi / 180);
}

void read_turn(const CaseTable& table, Path& path, WrittenBody& written) {
    if (!table.has("angle") && !table.has("axis")) return;
    const Formula angle = table.formula("angle", Variables::time);
    path.angle = angle.value;
    written.angle = angle.written;
    std::vector<std::string> parts;
    Vec3 at_start;
    for (const Formula& part : table.formulas("axis", 3, "[x, y, z]", Variables::time)) {
        at_start[static_cast<int>(parts.size())] = part.value(0);
        path.axis.push_back(part.value);
        parts.push_back(part.written);
    }
    if (!(squared_norm(at_start) > 0)) table.refuse_value("axis", "must not be zero at t = 0");
    written.axis = fmt::format("[{}]", fmt::join(parts, ", "));
}

Motion read_motion(const CaseTable& table, WrittenBody& written) {
    table.allow({"x", "y", "z", "angle", "axis"});
    Path path;
    for (std::size_t i = 0; i < 3; ++i) {
        const Formula formula = table.has(coordinates[i]) ? table.formula(coordinates[i], Variables::time)
                                                          : Formula{Expression("0"), "0"};
        path.displacement.push_back(formula.value);
        written.motion[i] = formula.written;
    }
    read_turn(table, path, written);
    return [path](double t) {
        return Pose{{path.displacement[0](t), path.displacement[1](t), path.displacement[2](t)}, turn(path, t)};
    };
}

/// The largest growth, to three digits, at which the layer is no thicker than `most` [m].
double largest_growth(LayerOptions layer, double most) {
    double will_do = 0, too_much = layer.growth;
    for (int halving = 0; halving < 60; ++halving) {
        layer.growth = (will_do + too_much) / 2;
        (thickness(layer) <= most ? will_do : too_much) = layer.growth;
    }
    const double digit = std::pow(10.0, std::floor(std::log10(will_do)) - 2);
    return std::floor(will_do / digit) * digit;
}

/// Throws if the layer is thicker than the box, as when its heights overflow. What is too thick for its place is
/// found when the domain is meshed.
void check_thickness(const CaseTable& table, const LayerOptions& layer, const Box& box) {
    const Vec3 span = box.max - box.min;
    const double most = std::max({span.x, span.y, span.z});
    if (thickness(layer) <= most) return;
    if (layer.first_height >= most)
        table.refuse("first_height", fmt::format("must be below the size of the box, {} m, got {}", most,
                                                 layer.first_height));
    table.refuse("growth", fmt::format("{} makes a layer of {} prisms {:.3g} m thick, more than the box; at most "
                                       "{:.3g} would do",
                                       layer.growth, layer.count, thickness(layer),
                                       largest_growth(layer, most)));
}

LayerOptions read_layer(const CaseTable& table, const Box& box) {
    constexpr int most_prisms = 100;  // in a column; far beyond what resolves a boundary layer
    table.allow({"count", "first_height", "growth", "side", "min_gap"});
    LayerOptions layer;
    if (table.has("count")) layer.count = static_cast<int>(table.integer("count", 1, most_prisms));
    if (table.has("first_height")) layer.first_height = table.positive("first_height");
    if (table.has("growth")) layer.growth = table.positive("growth");
    if (table.has("min_gap")) layer.min_gap = table.positive("min_gap");
    if (table.has("side")) {
        const auto side = std::ranges::find(side_names, table.text("side"));
        if (side == side_names.end()) table.refuse_value("side", "must be \"outside\", \"inside\" or \"both\"");
        layer.side = static_cast<LayerOptions::Side>(side - side_names.begin());
    }
    check_thickness(table, layer, box);
    return layer;
}

}  // namespace

void read_bodies(const CaseTable& file, Case& it) {
    for (const CaseTable& table : file.tables("body")) {
        table.allow({"name", "shape", "centre", "radius", "axes", "rotation", "motion", "layer"});
        WrittenBody written;
        Body body{read_name(table, it.domain.bodies), read_shape(table, written)};
        if (table.has("motion")) body.motion = read_motion(table.table("motion"), written);
        if (table.has("layer")) body.layer = read_layer(table.table("layer"), it.domain.box);
        it.domain.bodies.push_back(std::move(body));
        it.written_bodies.push_back(std::move(written));
    }
}

}  // namespace kropla
