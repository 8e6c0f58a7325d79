// What a step does to the surfaces of bodies: of those that deform, and of those in gaps.

#include "adapt/adapt_surface.h"
#include "adapt/constants.h"
#include "adapt/mesh_step.h"
#include "base/for_all.h"
#include <kropla/mesh/quality.h>

#include <algorithm>

namespace kropla {
namespace {

/// The target sizes at these vertices.
void find_sizes(std::span<const Vertex> vertices, const Snapshot& at_time, const Mesh& mesh, Array<Vertex, double>& size) {
    if (size.size() < mesh.position.size()) size.resize(mesh.position.size(), 1);
    for_all(vertices.size(), [&](std::size_t i) { size[vertices[i]] = target_size(at_time, mesh.position[vertices[i]]); });
}

SurfaceOf surface_of(std::size_t number, const Body& body) {
    return {region_of_body(number), body.pinned, body.sharp};
}

}  // namespace

void MeshStep::find_deforming() {
    bodies_.deforming = deforming_surfaces(domain_, reference_);
    for (const BodySurface& surface : bodies_.deforming) {
        std::vector<Vertex>& vertices = bodies_.vertices[surface.body];
        vertices = surface.vertices;
        for (const PrismLayer& layer : reference_.layers)
            if (layer.body == region_of_body(surface.body))
                vertices.insert(vertices.end(), layer.columns.begin(), layer.columns.end());
        std::ranges::sort(vertices);
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        domain_.bodies[surface.body].shape = shape_of(surface, reference_.position, domain_.box);
    }
}

/// The triangles of a body are uneven as long as some are clearly smaller than those of the initial mesh would be.
void MeshStep::find_uneven() {
    constexpr double clearly = 0.5;
    is_uneven_.assign(domain_.bodies.size(), 0);
    std::vector<std::size_t> rigid;
    for (std::size_t body = 0; body < domain_.bodies.size(); ++body)
        if (const Body& of = domain_.bodies[body]; !of.deformation && !of.layer && !of.shape.surface) rigid.push_back(body);
    const Snapshot at = snapshot_at(time_);
    for (const BodySurface& surface : body_surfaces(reference_, rigid)) {
        const double short_edge = clearly * surface_size(at, surface.body);
        for (const auto& [a, b, c] : surface.triangles)
            if (distance(reference_.position[a], reference_.position[b]) < short_edge) is_uneven_[surface.body] = 1;
    }
    bodies_.uneven = std::ranges::find(is_uneven_, char{1}) != is_uneven_.end();
}

std::vector<BodySurface> MeshStep::surfaces_to_adapt(const Snapshot& at_time) {
    std::vector<std::size_t> bodies;
    const std::vector<char> in_gaps = at_time.narrow ? are_in_gaps(at_time) : std::vector<char>(domain_.bodies.size(), 0);
    for (std::size_t body = 0; body < domain_.bodies.size(); ++body) {
        const Body& of = domain_.bodies[body];
        const bool uneven = is_uneven_[body] != 0 || in_gaps[body] != 0 || has_local_size(at_time, body);
        if (!of.layer && (of.deformation || uneven)) bodies.push_back(body);
    }
    auto surfaces = body_surfaces(current_, bodies);
    std::erase_if(surfaces, [&](const BodySurface& surface) {
        if (domain_.bodies[surface.body].deformation) return false;
        find_sizes(surface.vertices, at_time, current_, motion_.size);
        return !has_wrong_size(current_, surface, motion_.size, options_);
    });
    return surfaces;
}

/// The surfaces that are to be adapted, and the sizes of the cells at what is new there.
void MeshStep::adapt_surfaces(const Snapshot& at_time, const AdaptOptions& options, Changes& changes) {
    if (adapted_.empty()) return;
    Changes of_surfaces;
    for (const BodySurface& surface : adapted_) {
        const Body& body = domain_.bodies[surface.body];
        of_surfaces += adapt_surface(current_, surface_of(surface.body, body), surface.triangles, motion_.size,
                                     bool(body.deformation), options);
    }
    auto cells = cells_at(current_, of_surfaces.vertices);
    cells.insert(cells.end(), of_surfaces.cells.begin(), of_surfaces.cells.end());
    of_surfaces += adapt_to_size(current_, cells, at_time, options);
    of_surfaces.cells.insert(of_surfaces.cells.end(), cells.begin(), cells.end());
    changes += of_surfaces;
}

/// What is bad at them still.
void MeshStep::improve_surfaces(std::vector<Tet> cells, const Snapshot& at_time, const AdaptOptions& options,
                                Changes& changes) {
    if (adapted_.empty()) return;
    for (int round = 0; round < most_rounds; ++round) {
        cells.insert(cells.end(), changes.cells.begin(), changes.cells.end());
        std::erase_if(cells, [&](Tet t) { return !alive(current_, t) || aspect_ratio(current_, t) <= options.good_enough; });
        std::ranges::sort(cells);
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        if (cells.empty()) return;
        Changes more;
        for (const BodySurface& surface : adapted_) {
            const Body& of = domain_.bodies[surface.body];
            AdaptOptions of_surface = options;
            if (of.keeps_volume) of_surface.good_enough *= poor_at_liquids;
            more += improve_surface(current_, surface_of(surface.body, of), cells, of_surface);
        }
        if (more.vertices.empty()) return;
        const auto at_moved = cells_at(current_, more.vertices);
        more.cells.insert(more.cells.end(), at_moved.begin(), at_moved.end());
        more += improve(current_, more.cells, at_time, options, more.cells);
        changes += more;
    }
}

}  // namespace kropla
