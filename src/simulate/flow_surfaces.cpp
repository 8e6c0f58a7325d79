#include "simulate/flow_surfaces.h"

#include <algorithm>

namespace kropla {
namespace {

/// Of a column in an owned row.
std::size_t place_in(const SparseRows& rows, std::size_t row, PetscInt column) {
    const auto begin = rows.column.begin() + rows.begin[row], end = rows.column.begin() + rows.begin[row + 1];
    return static_cast<std::size_t>(std::lower_bound(begin, end, column) - rows.column.begin());
}

}  // namespace

void FlowSurfaces::begin(const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& mesh_velocity, double by_mesh) {
    tensions_.clear();
    gone_.resize(liquids_.size());
    behind_.resize(liquids_.size());
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const std::vector<Vertex>& vertices = liquids_[s].vertices;
        tensions_.push_back(surface_tension(liquids_[s], position));
        gone_[s].resize(vertices.size());
        behind_[s] = gone_[s];
        for (std::size_t i = 0; i < vertices.size() && !mesh_velocity.empty(); ++i)
            behind_[s][i] -= by_mesh * mesh_velocity[vertices[i]];
    }
}

void FlowSurfaces::add(const Array<Vertex, Vec3>& velocity, double time, bool derivative, BlockSystem& system) const {
    const SparseRows& rows = pattern_.rows;
    const auto row_of = [&](Vertex v) { return static_cast<std::size_t>(pattern_.numbering.row[v] - rows.first_row); };
    for (std::size_t s = 0; s < liquids_.size(); ++s) {
        const std::vector<Vertex>& vertices = liquids_[s].vertices;
        const SurfaceTension& acts = tensions_[s];
        const auto add_pull = [&](std::size_t i, const Vec3& pull) {
            const std::size_t row = row_of(vertices[i]);  // huge if before the first
            for (int m = 0; m < 3 && row < rows.count(); ++m)
                system.residual[block_size * row + static_cast<std::size_t>(m)] -= pull[m];
        };
        for (std::size_t i = 0; i < vertices.size(); ++i) add_pull(i, acts.force[i]);
        for (const auto& [i, j, stiffness] : acts.bonds) {
            const Vec3 further = behind_[s][j] + time * velocity[vertices[j]];
            add_pull(i, -stiffness * dot(acts.normal[j], further) * acts.normal[i]);
            if (!derivative || row_of(vertices[i]) >= rows.count()) continue;
            double* const block = system.block(place_in(rows, row_of(vertices[i]), pattern_.numbering.row[vertices[j]]));
            for (int c = 0; c < 3; ++c)
                for (int m = 0; m < 3; ++m)
                    block[block_size * static_cast<std::size_t>(c) + static_cast<std::size_t>(m)] +=
                        time * stiffness * acts.normal[i][m] * acts.normal[j][c];
        }
    }
}

void FlowSurfaces::end(const Array<Vertex, Vec3>& velocity, double time) {
    for (std::size_t s = 0; s < liquids_.size(); ++s)
        for (std::size_t i = 0; i < gone_[s].size(); ++i) gone_[s][i] += time * velocity[liquids_[s].vertices[i]];
}

std::vector<SurfaceCourse> FlowSurfaces::courses() const {
    std::vector<SurfaceCourse> courses;
    for (std::size_t s = 0; s < liquids_.size(); ++s)
        courses.push_back({liquids_[s].body, liquids_[s].facets, liquids_[s].vertices, gone_[s], tensions_[s].area,
                           liquids_[s].free});
    return courses;
}

double FlowSurfaces::energy() const {
    double sum = 0;
    for (const SurfaceTension& acts : tensions_) sum += acts.energy;
    return sum;
}

}  // namespace kropla
