#include "app/body_state.h"

#include "simulate/cells.h"
#include "simulate/elements.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace kropla {
namespace {

double area_of(const Mesh& mesh, const std::vector<std::array<Vertex, 3>>& facets) {
    double area = 0;
    for (const auto& facet : facets) area += norm(area_vector(mesh, facet));
    return area;
}

}  // namespace

std::vector<BodyState> body_states(const Domain& domain, const Mesh& mesh, const Array<Vertex, double>* temperature) {
    std::vector<BodyState> states(domain.bodies.size());
    for (BodyState& state : states) {
        state.coldest = temperature != nullptr ? INFINITY : 0;
        state.hottest = -state.coldest;
    }
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        const Region region = cell_region(mesh, cell);
        if (region.value == 0) return;
        BodyState& state = states[static_cast<std::size_t>(region.value - 1)];
        const auto vertices = cell_vertices(mesh, cell);
        const auto x = corners(mesh, cell);
        const auto points = cell_points(x);
        for (std::size_t k = 0; k < points.size(); ++k) {
            state.volume += points[k].volume;
            state.place += points[k].volume * mean_value(k, x);
            if (temperature != nullptr) state.mean += points[k].volume * mean_value(k, at_corners(*temperature, vertices));
        }
        if (temperature == nullptr) return;
        for (Vertex v : vertices) {
            state.coldest = std::min(state.coldest, (*temperature)[v]);
            state.hottest = std::max(state.hottest, (*temperature)[v]);
        }
    });
    for (std::size_t body = 0; body < states.size(); ++body) {
        BodyState& state = states[body];
        if (!(state.volume > 0)) continue;
        state.place = state.place / state.volume;
        state.mean /= state.volume;
        const RegionSurface surface = region_surface(mesh, Region(body + 1));
        state.area = area_of(mesh, surface.interface);
        state.on_faces = area_of(mesh, surface.outer);
    }
    return states;
}

}  // namespace kropla
