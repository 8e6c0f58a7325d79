// Reading a case file: every key is checked here, once, so that the rest of the program may trust a Case.
#include "case/case.h"

#include "case/body.h"
#include "case/contact.h"
#include "case/flow.h"
#include "case/heat.h"
#include "case/mesh.h"
#include "case/species.h"
#include "case/parameters.h"
#include "case/patches.h"
#include "case/setting.h"
#include "case/table.h"
#include "case/local_size.h"
#include "case/mesh_size.h"
#include <kropla/base/error.h>
#include <kropla/domain/words.h>
#include "io/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr int most_steps = 1'000'000;  // a frame per step would be terabytes
constexpr double least_weight = 0.001;  // [-] of the larger of the paper's two; smaller ones mean the same, but for rounding
constexpr double least_floor = 5;  // [-] R/r; what is better is good enough for AdaptOptions, and left alone

Box read_box(const CaseTable& table) {
    table.allow({"min", "max", "mesh"});
    const Box box{table.place("min"), table.place("max")};
    for (int axis = 0; axis < 3; ++axis) {
        if (box.min[axis] < box.max[axis]) continue;
        table.refuse("max", fmt::format("must be above min, got {} = {} where min has {}", "xyz"[axis],
                                        box.max[axis], box.min[axis]));
    }
    return box;
}

/// Throws if at the box's coordinates doubles are too coarse for the size.
void check_resolved(const CaseTable& table, const char* key, double size, const Box& box) {
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({farthest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    if (size >= least_resolved * farthest) return;
    table.refuse_value(key, fmt::format("must be at least {:.1e} m where coordinates go up to {:.3g} m, for the "
                                              "sake of rounding (a box nearer to the origin allows less)",
                                              least_resolved * farthest, farthest));
}

/// The size of bodies that have none of their own: a length, or of the place.
void read_surface_size(const CaseTable& table, const std::vector<Body>& bodies, SizeField& size) {
    if (!is_of_place(table, "surface")) {
        size.surface = table.length("surface");
        return;
    }
    std::vector<Shape> shapes;
    for (const Body& body : bodies)
        if (!body.size) shapes.push_back(shape_at(body, 0));
    const PlacedSize placed = read_placed_size(table, "surface", shapes);
    size.surface = placed.most;
    size.local = placed.size;
}

/// With `own`, the size that a mesh has already, whatever is left out is of that.
SizeField read_size(const CaseTable& table, const Domain& domain, const std::optional<SizeField>& own) {
    const Box& box = domain.box;
    table.allow({"surface", "growth", "far", "least"});
    SizeField size = own.value_or(SizeField{});
    if (!own || table.has("surface")) read_surface_size(table, domain.bodies, size);
    if (!own || table.has("surface")) check_resolved(table, "surface", size.surface, box);
    if (!own || table.has("far")) size.far = table.length("far");
    else size.far = std::max(size.far, size.surface);
    if (table.has("growth")) size.growth = table.number("growth");
    if (!(size.growth >= 0 && size.growth <= 1)) table.refuse_value("growth", "must be from 0 to 1");
    if (size.far < size.surface) {
        table.refuse_value("far", fmt::format("must be at least surface = {}", size.surface));
    }
    if (table.has("least")) size.least = table.length("least");
    if (least_size(size) > size.surface) table.refuse_value("least", fmt::format("must be at most surface = {}", size.surface));
    if (size.least) check_resolved(table, "least", *size.least, box);
    return size;
}

/// Bodies' own sizes that are of the place.
void read_placed_sizes(const CaseTable& file, Domain& domain) {
    const std::vector<CaseTable> tables = file.tables("body");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        if (!is_of_place(tables[i], "size")) continue;
        Body& body = domain.bodies[i];
        const PlacedSize placed = read_placed_size(tables[i], "size", std::array{shape_at(body, 0)});
        body.size = placed.most;
        body.local_size = placed.size;
    }
}

/// Bodies' own sizes obey the rules of size.surface.
void check_body_sizes(const CaseTable& file, const Domain& domain) {
    const std::vector<CaseTable> tables = file.tables("body");
    for (std::size_t body = 0; body < tables.size(); ++body) {
        const std::optional<double>& size = domain.bodies[body].size;
        if (!size) continue;
        if (*size > domain.size.far) tables[body].refuse_value("size", fmt::format("must be at most size.far = {}", domain.size.far));
        check_resolved(tables[body], "size", *size, domain.box);
    }
}

/// The box, or a mesh that brings its own; the bodies; and the target size.
void read_domain(const CaseTable& file, const std::string& name, Case& given) {
    const CaseTable table = file.table("domain");
    std::optional<SizeField> own;
    if (table.has("mesh")) {
        table.allow({"min", "max", "mesh"});
        const CaseMesh mesh = read_case_mesh(table, name);
        take_case_mesh(table, mesh, read_region_bodies(file, mesh, given), given);
        own = size_of_mesh(*given.mesh->mesh, given.domain);
    } else {
        given.domain.box = read_box(table);
        read_bodies(file, given);
    }
    read_placed_sizes(file, given.domain);
    if (own && !file.has("size")) given.domain.size = *own;
    else given.domain.size = read_size(file.table("size"), given.domain, own);
    check_body_sizes(file, given.domain);
}

/// The weights of the paper's Laplacian; only their ratio counts.
LaplaceWeights read_weights(const CaseTable& table) {
    const std::vector<double> x = table.numbers("weights", 2, "[X1, X2]");
    const bool in_range = std::ranges::all_of(x, [](double w) { return w >= 0 && w <= 1; });
    if (!in_range || std::max(x[0], x[1]) < least_weight)
        table.refuse_value("weights", fmt::format("must be [X1, X2], each from 0 to 1, one of them at least {}", least_weight));
    return {x[0], x[1]};
}

std::optional<PaperMethod> read_method(const CaseTable& table) {
    const std::string method = table.has("method") ? table.text("method") : "kropla";
    if (method == "paper") return table.has("weights") ? PaperMethod{.weights = read_weights(table)} : PaperMethod{};
    if (method != "kropla") table.refuse_value("method", "must be \"kropla\" or \"paper\"");
    if (table.has("weights")) table.refuse("weights", "are those of method = \"paper\"; the method here is \"kropla\"");
    return std::nullopt;
}

QualityPlan read_quality(const CaseTable& table) {
    table.allow({"max_aspect_ratio", "method", "weights"});
    QualityPlan quality{.paper = read_method(table)};
    if (table.has("max_aspect_ratio")) quality.max_aspect_ratio = table.number("max_aspect_ratio");
    if (!(quality.max_aspect_ratio >= least_floor)) {
        table.refuse_value("max_aspect_ratio",
                           fmt::format("must be at least {} (3 is a perfect tet)", least_floor));
    }
    return quality;
}

TimePlan read_time(const CaseTable& table) {
    table.allow({"end", "steps", "courant"});
    TimePlan plan{table.positive("end"), static_cast<int>(table.integer("steps", 1, most_steps))};
    if (table.has("courant")) plan.courant = table.positive("courant");
    return plan;
}

OutputPlan read_output(const CaseTable& table) {
    table.allow({"every"});
    return table.has("every") ? OutputPlan{static_cast<int>(table.integer("every", 1, most_steps))}
                              : OutputPlan{};
}

RandomSeed read_random(const CaseTable& table) {
    table.allow({"seed"});
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    return table.has("seed") ? RandomSeed{static_cast<std::uint64_t>(table.integer("seed", 0, most))}
                             : RandomSeed{};
}

toml::table parse(std::string_view text, const std::string& name) {
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        throw CaseError(fmt::format("{}: (line {}): is not TOML: {}", name, error.source().begin.line,
                                    error.description()));
    }
}

/// What does not know bodies that deform.
void refuse_with_deforming(const CaseTable& file, const Case& given) {
    const auto deforms = std::ranges::find_if(given.domain.bodies, [](const Body& body) { return bool(body.deformation); });
    if (deforms == given.domain.bodies.end()) return;
    const std::string does = deforms->shape.cut ? "reaches through faces of the box" : "deforms";
    if (given.quality.paper) file.table("quality").refuse("method", fmt::format("\"paper\" moves rigid bodies; {} {}", named(*deforms), does));
}

}  // namespace

Case parse_case(std::string_view text, const std::string& name, std::span<const std::string> settings) {
    toml::table table = parse(text, name);
    apply_settings(settings, table);
    CaseReading reading{.file = name};
    const CaseTable file(reading, "", table);
    file.allow({"parameters", "domain", "body", "size", "quality", "time", "heat", "species", "flow", "contact", "output", "random"});
    if (file.has("parameters")) read_parameters(file.table("parameters"), reading);
    Case given;
    read_domain(file, name, given);
    name_faces(file, given, table);
    if (file.has("quality")) given.quality = read_quality(file.table("quality"));
    given.time = read_time(file.table("time"));
    if (file.has("heat")) given.heat = read_heat(file.table("heat"), given.domain, given.written_heat);
    read_species(file, given);
    read_flow(file, given);
    read_contact(file, given);
    refuse_with_deforming(file, given);
    if (given.time.courant && !given.flow) file.table("time").refuse("courant", "needs [flow]: what is to cross no more cells in a step");
    if (file.has("output")) given.output = read_output(file.table("output"));
    if (file.has("random")) given.random = read_random(file.table("random"));
    if (file.has("parameters"))
        for (const std::string& parameter : file.table("parameters").keys())
            given.parameters.push_back({parameter, reading.parameters.at(parameter), reading.used.contains(parameter)});
    given.written_numbers = std::move(reading.written);
    return given;
}

bool rests_on_faces(const Case& given, std::size_t body) {
    const WrittenBody& written = given.written_bodies[body];
    const bool has_path = written.motion != std::array<std::string, 3>{} || !written.angle.empty();
    return given.domain.bodies[body].shape.cut && given.liquid[body] == 0 && !has_path && written.velocity.empty();
}

Case read_case(const std::filesystem::path& path, std::span<const std::string> settings) {
    return parse_case(read_file(path), path.string(), settings);
}

}  // namespace kropla
