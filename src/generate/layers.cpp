// Prism layers (paper 1.4): columns along the wall's normals, as high as there is room for.

#include "generate/layers.h"

#include "domain/layer_room.h"
#include "generate/normals.h"

#include <algorithm>
#include <cassert>

namespace kropla {

namespace {

std::size_t body_of(const PrismLayer& layer) { return static_cast<std::size_t>(layer.body.value) - 1; }

/// The point of the body's surface that is meant by a vertex of its wall, which stands somewhat out of it: gaps
/// and rooms are the body's, whatever its triangles.
Vec3 meant_by(const Vec3& wall_vertex, std::size_t body, const Snapshot& at) {
    return closest_point(at.shapes[body], wall_vertex);
}

}  // namespace

std::vector<Vec3> column_places(const PrismLayer& layer, std::span<const Vec3> wall, const Snapshot& at) {
    const std::size_t body = body_of(layer);
    const bool inside = layer.region == layer.body;
    const LayerOptions* options = layer_at_side(at, body, inside);
    assert(options && options->count == layer.count);
    const double full = thickness(*options);
    const std::vector<Vec3> normals = surface_normals(wall, layer.triangles);
    std::vector<Vec3> places;
    places.reserve(wall.size() * static_cast<std::size_t>(layer.count + 1));
    for (std::size_t column = 0; column < wall.size(); ++column) {
        const double factor = layer_thickness(at, body, inside, meant_by(wall[column], body, at)) / full;
        double above = 0, height = factor * options->first_height;
        places.push_back(wall[column]);
        for (int k = 0; k < layer.count; ++k, height *= options->growth) {
            above += height;
            places.push_back(wall[column] + above * normals[column]);
        }
    }
    return places;
}

std::vector<Vec3> wall_places(const Mesh& mesh, const PrismLayer& layer) {
    std::vector<Vec3> places;
    for (int column = 0; column < count_columns(layer); ++column)
        places.push_back(mesh.position[column_vertex(layer, column, 0)]);
    return places;
}

std::optional<NarrowestGap> narrowest_gap(const Mesh& mesh, const Snapshot& at) {
    std::optional<NarrowestGap> narrowest;
    for (const PrismLayer& layer : mesh.layers) {
        const std::size_t body = body_of(layer);
        if (layer.region == layer.body) continue;
        const double allowed = least_gap(*at.layers[body]);
        for (const Vec3& vertex : wall_places(mesh, layer)) {
            const Vec3 x = meant_by(vertex, body, at);
            const Gap gap = nearest_gap(at, body, x);
            if (!narrowest || gap.distance / allowed < narrowest->distance / narrowest->allowed)
                narrowest = {body, gap.distance, allowed, x, gap.wall, gap.body};
        }
    }
    return narrowest;
}

std::optional<Stacks> stacks_on(const Surface& wall, std::size_t body, bool inside, const Snapshot& at) {
    const LayerOptions* options = layer_at_side(at, body, inside);
    if (!options) return std::nullopt;
    const Region own = region_of_body(body);
    Stacks stacks{{inside ? own : surroundings, own, options->count, wall.triangles, {}}, {}};
    if (inside)
        for (auto& triangle : stacks.layer.triangles) std::swap(triangle[1], triangle[2]);
    stacks.places = column_places(stacks.layer, wall.points, at);
    return stacks;
}

Surface shell_of(const Surface& wall, const Stacks& stacks) {
    Surface shell{{}, wall.triangles};
    const auto step = static_cast<std::size_t>(stacks.layer.count + 1);
    for (std::size_t i = step - 1; i < stacks.places.size(); i += step)
        shell.points.push_back(stacks.places[i]);
    return shell;
}

}  // namespace kropla
