// The heat equation's options, initial state and energy; its step is in heat_step.cpp.
#include <kropla/simulate/heat.h>

#include <kropla/base/error.h>
#include "simulate/elements.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace kropla {
namespace {

std::string text(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

void check_positive(double value, const std::string& key) {
    if (std::isfinite(value) && value > 0) return;
    throw CaseError(key + " must be positive, got " + text(value));
}

void check_region(const HeatRegion& region, const std::string& key) {
    check_positive(region.material.conductivity, key + ".conductivity");
    check_positive(region.material.density, key + ".density");
    check_positive(region.material.specific_heat, key + ".specific_heat");
    if (!std::isfinite(region.initial))
        throw CaseError(key + ".initial must be finite, got " + text(region.initial));
}

}  // namespace

std::string region_key(const HeatOptions& options, std::size_t region) {
    const std::string& name = options.regions[region].name;
    if (!name.empty()) return "heat.region." + name;
    return region == 0 ? "heat.region.surroundings" : "heat.region.(body " + std::to_string(region) + ")";
}

std::string face_key(std::size_t face) {
    constexpr std::array<const char*, 6> names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
    return std::string("heat.face.") + names[face];
}

void check_heat(const HeatOptions& options, const Mesh& mesh) {
    for (std::size_t i = 0; i < options.regions.size(); ++i) check_region(options.regions[i], region_key(options, i));
    const std::size_t needed = count_regions(mesh);
    if (options.regions.size() < needed) {
        throw CaseError("heat: the mesh has " + std::to_string(needed) +
                        " regions, materials are given for " + std::to_string(options.regions.size()));
    }
    for (std::size_t f = 0; f < options.faces.size(); ++f) {
        const HeatFace& face = options.faces[f];
        if (face.kind == HeatFace::Kind::insulated || face.quantity) continue;
        const bool is_value = face.kind == HeatFace::Kind::value;
        throw CaseError(face_key(f) + (is_value ? ".value" : ".flux") + " is not given");
    }
}

NodalField initial_temperature(const Mesh& mesh, const HeatOptions& options) {
    check_heat(options, mesh);
    NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 0.0)};
    Array<Vertex, Region> region(mesh.position.size());
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) region[v] = std::max(region[v], cell_region(mesh, cell));
    });
    for (Vertex v : mesh.position.indices()) {
        if (region[v].exists())
            field.values[v] = options.regions[static_cast<std::size_t>(region[v].value)].initial;
    }
    return field;
}

double energy(const Mesh& mesh, const HeatOptions& options, const Array<Vertex, double>& temperature,
              Region only) {
    double sum = 0;
    for_each_cell(living_cells(mesh, only), [&](const auto& cell) {
        const auto& m = options.regions[static_cast<std::size_t>(cell_region(mesh, cell).value)].material;
        const auto values = at_corners(temperature, cell_vertices(mesh, cell));
        const auto points = cell_points(corners(mesh, cell));
        for (std::size_t k = 0; k < points.size(); ++k)
            sum += m.density * m.specific_heat * points[k].volume * mean_value(k, values);
    });
    return sum;
}

}  // namespace kropla
