#include "app/check.h"

#include "app/distribution.h"
#include "app/fault.h"
#include "app/shell_jump.h"
#include <kropla/base/error.h>
#include "base/tetrahedron.h"
#include <kropla/io/mesh_file.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numbers>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array aspect_edges = {3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 20.0, 50.0, infinity};  // [-] R/r
constexpr std::array dihedral_edges = {0.0,   20.0,  40.0,  60.0,  80.0,
                                       100.0, 120.0, 140.0, 160.0, 180.0};  // [deg]

/// The cells of one region, or of all.
struct Sample {
    std::size_t tets = 0, prisms = 0;
    double volume = 0;             // [m^3] of both
    std::vector<double> aspect;    // R/r, per tet
    std::vector<double> dihedral;  // [deg], six per tet
};
using Samples = std::vector<std::pair<std::string, Sample>>;  // by what the rows are called

void add(Sample& sample, const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    ++sample.tets;
    sample.volume += volume(mesh, t);
    const double ratio = aspect_ratio(mesh, t);
    sample.aspect.push_back(std::isnan(ratio) ? infinity : ratio);  // 0/0: too small for double precision
    for (const double angle : tet_dihedral_angles(mesh.position[v[0]], mesh.position[v[1]],
                                                  mesh.position[v[2]], mesh.position[v[3]]))
        sample.dihedral.push_back(angle * (180 / std::numbers::pi));
}

void add(Sample& sample, const Mesh& mesh, const Prism& prism) {
    ++sample.prisms;
    sample.volume += prism_volume(prism_corners(mesh, prism));
}

/// Per region in order, and last of all cells, where there are several regions. A file with more regions than
/// are of use to read (its "region" may be something else) is reported as a whole.
Samples samples_of(const Mesh& mesh) {
    constexpr std::size_t most = 16;
    std::map<Region, Sample> by_region;
    Sample all;
    for (const Tet t : mesh.tets.indices()) {
        add(all, mesh, t);
        if (by_region.size() <= most) add(by_region[mesh.region[t]], mesh, t);
    }
    for (const Prism& prism : all_prisms(mesh)) {
        add(all, mesh, prism);
        if (by_region.size() <= most) add(by_region[layer_of(mesh, prism.layer).region], mesh, prism);
    }
    Samples samples;
    if (by_region.size() <= most)
        for (auto& [region, sample] : by_region)
            samples.emplace_back(std::to_string(region.value), std::move(sample));
    if (samples.size() != 1) samples.emplace_back("all", std::move(all));
    return samples;
}

/// Breaks a text into lines of at most 78 columns, indented by two.
std::string wrapped(std::string_view text) {
    constexpr std::size_t width = 76;
    std::string lines;
    while (!text.empty()) {
        const std::size_t space = text.size() > width ? text.rfind(' ', width) : text.size();
        const std::size_t end = space == std::string_view::npos ? text.size() : space;
        lines += fmt::format("  {}\n", text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::size_t count_boundary_facets(const Mesh& mesh) {
    std::size_t count = 0;
    for (const auto& patches : mesh.patch)
        count += static_cast<std::size_t>(
            std::ranges::count_if(patches, [](Patch p) { return p.exists() && p.value < box_faces; }));
    return count;
}

std::size_t count_regions(const Mesh& mesh) {
    std::vector<Region> regions(mesh.region.begin(), mesh.region.end());
    std::ranges::sort(regions);
    return static_cast<std::size_t>(std::ranges::unique(regions).begin() - regions.begin());
}

std::string counts(const Mesh& mesh) {
    return fmt::format(
        "\nvertices        {:>10}\ntets            {:>10}\nprisms          {:>10}\n"
        "boundary facets {:>10}\nregions         {:>10}\n",
        count_vertices(mesh), count_tets(mesh), count_prisms(mesh), count_boundary_facets(mesh), count_regions(mesh));
}

std::string volumes(const Samples& samples) {
    std::string text =
        fmt::format("\n{:>6} {:>10} {:>10} {:>22}\n", "region", "tets", "prisms", "volume [m^3]");
    for (const auto& [name, sample] : samples)
        text += fmt::format("{:>6} {:>10} {:>10} {:>22.12e}\n", name, sample.tets, sample.prisms, sample.volume);
    return text;
}

/// Of each prism layer, what became of it; heights in micrometres.
std::string layers(const Mesh& mesh) {
    if (mesh.layers.empty()) return {};
    std::string text = fmt::format("\nprism layers: least scaled corner Jacobian (1 is perfect), heights [um]\n"
                                   "{:>4} {:>6} {:>5} {:>8} {:>8} {:>15} {:>13} {:>14}\n",
                                   "body", "region", "count", "prisms", "Jacobian", "first height", "growth",
                                   "thickness");
    const auto range = [](double least, double most, double unit, const char* form) {
        return fmt::format(fmt::runtime(form), least / unit) + " - " + fmt::format(fmt::runtime(form), most / unit);
    };
    constexpr double micrometre = 1e-6;  // [m]
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const PrismLayer& layer = mesh.layers[l];
        const LayerSummary s = summarise_layer(mesh, Layer(l));
        text += fmt::format("{:>4} {:>6} {:>5} {:>8} {:>8.4f} {:>15} {:>13} {:>14}\n", layer.body.value,
                            layer.region.value, layer.count, s.prisms, s.min_jacobian,
                            range(s.min_first_height, s.max_first_height, micrometre, "{:.4g}"),
                            range(s.min_growth, s.max_growth, 1, "{:.3f}"),
                            range(s.min_thickness, s.max_thickness, micrometre, "{:.4g}"));
    }
    return text;
}

/// How well cells fit where the prisms end.
std::string jumps(const Mesh& mesh) {
    std::string text;
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const std::vector<double> sorted = shell_jumps(mesh, Layer(l));
        if (sorted.empty()) continue;
        if (text.empty())
            text = "\nfirst tets against the last prisms: ratio of the cube roots of their volumes\n"
                   "body region     median    largest\n";
        text += fmt::format("{:>4} {:>6} {:>10.3f} {:>10.3f}\n", mesh.layers[l].body.value,
                            mesh.layers[l].region.value, sorted[sorted.size() / 2], sorted.back());
    }
    return text;
}

std::string table(const char* title, const Samples& samples, std::vector<double> Sample::* values) {
    std::string text = fmt::format("\n{}\n{:>6} {:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", title, "region",
                                   "min", "mean", "median", "99 %", "99.9 %", "max");
    for (const auto& [name, sample] : samples) {
        const Distribution d = distribution(sample.*values);
        text += fmt::format("{:>6} {:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4g}\n", name, d.min,
                            d.mean, d.median, d.p99, d.p999, d.max);
    }
    return text;
}

/// Aspect ratio and dihedral angles side by side.
std::string histograms(const Samples& samples) {
    std::string text;
    for (const auto& [name, sample] : samples) {
        if (name == "all" && samples.size() > 1) continue;
        const auto left = histogram(sample.aspect, aspect_edges);
        const auto right = histogram(sample.dihedral, dihedral_edges);
        text += fmt::format("\n{:<41}{}\n", "region " + name + ": cells by R/r", "dihedral angles [deg]");
        for (std::size_t i = 0; i < left.size(); ++i) text += fmt::format("{:<41}{}\n", left[i], right[i]);
    }
    return text;
}

/// `all` holds all cells in their order.
std::string worst_cell(const Mesh& mesh, const Sample& all) {
    const auto largest = std::ranges::max_element(all.aspect);
    const Tet worst(static_cast<std::size_t>(largest - all.aspect.begin()));
    return fmt::format("\nworst cell: {} at {}, region {}, R/r {:.4g}\n", worst.value,
                       place_of(mesh, worst), mesh.region[worst].value, *largest);
}

std::string note_of(const FileCells& cells) {
    if (cells.passed_over == 0) return {};
    return wrapped(fmt::format("{} cells of surfaces, lines or points are passed over: cells are counted without them",
                               cells.passed_over));
}

}  // namespace

CheckReport check_file(const std::filesystem::path& path) {
    FileCells cells = read_mesh_file(path);
    const std::size_t vertices = cells.position.size(), tets = cells.tets.size(), prisms = cells.prisms.size();
    const std::string note = note_of(cells);
    Mesh mesh;
    try {
        mesh = make_frame(std::move(cells)).mesh;
    } catch (const FileError& error) {
        return {.valid = false,
                .text = fmt::format("{}: invalid\n{}\nvertices {:>10}\ntets     {:>10}\nprisms   {:>10}\n",
                                    path.string(), wrapped(error.what()), vertices, tets, prisms)};
    }
    const std::string fault = fault_of(mesh);
    const Samples samples = samples_of(mesh);
    std::string text = fmt::format("{}: {}\n", path.string(), fault.empty() ? "valid" : "invalid") +
                       wrapped(fault) + note + counts(mesh) + volumes(samples) + layers(mesh) + jumps(mesh) +
                       table("aspect ratio R/r (3 is perfect)", samples, &Sample::aspect) +
                       table("dihedral angles [deg]", samples, &Sample::dihedral) + histograms(samples) +
                       worst_cell(mesh, samples.back().second);
    return {.valid = fault.empty(), .text = std::move(text)};
}

}  // namespace kropla
