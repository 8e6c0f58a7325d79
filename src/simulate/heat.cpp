// The heat equation's options, initial state and energy; its step is in heat_step.cpp.
#include <kropla/simulate/heat.h>

#include <kropla/base/error.h>
#include "simulate/elements.h"
#include "simulate/heat_cell.h"
#include "simulate/step_mean.h"

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

void check_positive(const Property& property, const std::string& key) {
    for (std::size_t k = 0; k < property.values().size(); ++k) {
        const double value = property.values()[k];
        if (std::isfinite(value) && value > 0) continue;
        throw CaseError(key + " must be positive, got " + text(value) +
                        (property.constant() ? "" : " at " + text(property.temperatures()[k]) + " K"));
    }
}

void check_region(const HeatRegion& region, const std::string& key) {
    const HeatMaterial& m = region.material;
    check_positive(m.conductivity, key + ".conductivity");
    check_positive(m.density, key + ".density");
    check_positive(m.specific_heat, key + ".specific_heat");
    if (!(m.latent_heat >= 0 && std::isfinite(m.latent_heat)))
        throw CaseError(key + ".latent_heat must be at least 0, got " + text(m.latent_heat));
    if (m.latent_heat > 0 && !(m.solidus < m.liquidus))
        throw CaseError(key + ".solidus must be below liquidus, got " + text(m.solidus) + " and " + text(m.liquidus) + " K");
    if (!std::isfinite(region.initial.value))
        throw CaseError(key + ".initial must be finite, got " + text(region.initial.value));
    if (region.held && !std::isfinite(*region.held))
        throw CaseError(key + ".held must be finite, got " + text(*region.held));
}

/// Where a rising function is zero, between `low` and `high`: by halves, to neighbouring numbers.
template <class Function>
double rising_root(const Function& function, double low, double high) {
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (!(low < middle && middle < high)) return function(high) <= 0 ? high : low;
        (function(middle) <= 0 ? low : high) = middle;
    }
}

void check_exchange(const HeatExchange& exchange, const std::string& key) {
    if ((exchange.coefficient || exchange.emissivity) && !exchange.ambient)
        throw CaseError(key + ".ambient is not given: the temperature [K] with which heat is exchanged");
}

}  // namespace

std::string region_key(const HeatOptions& options, std::size_t region) {
    const std::string& name = options.regions[region].name;
    if (!name.empty()) return options.key + ".region." + name;
    return options.key + (region == 0 ? ".region.surroundings" : ".region.(body " + std::to_string(region) + ")");
}

std::string surface_key(const HeatOptions& options, std::size_t region) {
    const std::string& name = options.regions[region].name;
    return options.key + ".surface." + (name.empty() ? "(body " + std::to_string(region) + ")" : name);
}

std::string face_key(const HeatOptions& options, std::size_t face) {
    constexpr std::array<const char*, 6> names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
    return options.key + ".face." + names[face];
}

void check_heat(const HeatOptions& options, const Mesh& mesh) {
    for (std::size_t i = 0; i < options.regions.size(); ++i) check_region(options.regions[i], region_key(options, i));
    const std::size_t needed = count_regions(mesh);
    if (options.regions.size() < needed) {
        throw CaseError(options.key + ": the mesh has " + std::to_string(needed) +
                        " regions, materials are given for " + std::to_string(options.regions.size()));
    }
    for (std::size_t body = 1; body <= options.surfaces.size(); ++body)
        check_exchange(options.surfaces[body - 1].exchange, surface_key(options, body));
    for (std::size_t f = 0; f < options.faces.size(); ++f) {
        const HeatFace& face = options.faces[f];
        check_exchange(face.exchange, face_key(options, f));
        if (face.kind == HeatFace::Kind::value && !face.quantity) throw CaseError(face_key(options, f) + ".value is not given");
        if (face.kind == HeatFace::Kind::flux && !face.quantity && !face.power)
            throw CaseError(face_key(options, f) + ".flux is not given");
    }
}

namespace {

/// What a curve's value is multiplied by.
double density_at(const KnownDensity& known, Region region, Vertex v) {
    return region == known.region ? known.values[v] : 1;
}

}  // namespace

bool proportional(const HeatOptions& options) {
    return std::ranges::all_of(enthalpy_curves(options), [](const Enthalpy& h) { return h.proportional(); });
}

std::vector<double> capacities(const HeatOptions& options) {
    std::vector<double> capacity;
    for (const Enthalpy& h : enthalpy_curves(options)) capacity.push_back(h.slope(0));
    return capacity;
}

std::vector<Array<Vertex, double>> enthalpies(const Mesh& mesh, const HeatOptions& options,
                                              const Array<Vertex, double>& temperature, const KnownDensity& known) {
    const Array<Region, Enthalpy> curve = enthalpy_curves(options, known.region);
    std::vector<Array<Vertex, double>> all(options.regions.size(), Array<Vertex, double>(mesh.position.size(), 0.0));
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        const Region region = cell_region(mesh, cell);
        for (Vertex v : cell_vertices(mesh, cell))
            all[static_cast<std::size_t>(region.value)][v] = density_at(known, region, v) * curve[region](temperature[v]);
    });
    return all;
}

double energy_of(const Mesh& mesh, const std::vector<Array<Vertex, double>>& enthalpies) {
    double sum = 0;
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        const auto& enthalpy = enthalpies[static_cast<std::size_t>(cell_region(mesh, cell).value)];
        const auto values = at_corners(enthalpy, cell_vertices(mesh, cell));
        const auto points = cell_points(corners(mesh, cell));
        for (std::size_t k = 0; k < points.size(); ++k) sum += points[k].volume * mean_value(k, values);
    });
    return sum;
}

double energy(const Mesh& mesh, const HeatOptions& options, const Array<Vertex, double>& temperature, Region only,
              const KnownDensity& known) {
    const Array<Region, Enthalpy> curve = enthalpy_curves(options, known.region);
    double sum = 0;
    for_each_cell(living_cells(mesh, only), [&](const auto& cell) {
        const Region region = cell_region(mesh, cell);
        const Enthalpy& h = curve[region];
        const auto vertices = cell_vertices(mesh, cell);
        auto values = at_corners(temperature, vertices);
        if (h.proportional()) {
            for (const double slope = h.slope(0); double& value : values) value *= slope;
        } else {
            for (double& value : values) value = h(value);
        }
        if (region == known.region)
            for (std::size_t i = 0; i < vertices.size(); ++i) values[i] *= known.values[vertices[i]];
        const auto points = cell_points(corners(mesh, cell));
        for (std::size_t k = 0; k < points.size(); ++k) sum += points[k].volume * mean_value(k, values);
    });
    return sum;
}

void temperature_of(const Mesh& mesh, const HeatOptions& options, const std::vector<Array<Vertex, double>>& enthalpies,
                    Array<Vertex, double>& temperature, const KnownDensity& known) {
    const Array<Region, Enthalpy> curve = enthalpy_curves(options, known.region);
    struct Part {
        Region region;
        double volume = 0;
    };
    Array<Vertex, std::vector<Part>> parts(mesh.position.size());  // of each region at the vertex
    for_each_share(mesh, living_cells(mesh), [&](const auto& cell, Vertex v, double volume) {
        const Region region = cell_region(mesh, cell);
        auto part = std::ranges::find(parts[v], region, &Part::region);
        if (part == parts[v].end()) part = parts[v].insert(part, {region});
        part->volume += volume;
    });
    temperature.resize(mesh.position.size(), 0.0);
    for (Vertex v : parts.indices()) {
        if (parts[v].empty()) continue;
        const auto held = [&](const Part& part) { return enthalpies[static_cast<std::size_t>(part.region.value)][v]; };
        const auto density = [&](const Part& part) { return density_at(known, part.region, v); };
        const auto alone = [&](const Part& part) { return curve[part.region].temperature(held(part) / density(part)); };
        if (parts[v].size() == 1) {
            temperature[v] = alone(parts[v].front());
            continue;
        }
        double low = INFINITY, high = -INFINITY, all = 0;  // the common temperature is between those of the sides
        for (const Part& part : parts[v]) {
            low = std::min(low, alone(part));
            high = std::max(high, alone(part));
            all += part.volume * held(part);
        }
        const auto rest = [&](double at) {
            double sum = -all;
            for (const Part& part : parts[v]) sum += part.volume * density(part) * curve[part.region](at);
            return sum;
        };
        temperature[v] = rising_root(rest, low, high);
    }
}

}  // namespace kropla
