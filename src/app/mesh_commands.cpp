#include "app/mesh_commands.h"

#include "app/commands.h"
#include "app/distribution.h"
#include "app/interface_patches.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include <kropla/base/error.h>
#include <kropla/io/fixed_mesh.h>
#include <kropla/io/mesh_file.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/step/remesh_interfaces.h>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace kropla {
namespace {

void check_names(const MeshFiles& files) {
    for (const auto& path : {files.in, files.out})
        if (!is_mesh_file(path))
            throw CaseError(fmt::format("{}: is of no format that is known; the name is to end in {}", path.string(),
                                        mesh_extensions));
}

/// "3 patches (inlet, outlet, 7)": by name, else by number.
std::string parts(const char* one, const char* many, const std::vector<int>& numbers, const Names& names) {
    constexpr std::size_t most = 12;
    std::vector<std::string> words;
    for (const int number : numbers) {
        const auto name = names.find(number);
        words.push_back(name != names.end() ? name->second : std::to_string(number));
    }
    const std::string more = words.size() > most ? ", ..." : "";
    words.resize(std::min(words.size(), most));
    const std::string list = words.empty() ? "" : fmt::format(" ({}{})", fmt::join(words, ", "), more);
    return fmt::format("{} {}{}", numbers.size(), numbers.size() == 1 ? one : many, list);
}

std::string describe(const std::filesystem::path& path, const FileCells& cells) {
    return fmt::format("{}: {} tets, {} prisms, {} vertices, {}, {}\n", path.string(), cells.tets.size(),
                       cells.prisms.size(), cells.position.size(),
                       parts("region", "regions", region_numbers(cells), cells.region_names),
                       parts("patch", "patches", patch_numbers(cells), cells.patch_names));
}

void note(std::size_t count, const char* one, const char* many) {
    if (count > 0) fmt::print("{} {}\n", count, count == 1 ? one : many);
}

/// Read, tidied, with a boundary; says what was done.
FileCells read_tidied(const std::filesystem::path& path, const Watch& watch) {
    FileCells cells = read_mesh_file(path, &watch);
    const Tidied done = tidy(cells);
    note(done.united, "vertex at the place of another was united with it", "vertices at places of others were united with them");
    note(done.unused, "vertex of no cell was dropped", "vertices of no cell were dropped");
    note(done.turned, "cell was inside out and was turned round", "cells were inside out and were turned round");
    note(cells.passed_over, "cell without volume and without a number was passed over",
         "cells without volume and without a number were passed over");
    if (add_boundary(cells)) fmt::print("no facets are in the file: its boundary is the patch \"boundary\"\n");
    return cells;
}

/// Fields of vertices are of VTU alone.
void drop_fields(FileCells& cells, const char* why) {
    std::vector<std::string> names;
    for (const NodalField& field : cells.fields) names.push_back(field.name);
    for (const NodalVectorField& field : cells.vectors) names.push_back(field.name);
    if (!names.empty()) fmt::print("left out, {}: {}\n", why, fmt::join(names, ", "));
    cells.fields.clear();
    cells.vectors.clear();
}

/// One side of the table of `improve`.
struct Quality {
    QualitySummary summary;
    std::size_t above_10 = 0;
    TriangleSummary surfaces = {};  // of interfaces
};

Quality quality_of(const Mesh& mesh) {
    Quality quality{summarise_quality(mesh)};
    quality.surfaces = summarise_triangles(mesh, interfaces(mesh));
    for (const Tet t : all_tets(mesh)) quality.above_10 += !(aspect_ratio(mesh, t) <= 10) ? 1u : 0u;
    return quality;
}

void print_table(const Quality& before, const Quality& after, double seconds) {
    const auto row = [](const char* what, auto left, auto right, const char* form) {
        fmt::print("{:<26}{:>12}{:>12}\n", what, fmt::format(fmt::runtime(form), left),
                   fmt::format(fmt::runtime(form), right));
    };
    const QualitySummary &a = before.summary, &b = after.summary;
    fmt::print("{:<26}{:>12}{:>12}\n", "", "before", "after");
    row("tets", a.tets, b.tets, "{}");
    row("vertices of tets", a.vertices, b.vertices, "{}");
    row("worst R/r", a.max_aspect_ratio, b.max_aspect_ratio, "{:.4g}");
    row("R/r, 99.9 %", a.p999_aspect_ratio, b.p999_aspect_ratio, "{:.4g}");
    row("least dihedral [deg]", a.min_dihedral, b.min_dihedral, "{:.2f}");
    row("largest dihedral [deg]", a.max_dihedral, b.max_dihedral, "{:.2f}");
    row("tets above R/r 10", before.above_10, after.above_10, "{}");
    if (before.surfaces.triangles > 0) {
        row("triangles of interfaces", before.surfaces.triangles, after.surfaces.triangles, "{}");
        row("their least angle [deg]", before.surfaces.least_angle, after.surfaces.least_angle, "{:.2f}");
        row("their largest angle [deg]", before.surfaces.greatest_angle, after.surfaces.greatest_angle, "{:.2f}");
    }
    fmt::print("{:<26}{:>24}\n", "seconds", fmt::format("{:.2f}", seconds));
}

/// Says which interfaces stay as they are.
std::vector<LooseInterface> loose_interfaces_told(const FixedMesh& fixed, const FileCells& cells) {
    auto loose = loose_interfaces(fixed, cells);
    for (const Interface& surface : interfaces(fixed.mesh)) {
        const auto is_it = [&](const LooseInterface& other) {
            return other.interface.inner == surface.inner && other.interface.outer == surface.outer;
        };
        if (std::ranges::none_of(loose, is_it))
            fmt::print("the interface of regions {} and {} stays as it is: {}\n", surface.outer.value, surface.inner.value,
                       surface.is_apart ? "it has several patches, or one on a part of it"
                                   : "it is at the boundary, at a third region, or touches itself");
    }
    return loose;
}

}  // namespace

int convert_mesh(const MeshFiles& files) {
    check_names(files);
    Watch watch;
    const CatchInterrupts catching(watch);
    FileCells cells = read_tidied(files.in, watch);
    if (files.out.extension() != ".vtu") drop_fields(cells, "as only VTU holds fields here");
    write_mesh_file(files.out, cells, &watch);
    fmt::print("{}", describe(files.out, cells));
    return done;
}

int improve_mesh_file(const MeshFiles& files) {
    check_names(files);
    Watch watch;
    const CatchInterrupts catching(watch);
    FileCells cells = read_tidied(files.in, watch);
    FixedMesh fixed = [&] {
        try {
            return fixed_mesh(cells);
        } catch (const FileError& error) {
            throw FileError(fmt::format("{}: {}", files.in.string(), error.what()));
        }
    }();
    if (const std::string fault = fault_of_sides(fixed); !fault.empty())
        throw FileError(fmt::format("{}: {}: the mesh overlaps itself and cannot be improved", files.in.string(), fault));
    drop_fields(cells, "as vertices change");
    std::optional<tbb::global_control> threads;
    if (files.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(files.threads));
    std::vector<LooseInterface> loose;
    if (files.remesh_surface) loose = loose_interfaces_told(fixed, cells);
    take_facets(fixed, loose, cells);
    const Quality before = quality_of(fixed.mesh);
    const auto start = std::chrono::steady_clock::now();
    std::vector<Interface> free;
    for (const LooseInterface& surface : loose) free.push_back(surface.interface);
    (void)remesh_interfaces(fixed.mesh, free, {.watch = &watch});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const Quality after = quality_of(fixed.mesh);
    note(put_back(fixed, cells), "facet within a region went", "facets within regions went");
    give_facets(loose, cells);
    write_mesh_file(files.out, cells, &watch);
    print_table(before, after, seconds);
    fmt::print("{}", describe(files.out, cells));
    return done;
}

}  // namespace kropla
