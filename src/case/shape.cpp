// Reading the shape of a [[body]].
#include "case/shape.h"

#include <kropla/base/error.h>
#include <kropla/base/predicates.h>
#include "domain/triangulated_surface.h"
#include <kropla/domain/solids.h>
#include "io/triangles.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <numbers>
#include <string_view>
#include <utility>

namespace kropla {
namespace {

std::string toml_list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// The ellipsoid, or with `cut = true` what of it is in the box.
Shape cut_if_told(const CaseTable& table, const Box& box, Shape ellipsoid, WrittenBody& written) {
    if (!table.has("cut") || !table.truth("cut")) return ellipsoid;
    const bool is_round = written.shape == "sphere";
    written.surface = {{"centre", toml_list(ellipsoid.centre)},
                       {is_round ? "radius" : "axes", is_round ? toml_number(ellipsoid.semi_axes.x) : toml_list(ellipsoid.semi_axes)},
                       {"cut", "true"}};
    try {
        return cut_ellipsoid(box, ellipsoid);
    } catch (const DomainError& error) {
        table.refuse("cut", error.what());
    }
}

Shape read_sphere(const CaseTable& table, const Box& box, WrittenBody& written) {
    if (table.has("axes")) table.refuse("axes", "a sphere has a radius instead");
    if (table.has("rotation")) table.refuse("rotation", "a sphere has none");
    const double radius = table.length("radius");
    return cut_if_told(table, box, {table.place("centre"), {radius, radius, radius}, {}}, written);
}

Rotation read_rotation(const CaseTable& table, WrittenBody& written) {
    if (!table.has("rotation")) return {};
    const std::vector<double> r = table.numbers("rotation", 4, "[axis x, y, z, degrees]");
    const Vec3 axis{r[0], r[1], r[2]};
    if (!(norm(axis) > 0)) table.refuse_value("rotation", "must have an axis that is not zero");
    written.rotation = fmt::format("[{}]", fmt::join(r, ", "));
    return rotation_about(axis, r[3] * std::numbers::pi / 180);
}

Shape read_ellipsoid(const CaseTable& table, const Box& box, WrittenBody& written) {
    if (table.has("radius")) table.refuse("radius", "an ellipsoid has axes = [a, b, c] instead");
    Shape shape{table.place("centre"), table.lengths("axes"), {}};
    shape.orientation = read_rotation(table, written);
    return cut_if_told(table, box, std::move(shape), written);
}

/// Where a file of the case is: beside the case file, if its path does not begin at the root.
std::filesystem::path beside_case(const CaseTable& table, const std::string& file) {
    return std::filesystem::absolute(std::filesystem::path(table.file()).parent_path() / file).lexically_normal();
}

Shape read_surface(const CaseTable& table, const Box& box, WrittenBody& written) {
    for (const char* key : {"radius", "axes"})
        if (table.has(key)) table.refuse(key, "a surface has file = \"...\", and scale, instead");
    const std::string file = table.text("file");
    if (file.empty()) table.refuse_value("file", "must name a file of triangles, STL or OBJ");
    const std::filesystem::path path = beside_case(table, file);
    const double scale = table.has("scale") ? table.length("scale") : 1.0;
    const Vec3 centre = table.place("centre");
    const Rotation rotation = read_rotation(table, written);
    const bool cut = table.has("cut") && table.truth("cut");
    written.surface = {{"centre", toml_list(centre)}, {"file", toml_text(path.string())}, {"scale", toml_number(scale)}};
    if (cut) written.surface.emplace_back("cut", "true");
    FileTriangles found;
    try {
        found = read_triangles(path);
    } catch (const FileError& error) {
        table.refuse("file", error.what());
    }
    for (Vec3& x : found.points) x = without_underflow(scale * x);
    try {
        Shape shape = shape_within(make_surface(found.points, found.triangles), centre, rotation);
        return cut ? cut_by(box, shape) : shape;
    } catch (const SurfaceError& error) {
        throw SurfaceFileError(table.refusal("file", fmt::format("{}: {}", path.string(), error.what())), found.points,
                               found.triangles, error.triangles);
    } catch (const DomainError& error) {
        table.refuse("cut", error.what());
    }
}

Shape read_slab(const CaseTable& table, const Box& box, WrittenBody& written) {
    const Vec3 min = table.place("min"), max = table.place("max");
    written.surface = {{"min", toml_list(min)}, {"max", toml_list(max)}};
    try {
        return slab(box, min, max);
    } catch (const DomainError& error) {
        table.refuse("max", error.what());
    }
}

Shape read_cylinder(const CaseTable& table, const Box& box, WrittenBody& written) {
    const Vec3 from = table.place("from"), to = table.place("to");
    const double radius = table.length("radius");
    written.surface = {{"from", toml_list(from)}, {"to", toml_list(to)}, {"radius", toml_number(radius)}};
    try {
        return cylinder(box, from, to, radius);
    } catch (const DomainError& error) {
        table.refuse("to", error.what());
    }
}

/// The keys of shapes but those of this one are not known to it.
void refuse_keys_of_others(const CaseTable& table, const std::string& shape) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> owners = {
        {{"file", "surface"}, {"scale", "surface"}, {"min", "slab"}, {"max", "slab"}, {"from", "cylinder"}, {"to", "cylinder"}}};
    for (const auto& [key, owner] : owners)
        if (shape != owner && table.has(key)) table.refuse(key, fmt::format("is of shape = \"{}\"", owner));
    if (shape != "slab" && shape != "cylinder") return;
    if (table.has("cut")) table.refuse("cut", "is of other shapes: a " + shape + " is cut away by itself where it is out of the box");
    for (const char* key : {"centre", "axes", "rotation"})
        if (table.has(key))
            table.refuse(key, shape == "slab" ? "a slab has min and max instead" : "a cylinder has from, to and radius instead");
    if (shape == "slab" && table.has("radius")) table.refuse("radius", "a slab has min and max instead");
}

}  // namespace

Shape read_shape(const CaseTable& table, const Box& box, WrittenBody& written) {
    written.shape = table.text("shape");
    refuse_keys_of_others(table, written.shape);
    if (written.shape == "surface") return read_surface(table, box, written);
    if (written.shape == "slab") return read_slab(table, box, written);
    if (written.shape == "cylinder") return read_cylinder(table, box, written);
    if (written.shape == "sphere") return read_sphere(table, box, written);
    if (written.shape == "ellipsoid") return read_ellipsoid(table, box, written);
    table.refuse_value("shape", "must be \"sphere\", \"ellipsoid\", \"slab\", \"cylinder\" or \"surface\"");
}

}  // namespace kropla
