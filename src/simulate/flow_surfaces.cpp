#include "simulate/flow_surfaces.h"

#include <algorithm>

namespace kropla {
namespace {

/// Of a column in an owned row.
std::size_t place_in(const SparseRows& rows, std::size_t row, PetscInt column) {
    const auto begin = rows.column.begin() + rows.begin[row], end = rows.column.begin() + rows.begin[row + 1];
    return static_cast<std::size_t>(std::lower_bound(begin, end, column) - rows.column.begin());
}

/// Huge if before the first one that is owned.
std::size_t owned_row(const Pattern& pattern, Vertex v) {
    return static_cast<std::size_t>(pattern.numbering.row[v] - pattern.rows.first_row);
}

/// The mean over a facet of phi_i phi_j phi_k.
constexpr double mean_of_shapes(std::size_t i, std::size_t j, std::size_t k) {
    const int alike = (i == j) + (j == k) + (k == i);
    return (alike == 0 ? 1 : alike == 1 ? 2 : 6) / 60.0;
}

}  // namespace

void FlowSurfaces::begin(const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& mesh_velocity, double by_mesh) {
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const std::vector<Vertex>& vertices = liquids_[s].vertices;
        State& state = state_[s];
        state.tension = surface_tension(liquids_[s], position);
        state.gone.resize(vertices.size());
        state.mesh.resize(vertices.size());
        for (std::size_t i = 0; i < vertices.size() && !mesh_velocity.empty(); ++i) state.mesh[i] = mesh_velocity[vertices[i]];
        state.behind = state.gone;
        for (std::size_t i = 0; i < vertices.size(); ++i) state.behind[i] -= by_mesh * state.mesh[i];
        state.areas.clear();
        for (const auto& [a, b, c] : liquids_[s].facets)
            state.areas.push_back(0.5 * cross(position[b] - position[a], position[c] - position[a]));
    }
}

void FlowSurfaces::add_force(Vertex v, const Vec3& force, BlockSystem& system) const {
    const std::size_t row = owned_row(pattern_, v);
    for (int m = 0; m < 3 && row < pattern_.rows.count(); ++m)
        system.residual[block_size * row + static_cast<std::size_t>(m)] -= force[m];
}

double* FlowSurfaces::block_of(Vertex row, Vertex column, BlockSystem& system) const {
    const std::size_t owned = owned_row(pattern_, row);
    if (owned >= pattern_.rows.count()) return nullptr;
    return system.block(place_in(pattern_.rows, owned, pattern_.numbering.row[column]));
}

void FlowSurfaces::add(const Array<Vertex, Vec3>& velocity, double time, bool derivative, BlockSystem& system) const {
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const std::vector<Vertex>& vertices = liquids_[s].vertices;
        const SurfaceTension& acts = state_[s].tension;
        for (std::size_t i = 0; i < vertices.size(); ++i) add_force(vertices[i], acts.force[i], system);
        for (const auto& [i, j, stiffness] : acts.bonds) {
            const Vec3 further = state_[s].behind[j] + time * velocity[vertices[j]];
            add_force(vertices[i], -stiffness * dot(acts.normal[j], further) * acts.normal[i], system);
            double* const block = derivative ? block_of(vertices[i], vertices[j], system) : nullptr;
            for (int c = 0; c < 3 && block != nullptr; ++c)
                for (int m = 0; m < 3; ++m)
                    block[block_size * static_cast<std::size_t>(c) + static_cast<std::size_t>(m)] +=
                        time * stiffness * acts.normal[i][m] * acts.normal[j][c];
        }
    }
}

/// Calls `visit(facet)` for each: what passes it. Velocities are less the surface's mean, so that all is the same in any frame:
/// in all nothing passes.
template <class Visit>
void FlowSurfaces::for_each_passing(const Array<Vertex, Vec3>& velocity, const Visit& visit) const {
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const LiquidSurface& liquid = liquids_[s];
        Vec3 mean;
        for (Vertex v : liquid.vertices) mean += velocity[v] / static_cast<double>(liquid.vertices.size());
        for (std::size_t f = 0; f < liquid.facets.size(); ++f) {
            PassedFacet of{liquid.facets[f], liquid.denser * state_[s].areas[f], {}, {}};
            for (std::size_t i = 0; i < 3; ++i) {
                const Vertex v = of.vertices[i];
                of.velocity[i] = velocity[v] - mean;
                of.flux[i] = dot(velocity[v] - state_[s].mesh[place_of(liquid.vertices, v)], of.area);
            }
            visit(of);
        }
    }
}

void FlowSurfaces::add_passing(const Array<Vertex, Vec3>& velocity, bool derivative, BlockSystem& system) const {
    for_each_passing(velocity, [&](const PassedFacet& of) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                Vec3 carried;  // the means of phi_i phi_j u and of phi_i phi_j times what passes
                double flux = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    carried += mean_of_shapes(i, j, k) * of.velocity[k];
                    flux += mean_of_shapes(i, j, k) * of.flux[k];
                }
                add_force(of.vertices[i], flux * of.velocity[j], system);
                if (double* const block = derivative ? block_of(of.vertices[i], of.vertices[j], system) : nullptr)
                    for (int c = 0; c < 3; ++c)
                        for (int m = 0; m < 3; ++m)
                            block[block_size * static_cast<std::size_t>(c) + static_cast<std::size_t>(m)] -=
                                carried[m] * of.area[c] + (m == c ? flux : 0);
            }
    });
}

Vec3 FlowSurfaces::passing(const Array<Vertex, Vec3>& velocity) const {
    Vec3 sum;
    for_each_passing(velocity, [&](const PassedFacet& of) {
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) sum += (j == k ? 2 : 1) / 12.0 * of.flux[k] * of.velocity[j];
    });
    return sum;
}

void FlowSurfaces::end(const Array<Vertex, Vec3>& velocity, double time) {
    for (std::size_t s = 0; s < liquids_.size(); ++s)
        for (std::size_t i = 0; i < state_[s].gone.size(); ++i) state_[s].gone[i] += time * velocity[liquids_[s].vertices[i]];
}

std::vector<SurfaceCourse> FlowSurfaces::courses() const {
    std::vector<SurfaceCourse> courses;
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const LiquidSurface& liquid = liquids_[s];
        courses.push_back({liquid.body, liquid.facets, liquid.vertices, state_[s].gone, state_[s].tension.area, liquid.free});
    }
    return courses;
}

double FlowSurfaces::energy() const {
    double sum = 0;
    for (const State& state : state_) sum += state.tension.energy;
    return sum;
}

}  // namespace kropla
