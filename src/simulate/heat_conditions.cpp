#include "simulate/heat_conditions.h"

#include "simulate/elements.h"
#include "simulate/step_mean.h"
#include <kropla/base/error.h>
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace kropla {
namespace {

constexpr double stefan_boltzmann = 5.670374419e-8;  // [W/(m^2 K^4)] CODATA 2018

/// What sources and fluxes act over.
struct StepInTime {
    const Mesh& before;
    const Mesh& current;
    double begin, dt;  // [s]
    const Watch* watch;

    [[nodiscard]] double end() const { return begin + dt; }
};

/// The means over the step of a quantity at these vertices, in their order.
std::vector<double> means_at(const StepInTime& step, const Quantity& quantity, const std::vector<Vertex>& vertices,
                             const std::string& key) {
    std::vector<Way> ways;
    ways.reserve(vertices.size());
    for (Vertex v : vertices) ways.push_back({step.before.position[v], step.current.position[v]});
    return step_means(quantity, ways, step.begin, step.dt, key, step.watch);
}

/// Vertices, and the integral of each one's shape function over a region [m^3] or a surface [m^2].
struct Shares {
    std::vector<Vertex> vertices;
    std::vector<double> size;
};

Shares listed(const Array<Vertex, double>& size) {
    Shares shares;
    for (Vertex v : size.indices()) {
        if (size[v] == 0) continue;
        shares.vertices.push_back(v);
        shares.size.push_back(size[v]);
    }
    return shares;
}

Shares shares_of_region(const Mesh& mesh, Region region) {
    Array<Vertex, double> volume(mesh.position.size(), 0.0);
    for_each_share(mesh, living_cells(mesh, region), [&](const auto&, Vertex v, double share) { volume[v] += share; });
    return listed(volume);
}

Shares shares_of_surface(const Mesh& mesh, const std::vector<std::array<Vertex, 3>>& facets) {
    Array<Vertex, double> area(mesh.position.size(), 0.0);
    for (const auto& facet : facets)
        for (Vertex v : facet) area[v] += norm(area_vector(mesh, facet)) / 3;
    return listed(area);
}

/// Scales the means so that their integral is the power, where one is given. `key` is of the two together.
void scale_to_power(const StepInTime& step, const Quantity& power, const Shares& shares, const std::string& key,
                    std::vector<double>& means) {
    if (!power) return;
    const double wanted = step_means(power, std::vector<Way>(1), step.begin, step.dt, key + ".power", step.watch).front();
    double integral = 0;
    for (std::size_t k = 0; k < means.size(); ++k) integral += means[k] * shares.size[k];
    if (integral == 0 && wanted != 0)
        throw CaseError(key + ".power has no place to go: what it is to be spread by is zero at every vertex");
    for (double& mean : means) mean *= integral != 0 ? wanted / integral : 0;
}

Quantity one_everywhere() { return Constant{1.0}; }

Array<Region, Array<Vertex, double>> sources(const StepInTime& step, const HeatOptions& options) {
    Array<Region, Array<Vertex, double>> source(options.regions.size());
    for (Region r : source.indices()) {
        const HeatRegion& region = options.regions[static_cast<std::size_t>(r.value)];
        if (!region.source && !region.power) continue;
        const std::string key = region_key(options, static_cast<std::size_t>(r.value));
        const Shares shares = shares_of_region(step.current, r);
        std::vector<double> means =
            means_at(step, region.source ? region.source : one_everywhere(), shares.vertices, key + ".source");
        scale_to_power(step, region.power, shares, key, means);
        source[r].resize(step.current.position.size(), 0.0);
        for (std::size_t k = 0; k < means.size(); ++k) source[r][shares.vertices[k]] = means[k];
    }
    return source;
}

class Boundary {
public:
    Boundary(const StepInTime& step, HeatConditions& conditions) : step_(step), conditions_(conditions) {}

    void add_flux(const Shares& shares, const Quantity& flux, const Quantity& power, Origin origin, const std::string& key) {
        if (!flux && !power) return;
        std::vector<double> means = means_at(step_, flux ? flux : one_everywhere(), shares.vertices, key + ".flux");
        scale_to_power(step_, power, shares, key, means);
        for (std::size_t k = 0; k < means.size(); ++k)
            conditions_.shares.push_back({.vertex = shares.vertices[k], .origin = origin, .flux = means[k] * shares.size[k]});
    }

    void add_known(const Shares& shares, const std::vector<double>& flux, Origin origin) {
        for (std::size_t k = 0; k < flux.size(); ++k)
            conditions_.shares.push_back({.vertex = shares.vertices[k], .origin = origin, .flux = flux[k] * shares.size[k]});
    }

    void add_exchange(const Shares& shares, const HeatExchange& exchange, Origin origin, const std::string& key) {
        if (!exchange.coefficient && !exchange.emissivity) return;
        for (std::size_t k = 0; k < shares.vertices.size(); ++k) {
            const Vertex v = shares.vertices[k];
            const double coefficient = value(exchange.coefficient, v, key + ".coefficient", 0, INFINITY);
            const double emissivity = value(exchange.emissivity, v, key + ".emissivity", 0, 1);
            const double least = exchange.emissivity ? 0 : -INFINITY;
            conditions_.shares.push_back({.vertex = v,
                                          .origin = origin,
                                          .coefficient = coefficient * shares.size[k],
                                          .radiation = stefan_boltzmann * emissivity * shares.size[k],
                                          .ambient = value(exchange.ambient, v, key + ".ambient", least, INFINITY)});
        }
    }

private:
    double value(const Quantity& quantity, Vertex v, const std::string& key, double least, double most) const {
        if (!quantity) return 0;
        const double found = value_at(quantity, step_.current.position[v], step_.end(), key);
        if (found >= least && found <= most) return found;
        throw CaseError(key + " must be " + (most == 1 ? "from 0 to 1" : "at least 0") + ", got " +
                        std::to_string(found) + " at t = " + std::to_string(step_.end()) + " s");
    }

    const StepInTime& step_;
    HeatConditions& conditions_;
};

/// What is at no vertex of the cells.
void leave_others_out(const Mesh& mesh, const Cells& cells, HeatConditions& conditions) {
    Array<Vertex, char> there(mesh.position.size(), 0);
    for (Vertex v : vertices_of(mesh, cells)) there[v] = 1;
    const auto is_elsewhere = [&](const auto& at) { return there[at.vertex] == 0; };
    std::erase_if(conditions.shares, is_elsewhere);
    std::erase_if(conditions.fixed, is_elsewhere);
}

}  // namespace

double BoundaryShare::given(double temperature) const {
    const double square = temperature * temperature, ambient_square = ambient * ambient;
    return coefficient * (temperature - ambient) +
           radiation * (square + ambient_square) * (temperature + ambient) * (temperature - ambient);
}

double BoundaryShare::slope(double temperature) const {
    return coefficient + 4 * radiation * temperature * temperature * temperature;
}

HeatConditions heat_conditions(const Mesh& before, const Mesh& current, const HeatOptions& options, Region only, double t,
                               double dt, const Watch* watch) {
    const StepInTime step{before, current, t, dt, watch};
    HeatConditions conditions{sources(step, options), {}, {}};
    Boundary boundary(step, conditions);
    Array<Vertex, char> is_fixed(current.position.size(), 0);
    const auto fix = [&](Vertex v, double value, Origin origin) {
        if (std::exchange(is_fixed[v], 1) == 0) conditions.fixed.push_back({v, value, origin});
    };

    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        if (!options.regions[r].held) continue;
        for (Vertex v : shares_of_region(current, Region(r)).vertices)
            fix(v, *options.regions[r].held, {Origin::Kind::held, r});
    }
    const Cells cells = living_cells(current, only);
    const auto facets = facets_of_faces(current, cells);
    for (std::size_t f = 0; f < options.faces.size(); ++f) {
        const HeatFace& face = options.faces[f];
        if (face.kind == HeatFace::Kind::insulated) continue;
        const Shares shares = shares_of_surface(current, facets[f]);
        const Origin origin{Origin::Kind::face, f};
        if (face.kind == HeatFace::Kind::value) {
            for (Vertex v : shares.vertices)
                fix(v, value_at(face.quantity, current.position[v], step.end(), face_key(options, f) + ".value"), origin);
        } else if (face.kind == HeatFace::Kind::flux) {
            boundary.add_flux(shares, face.quantity, face.power, origin, face_key(options, f));
        } else {
            boundary.add_exchange(shares, face.exchange, origin, face_key(options, f));
        }
    }
    for (std::size_t body = 1; body <= options.surfaces.size(); ++body) {
        const HeatSurface& surface = options.surfaces[body - 1];
        if (!surface.flux && !surface.power && surface.at_vertices.empty() && !surface.exchange.coefficient &&
            !surface.exchange.emissivity)
            continue;
        const Shares shares = shares_of_surface(current, region_surface(current, Region(body)).interface);
        const Origin origin{Origin::Kind::surface, body};
        boundary.add_flux(shares, surface.flux, surface.power, origin, surface_key(options, body));
        boundary.add_known(shares, surface.at_vertices, origin);
        boundary.add_exchange(shares, surface.exchange, origin, surface_key(options, body));
    }
    if (only.exists()) leave_others_out(current, cells, conditions);
    return conditions;
}

}  // namespace kropla
