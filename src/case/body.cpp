// Reading [[body]]: shape, motion and prism layer.
#include "case/body.h"

#include "case/shape.h"
#include "case/deformation.h"
#include "case/local_size.h"
#include <kropla/base/error.h>
#include <kropla/domain/solids.h>
#include <kropla/domain/words.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <tuple>

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
    const auto alike = std::ranges::find(before, column_name(name), [](const Body& body) { return column_name(body.name); });
    if (alike != before.end())
        table.refuse("name", fmt::format("{} and {}, the name of body[{}], would both have the columns of {} in steps.csv; "
                                         "letters, digits, \"_\", \".\" and \"-\" tell names apart",
                                         toml_text(name), toml_text(alike->name), alike - before.begin(), column_name(name)));
    return name;
}

constexpr std::array<std::string_view, 3> coordinates = {"x", "y", "z"};

/// Where a body is as formulas of t: the displacement, and by how many degrees it is turned about which axis.
struct Path {
    std::vector<Expression> displacement;
    std::optional<Expression> angle;
    std::vector<Expression> axis;
};

/// Not a number where the axis is zero, for look_at_paths to find.
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

/// Along and about which axes a body is held.
SixVector read_hold(const CaseTable& table, WrittenKeys& written) {
    constexpr std::array<std::string_view, 6> words = {"x", "y", "z", "turn_x", "turn_y", "turn_z"};
    SixVector free = {1, 1, 1, 1, 1, 1};
    std::vector<std::string> held;
    for (const std::string& word : table.texts("hold", "names of what is held: x, y, z, turn, turn_x, turn_y, turn_z")) {
        const auto at = static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
        if (at < 6) free[at] = 0;
        else if (word == "turn") free[3] = free[4] = free[5] = 0;
        else table.refuse_value("hold", "must be of x, y, z, turn, turn_x, turn_y and turn_z");
        held.push_back(toml_text(word));
    }
    written.emplace_back("hold", fmt::format("[{}]", fmt::join(held, ", ")));
    return free;
}

FreeMotion read_free(const CaseTable& table, WrittenKeys& written) {
    table.allow({"kind", "density", "velocity", "spin", "hold"});
    FreeMotion motion;
    motion.density = table.positive("density");
    written.emplace_back("density", toml_number(motion.density));
    for (const auto& [key, what, vector] : {std::tuple{"velocity", "[u, v, w] [m/s]", &motion.velocity},
                                            std::tuple{"spin", "[x, y, z] [rad/s]", &motion.spin}}) {
        if (!table.has(key)) continue;
        const std::vector<double> v = table.numbers(key, 3, what);
        *vector = {v[0], v[1], v[2]};
        written.emplace_back(key, fmt::format("[{}, {}, {}]", v[0], v[1], v[2]));
    }
    if (table.has("hold")) motion.free = read_hold(table, written);
    for (int axis = 0; axis < 3; ++axis) {
        if (motion.free[as_size(axis)] == 0 && motion.velocity[axis] != 0)
            table.refuse("hold", fmt::format("holds {}, along which velocity is not zero", coordinates[as_size(axis)]));
        if (motion.free[as_size(axis) + 3] == 0 && motion.spin[axis] != 0)
            table.refuse("hold", fmt::format("holds turn_{}, about which spin is not zero", coordinates[as_size(axis)]));
    }
    return motion;
}

Motion read_path(const CaseTable& table, WrittenBody& written) {
    table.allow({"kind", "x", "y", "z", "angle", "axis"});
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

Deformation read_field(const CaseTable& table, const std::string& which, WrittenBody& written) {
    table.allow({"kind", "velocity"});
    const auto velocity = table.formulas("velocity", 3, "[u, v, w] [m/s], of x, y, z and t", Variables::time_and_place);
    written.velocity = fmt::format("[{}, {}, {}]", velocity[0].written, velocity[1].written, velocity[2].written);
    return deformation_by({velocity[0].value, velocity[1].value, velocity[2].value}, which + ".motion.velocity");
}

/// To three digits, rounded down: what is advised shall really do.
double rounded_down(double value) {
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return std::floor(value / digit) * digit;
}

/// Throws if the layer of a body has no height, or is thicker than the box, as when its heights overflow;
/// says what would fit. What is too thick for its place is found when the domain is meshed.
void check_heights(const CaseTable& table, const Domain& domain, std::size_t body) {
    const LayerOptions& layer = *domain.bodies[body].layer;
    const double room = room_for_layer(domain, body, 0);
    const std::string fits =
        room > 0 ? fmt::format("; the largest layer that fits is {:.3g} m thick", rounded_down(room)) : "";
    if (!(layer.first_height > 0))
        table.refuse("first_height", fmt::format("must be positive, got {}{}", layer.first_height, fits));
    const Vec3 span = domain.box.max - domain.box.min;
    const double most = std::max({span.x, span.y, span.z});
    if (thickness(layer) <= most) return;
    if (layer.first_height >= most)
        table.refuse("first_height", fmt::format("must be below the size of the box, {} m, got {}{}", most,
                                                 layer.first_height, fits));
    const double growth = fitting_growth(layer, room);
    const std::string advice = growth > 0 ? fmt::format(": at most {:.3g} would do", rounded_down(growth)) : "";
    table.refuse("growth", fmt::format("{} makes a layer of {} prisms {:.3g} m thick, more than the box{}{}",
                                       layer.growth, layer.count, thickness(layer), fits, advice));
}

LayerOptions read_layer(const CaseTable& table) {
    constexpr int most_prisms = 100;  // in a column; far beyond what resolves a boundary layer
    table.allow({"count", "first_height", "growth", "side", "min_gap"});
    LayerOptions layer;
    if (table.has("count")) layer.count = static_cast<int>(table.integer("count", 1, most_prisms));
    if (table.has("first_height")) layer.first_height = table.number("first_height");
    if (table.has("growth")) layer.growth = table.positive("growth");
    if (table.has("min_gap")) layer.min_gap = table.length("min_gap");
    if (table.has("side")) {
        const auto side = std::ranges::find(side_names, table.text("side"));
        if (side == side_names.end()) table.refuse_value("side", "must be \"outside\", \"inside\" or \"both\"");
        layer.side = static_cast<LayerOptions::Side>(side - side_names.begin());
    }
    return layer;
}

void go_with_flow(const CaseTable& table, Case& given, Body& body) {
    table.allow({"kind"});
    given.liquid.back() = 1;
    body.deformation = [](const Vec3& x, double, double) { return x; };  // each step says how
    body.keeps_volume = true;
}

void read_motion(const CaseTable& table, Case& given, Body& body, WrittenBody& written) {
    given.free.emplace_back();
    given.liquid.push_back(0);
    if (!table.has("motion")) return;
    const CaseTable motion = table.table("motion");
    const std::string kind = motion.has("kind") ? motion.text("kind") : "path";
    if (kind == "free") given.free.back() = read_free(motion, written.free);
    else if (kind == "path") body.motion = read_path(motion, written);
    else if (kind == "field")
        body.deformation = read_field(motion, fmt::format("body[{}]", given.domain.bodies.size()), written);
    else if (kind == "flow") go_with_flow(motion, given, body);
    else motion.refuse_value("kind", "must be \"path\", \"field\", \"free\" or \"flow\"");
}

void take_body(Case& given, Body body, WrittenBody written) {
    given.domain.bodies.push_back(std::move(body));
    given.written_bodies.push_back(std::move(written));
}

/// `whose` says which bodies stand at t = 0 where they are.
void refuse_moved_at_start(const CaseTable& table, const Body& body, const std::string& whose) {
    const Pose start = body.motion(0);
    for (int axis = 0; axis < 3; ++axis)
        if (start.displacement[axis] != 0)
            table.table("motion").refuse(coordinates[as_size(axis)], "must be 0 at t = 0 for " + whose);
    if (start.rotation.axes != Rotation{}.axes) table.table("motion").refuse("angle", "must be 0 at t = 0 for " + whose);
}

/// What bodies cannot have that reach through faces of the box.
void refuse_with_cut(const CaseTable& table, const Case& given, const Body& body) {
    int face = 0;
    while (!reaches(reached_faces(body.shape), face)) ++face;
    const std::string through = fmt::format("; this one reaches through {}", wall_name(face));
    if (body.layer) table.refuse("layer", "stands on bodies that are wholly in the box" + through);
    if (given.free.back()) table.table("motion").refuse("kind", "\"free\" is for bodies that are wholly in the box" + through);
    refuse_moved_at_start(table, body, "a body that is cut" + through);
}

}  // namespace

void read_bodies(const CaseTable& file, Case& given) {
    for (const CaseTable& table : file.tables("body")) {
        if (table.has("shape") && table.holds_text("shape") && table.text("shape") == "region")
            table.refuse("shape", "\"region\" is one of a mesh that domain.mesh names; there is none");
        table.allow({"name", "shape", "centre", "radius", "axes", "file", "scale", "rotation", "cut", "min", "max", "from", "to",
                     "size", "motion", "layer"});
        WrittenBody written;
        Body body{read_name(table, given.domain.bodies), read_shape(table, given.domain.box, written)};
        if (table.has("size") && !is_of_place(table, "size")) body.size = table.length("size");
        read_motion(table, given, body, written);
        if (table.has("layer")) body.layer = read_layer(table.table("layer"));
        if (body.deformation) body = keep_edges(std::move(body));
        if (reached_faces(body.shape) != 0) {
            refuse_with_cut(table, given, body);
            body = cut_body(std::move(body));
        }
        take_body(given, std::move(body), std::move(written));
    }
    const auto tables = file.tables("body");
    for (std::size_t body = 0; body < tables.size(); ++body)
        if (given.domain.bodies[body].layer) check_heights(tables[body].table("layer"), given.domain, body);
}

std::vector<int> read_region_bodies(const CaseTable& file, const CaseMesh& mesh, Case& given) {
    std::vector<int> regions;
    for (const CaseTable& table : file.tables("body")) {
        if (table.text("shape") != "region")
            table.refuse_value("shape", "must be \"region\" where domain.mesh brings the mesh");
        table.allow({"name", "shape", "region", "motion"});
        WrittenBody written;
        written.shape = "region";
        Body body{read_name(table, given.domain.bodies), {}};
        const int region = read_region(table, mesh);
        if (const auto same = std::ranges::find(regions, region); same != regions.end())
            table.refuse("region", fmt::format("is that of body[{}] already", same - regions.begin()));
        written.region = table.holds_text("region") ? toml_text(table.text("region")) : std::to_string(region);
        read_motion(table, given, body, written);
        refuse_moved_at_start(table, body, "a body that is a region of the mesh, which stands where that has it");
        take_body(given, std::move(body), std::move(written));
        regions.push_back(region);
    }
    return regions;
}

std::string column_name(const std::string& body) {
    std::string name = body;
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-'; };
    std::ranges::replace_if(name, [&](char c) { return !is_plain(static_cast<unsigned char>(c)); }, '_');
    return name;
}

}  // namespace kropla
