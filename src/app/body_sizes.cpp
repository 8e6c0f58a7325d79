#include "app/body_sizes.h"

#include "io/file.h"
#include <kropla/mesh/quality.h>
#include "report/table.h"
#include "simulate/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kropla {
namespace {

double mean_edge(const Mesh& mesh, const std::vector<std::array<Vertex, 3>>& triangles) {
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += distance(mesh.position[a], mesh.position[b]) + distance(mesh.position[b], mesh.position[c]) +
               distance(mesh.position[c], mesh.position[a]);
    return triangles.empty() ? 0 : sum / (3.0 * static_cast<double>(triangles.size()));
}

/// A name that has several lines on one.
std::string one_line(std::string name) {
    std::ranges::replace_if(name, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return name;
}

}  // namespace

std::vector<BodySize> body_sizes(const Domain& domain, const Mesh& mesh) {
    const std::size_t regions = domain.bodies.size() + 1;
    const std::vector<RegionSurface> surfaces = region_surfaces(mesh, regions);
    const std::vector<double> volumes = region_volumes(mesh, regions);
    std::vector<BodySize> sizes;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        const Body& of = domain.bodies[body];
        const auto& triangles = surfaces[body + 1].interface;
        sizes.push_back({of.name, of.shape.semi_axes, volume(of.shape), volumes[body + 1],
                         static_cast<int>(triangles.size()), mean_edge(mesh, triangles)});
    }
    return sizes;
}

std::string describe(const std::vector<BodySize>& sizes) {
    constexpr std::size_t most = 8;  // as many as stand on a screen beside what else is said
    std::string text;
    for (const BodySize& s : sizes) {
        if (static_cast<std::size_t>(&s - sizes.data()) == most)
            return text + fmt::format("and {} bodies more\n", sizes.size() - most);
        text += fmt::format("body \"{}\": semi-axes {:.4g}, {:.4g}, {:.4g} m; volume {:.6g} m^3, the mesh's off by "
                            "{:.0e} of it; {} triangles of edge {:.3g} m\n",
                            s.name, s.semi_axes.x, s.semi_axes.y, s.semi_axes.z, s.volume,
                            s.mesh_volume / s.volume - 1, s.triangles, s.mean_edge);
    }
    return text;
}

void write_bodies(const std::filesystem::path& path, const std::vector<BodySize>& sizes,
                  const std::vector<BodyState>& at_start, bool warm) {
    std::string text = "body,name,semi_axis_1 [m],semi_axis_2 [m],semi_axis_3 [m],volume [m^3],mesh_volume [m^3],"
                       "triangles,mean_edge [m],x [m],y [m],z [m]";
    text += warm ? ",temperature_min [K],temperature_mean [K],temperature_max [K]\n" : "\n";
    for (std::size_t body = 0; body < sizes.size(); ++body) {
        const BodySize& s = sizes[body];
        const BodyState& start = at_start[body];
        text += fmt::format("{},{},{},{},{},{},{},{},{},", body + 1, csv_cell(one_line(s.name)), s.semi_axes.x,
                            s.semi_axes.y, s.semi_axes.z, s.volume, s.mesh_volume, s.triangles, s.mean_edge);
        text += fmt::format("{},{},{}", start.place.x, start.place.y, start.place.z);
        if (warm) text += fmt::format(",{},{},{}", start.coldest, start.mean, start.hottest);
        text += '\n';
    }
    write_file(path, text);
}

}  // namespace kropla
