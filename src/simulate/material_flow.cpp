// The potential flow around moving bodies, by linear tets and prisms, and what corrects a velocity.
//   [Batchelor 1967] An introduction to fluid dynamics, 2.7 and 6.4: the irrotational flow that a moving
//     boundary sets up has the least kinetic energy of all that satisfy continuity.
#include <kropla/simulate/material_flow.h>

#include "simulate/assembly.h"
#include "simulate/elements.h"
#include "simulate/solver.h"

#include <algorithm>
#include <functional>

namespace kropla {
namespace {

struct Step {
    const Mesh& before;
    const Mesh& current;
    double dt;
};

Vec3 mesh_velocity(const Step& step, Vertex v) {
    return (step.current.position[v] - step.before.position[v]) / step.dt;
}

/// Adds what the facet sweeps, shared among its vertices by the integral of phi_i w.n [m^3/s].
void add_swept(const Step& step, const std::array<Vertex, 3>& facet, Array<Vertex, double>& swept) {
    std::array<Vec3, 3> x0, x1, w;
    Vec3 sum;
    for (std::size_t k = 0; k < 3; ++k) {
        x0[k] = step.before.position[facet[k]];
        x1[k] = step.current.position[facet[k]];
        sum += w[k] = mesh_velocity(step, facet[k]);
    }
    const Vec3 area = mean_area_vector(x0, x1);
    for (std::size_t k = 0; k < 3; ++k) swept[facet[k]] += dot(area, w[k] + sum) / 12;
}

Array<Vertex, double> swept_by_boundary(const Step& step, Region region) {
    Array<Vertex, double> swept(step.current.position.size(), 0.0);
    const RegionSurface surface = region_surface(step.current, region);
    for (const auto& facet : surface.interface) add_swept(step, facet, swept);
    for (const auto& facet : surface.outer) add_swept(step, facet, swept);
    return swept;
}

/// The integrals of phi_i over the cells [m^3].
Array<Vertex, double> shares_of_volume(const Mesh& mesh, const Cells& cells) {
    Array<Vertex, double> share(mesh.position.size(), 0.0);
    for_each_share(mesh, cells, [&](const auto&, Vertex v, double volume) { share[v] += volume; });
    return share;
}

/// What passes each face of the box out of a region, at its vertices; empty where the region is not.
using FaceRates = std::array<Array<Vertex, double>, 6>;

FaceRates rates_of(const Mesh& mesh, const FaceFacets& facets, const Array<Vertex, Vec3>& velocity) {
    FaceRates rates;
    for (std::size_t face = 0; face < facets.size(); ++face) {
        if (facets[face].empty()) continue;
        rates[face].resize(mesh.position.size(), 0.0);
        for (const auto& facet : facets[face]) {
            const Vec3 area = area_vector(mesh, facet);
            const Vec3 sum = velocity[facet[0]] + velocity[facet[1]] + velocity[facet[2]];
            for (Vertex v : facet) rates[face][v] += dot(area, velocity[v] + sum) / 12;
        }
    }
    return rates;
}

/// Of each piece.
std::vector<double> sums_of(const Pieces& pieces, const Array<Vertex, double>& values) {
    std::vector<double> sum(as_size(pieces.count), 0.0);
    for (Vertex v : values.indices())
        if (pieces.of[v] >= 0) sum[as_size(pieces.of[v])] += values[v];
    return sum;
}

/// More passes faces, out of each piece the sum of what is asked for there, in proportion to the shares; not where the
/// shares of a piece sum to `least` times that or less.
void let_pass(const Pieces& pieces, const FaceRates& shares, double least, Array<Vertex, double>& asked, FaceRates& rates) {
    const std::vector<double> rest = sums_of(pieces, asked);
    std::vector<double> all(rest.size(), 0.0);
    for (const auto& of_face : shares)
        for (Vertex v : of_face.indices())
            if (of_face[v] > 0) all[as_size(pieces.of[v])] += of_face[v];
    for (std::size_t face = 0; face < shares.size(); ++face) {
        for (Vertex v : shares[face].indices()) {
            if (!(shares[face][v] > 0)) continue;
            const auto piece = as_size(pieces.of[v]);
            if (all[piece] <= least * std::abs(rest[piece])) continue;
            const double more = -rest[piece] * shares[face][v] / all[piece];
            rates[face][v] += more;
            asked[v] += more;
        }
    }
}

/// What the velocity at the step's end lets out and the mesh's motion over the step does not ask for, or the other way round,
/// passes open faces, evenly.
void let_rest_out(const Mesh& mesh, const FaceFacets& facets, const Pieces& pieces, const std::array<bool, 6>& open,
                  Array<Vertex, double>& asked, FaceRates& rates) {
    FaceRates areas;
    for (std::size_t face = 0; face < facets.size(); ++face) {
        if (!open[face] || facets[face].empty()) continue;
        areas[face].resize(mesh.position.size(), 0.0);
        rates[face].resize(mesh.position.size(), 0.0);
        for (const auto& facet : facets[face])
            for (Vertex v : facet) areas[face][v] += norm(area_vector(mesh, facet)) / 3;
    }
    let_pass(pieces, areas, 0, asked, rates);
}

/// Where a told body is round, it grows by a polygon and what is seen of it in a face is another: as much more or less passes.
void let_rest_along(const Pieces& pieces, Array<Vertex, double>& asked, FaceRates& rates) {
    constexpr double several = 5;  // of what polygons of five edges can differ by, a fifth of the area
    FaceRates sizes = rates;
    for (auto& of_face : sizes)
        for (double& rate : of_face) rate = std::abs(rate);
    let_pass(pieces, sizes, several, asked, rates);
}

/// Takes from `source` the integrals of grad phi_i . velocity over the cells.
void take_divergence(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& velocity,
                     Array<Vertex, double>& source) {
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        const auto points = cell_points(corners(mesh, cell));
        const auto at_corner = at_corners(velocity, vertices);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Vec3 mean = mean_value(k, at_corner);
            for (std::size_t i = 0; i < vertices.size(); ++i)
                source[vertices[i]] -= dot(mean, points[k].volume_gradient[i]);
        }
    });
}

/// The sum of what is asked for in each piece, which no potential has, becomes expansion, evenly by volume.
void spread(const Pieces& pieces, const Array<Vertex, double>& share, Array<Vertex, double>& asked,
            Array<Vertex, double>& expansion) {
    const std::vector<double> rest = sums_of(pieces, asked), volume = sums_of(pieces, share);
    for (Vertex v : asked.indices()) {
        if (pieces.of[v] < 0) continue;
        const double rate = rest[as_size(pieces.of[v])] / volume[as_size(pieces.of[v])];
        expansion[v] += rate;
        asked[v] -= rate * share[v];
    }
}

/// Is the volume kept, but for rounding?
bool is_rounding(const Array<Vertex, double>& expansion, const Array<Vertex, double>& share, double dt) {
    constexpr double rounding = 1e-13;  // [-] of the volume
    return std::ranges::all_of(expansion.indices(),
                               [&](Vertex v) { return share[v] == 0 || std::abs(expansion[v]) * dt < rounding; });
}

/// What a vertex's mass grows by [kg/s], less what the mesh and the velocity bring to it within the region.
Array<Vertex, double> missing_mass(const Step& step, const Cells& cells, const SolvedFlow& solved) {
    Array<Vertex, double> missing(step.current.position.size(), 0.0);
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(step.current, cell);
        constexpr std::size_t n = std::tuple_size_v<std::remove_cvref_t<decltype(vertices)>>;
        const Corners<n> x0 = corners(step.before, cell), x1 = corners(step.current, cell);
        const CellPoints<n> before = cell_points(x0), now = cell_points(x1);
        const auto gradients = mean_volume_gradients(x0, x1);
        const auto thin0 = at_corners(solved.density_before, vertices), thin1 = at_corners(solved.density, vertices);
        const double density = mean_of(thin1);
        const auto velocity = at_corners(solved.velocity, vertices);
        std::array<Vec3, n> moved;
        for (std::size_t i = 0; i < n; ++i) moved[i] = (x1[i] - x0[i]) / step.dt;
        for (std::size_t k = 0; k < now.size(); ++k) {
            const Vec3 flown = mean_value(k, velocity), mesh = mean_value(k, moved);
            for (std::size_t i = 0; i < n; ++i)
                missing[vertices[i]] +=
                    (now[k].volume * mean_product(k, i, thin1) - before[k].volume * mean_product(k, i, thin0)) / step.dt -
                    density * (dot(flown, now[k].volume_gradient[i]) - dot(mesh, gradients[k][i]));
        }
    });
    return missing;
}

/// The integrals of phi_i over the cells, of the density at their vertices [kg].
Array<Vertex, double> shares_of_mass(const Mesh& mesh, const Cells& cells, const Array<Vertex, double>& density) {
    Array<Vertex, double> share(mesh.position.size(), 0.0);
    for_each_mass(mesh, cells, density, [&](const auto&, Vertex v, double mass) { share[v] += mass; });
    return share;
}

/// The unknowns of a region, among those of all cells: the rows that this rank owns, as many of them as are of the region,
/// without the columns that are not.
struct Part {
    SparseRows rows;
    std::vector<Vertex> vertex;      // of each row of all ranks
    std::vector<std::size_t> place;  // of each entry, in the pattern's rows
};

Part part_of(const Pattern& pattern, const Pieces& pieces) {
    const SparseRows& rows = pattern.rows;
    Part part;
    part.rows.pieces = pieces.count;
    std::vector<PetscInt> row(pattern.numbering.vertex.size(), -1);
    for (std::size_t r = 0; r < row.size(); ++r) {
        if (static_cast<int>(r) == rows.first_row) part.rows.first_row = static_cast<int>(part.vertex.size());
        const Vertex v = pattern.numbering.vertex[r];
        if (pieces.of[v] < 0) continue;
        row[r] = static_cast<PetscInt>(part.vertex.size());
        part.vertex.push_back(v);
        part.rows.piece.push_back(pieces.of[v]);
    }
    for (std::size_t r = 0; r < rows.count(); ++r) {
        if (row[static_cast<std::size_t>(rows.first_row) + r] < 0) continue;
        for (auto k = static_cast<std::size_t>(rows.begin[r]); k < static_cast<std::size_t>(rows.begin[r + 1]); ++k) {
            const PetscInt column = row[static_cast<std::size_t>(rows.column[k])];
            if (column < 0) continue;
            part.rows.column.push_back(column);
            part.place.push_back(k);
        }
        part.rows.begin.push_back(static_cast<PetscInt>(part.rows.column.size()));
    }
    return part;
}

/// Adds the integrals of density grad phi_i . grad phi_j [m], or [kg/m^2], over cells of one kind, of which those of other
/// regions have no points. Without densities they are one.
template <std::size_t n>
void add_laplacian(std::size_t row, const CellsAtRows<n>& at, const std::vector<CellPoints<n>>& cells,
                   const std::vector<double>& density, double* value) {
    for (const CellAtRow<n>& cell : at.of(row)) {
        for (const CellPoint<n>& point : cells[cell.cell]) {
            if (point.volume == 0) continue;
            const double weight = (density.empty() ? 1 : density[cell.cell]) / point.volume;
            const Vec3 mine = weight * point.volume_gradient[cell.corner];
            for (std::size_t j = 0; j < n; ++j) value[cell.place[j]] += dot(mine, point.volume_gradient[j]);
        }
    }
}

/// Per cell; of other regions than the one that is asked for, zeros.
template <std::size_t n, class Name>
std::vector<CellPoints<n>> points_of(const Mesh& mesh, const std::vector<Name>& cells, Region region) {
    std::vector<CellPoints<n>> points(cells.size());
    for_all(cells.size(), [&](std::size_t c) {
        if (cell_region(mesh, cells[c]) == region) points[c] = cell_points(corners(mesh, cells[c]));
    });
    return points;
}

/// Of cells, the mean of their vertices; empty if there are none.
template <class Name>
std::vector<double> densities_of(const Mesh& mesh, const std::vector<Name>& cells, const Array<Vertex, double>& density) {
    std::vector<double> means(density.empty() ? 0 : cells.size());
    for_all(means.size(), [&](std::size_t c) { means[c] = mean_of(at_corners(density, cell_vertices(mesh, cells[c]))); });
    return means;
}

/// A place for each coupling of the pattern. An empty density is one.
std::vector<double> laplacian(const Mesh& mesh, const Pattern& pattern, Region region, const Array<Vertex, double>& density,
                              const Watch* watch) {
    heed(watch);
    const auto tets = points_of<4>(mesh, pattern.cells.tets, region);
    const auto prisms = points_of<6>(mesh, pattern.cells.prisms, region);
    const auto of_tets = densities_of(mesh, pattern.cells.tets, density);
    const auto of_prisms = densities_of(mesh, pattern.cells.prisms, density);
    heed(watch);
    std::vector<double> value(pattern.rows.column.size(), 0.0);
    for_all(pattern.rows.count(), [&](std::size_t row) {
        double* const of_row = value.data() + pattern.rows.begin[row];
        add_laplacian(row, pattern.tets, tets, of_tets, of_row);
        add_laplacian(row, pattern.prisms, prisms, of_prisms, of_row);
    });
    return value;
}

/// A residual is gas lost or gained. Of no weight is what would fill the vertex's share of the volume in a
/// step: the tolerance then is the relative change of a constant state.
LinearSystem potential_system(const Part& part, const std::vector<double>& laplacian, const Array<Vertex, double>& swept,
                              const Array<Vertex, double>& share, double dt) {
    LinearSystem system(part.rows);
    for (std::size_t k = 0; k < part.place.size(); ++k) system.value[k] = laplacian[part.place[k]];
    for (std::size_t r = 0; r < system.right.size(); ++r) {
        const Vertex v = part.vertex[static_cast<std::size_t>(part.rows.first_row) + r];
        system.right[r] = swept[v];
        system.negligible[r] = share[v] / dt;
    }
    return system;
}

Array<Vertex, double> at_vertices(const Mesh& mesh, const Part& part, const std::vector<double>& value) {
    Array<Vertex, double> at(mesh.position.size(), 0.0);
    for (std::size_t r = 0; r < value.size(); ++r) at[part.vertex[r]] = value[r];
    return at;
}

/// The region of a flow by itself.
class FlowOfRegion {
public:
    FlowOfRegion(const Step& step, Region region, const SolvedFlow& solved, const ToldFlow* told, MaterialFlow& flow)
        : step_(step), region_(region), cells_(living_cells(step.current, region)), by_mass_(region == flow.by_mass),
          told_(told), flow_(flow) {
        if (by_mass_) ask_for_mass(solved);
        else ask_for_volume(solved);
        for (const auto& of_face : rates_)
            for (Vertex v : of_face.indices()) asked_[v] += of_face[v];
    }

    /// Is anything asked for?
    [[nodiscard]] bool moves() const {
        return (told_ != nullptr && !told_->expansion.empty()) || std::ranges::any_of(asked_, [](double a) { return a != 0; });
    }

    void solve(const Ranks& ranks, const std::array<bool, 6>& open) {
        const Mesh& mesh = step_.current;
        const Pieces pieces = pieces_of(mesh, cells_);
        const Array<Vertex, double> share =
            by_mass_ ? shares_of_mass(mesh, cells_, flow_.density) : shares_of_volume(mesh, cells_);
        Array<Vertex, double> expansion(share.size(), 0.0);
        if (told_ != nullptr && !told_->expansion.empty()) expansion = told_->expansion;
        for (Vertex v : asked_.indices()) asked_[v] -= expansion[v] * share[v];
        if (told_ != nullptr) let_rest_along(pieces, asked_, rates_);
        else if (!by_mass_ && std::ranges::any_of(open, std::identity()))
            let_rest_out(mesh, facets_of_faces(mesh, cells_), pieces, open, asked_, rates_);
        spread(pieces, share, asked_, expansion);
        if (!is_rounding(expansion, share, step_.dt)) flow_.expansion[region_] = std::move(expansion);
        note_through();
        solve_potential(ranks, pieces, share);
    }

private:
    void ask_for_mass(const SolvedFlow& solved) {
        asked_ = missing_mass(step_, cells_, solved);
        for (auto& of_face : rates_) of_face.resize(asked_.size(), 0.0);
        for (const FaceMass& part : solved.through) rates_[part.face][part.vertex] += part.rate;
    }
    void ask_for_volume(const SolvedFlow& solved) {
        asked_ = swept_by_boundary(step_, region_);
        const Array<Vertex, Vec3>& velocity = told_ != nullptr ? told_->velocity : solved.velocity;
        if (velocity.empty()) return;
        rates_ = rates_of(step_.current, facets_of_faces(step_.current, cells_), velocity);
        take_divergence(step_.current, cells_, velocity, asked_);
    }

    void note_through() {
        for (std::size_t face = 0; face < rates_.size(); ++face)
            for (Vertex v : rates_[face].indices())
                if (rates_[face][v] != 0) flow_.through.push_back({v, region_, face, rates_[face][v]});
    }

    void solve_potential(const Ranks& ranks, const Pieces& pieces, const Array<Vertex, double>& share) {
        const Mesh& mesh = step_.current;
        if (!flow_.pattern) flow_.pattern = std::make_shared<Pattern>(make_pattern(mesh, living_cells(mesh), ranks));
        const Part part = part_of(*flow_.pattern, pieces);
        const std::vector<double> matrix =
            laplacian(mesh, *flow_.pattern, region_, by_mass_ ? flow_.density : Array<Vertex, double>{}, ranks.watch);
        const LinearSystem system = potential_system(part, matrix, asked_, share, step_.dt);
        const Solution potential = kropla::solve(ranks, system,
                                                 {.name = "potential flow",
                                                  .prefix = "potential_",
                                                  .preconditioner = Preconditioner::multigrid,
                                                  .tolerance = 2e-13,
                                                  .potential = true});
        flow_.potential[region_] = at_vertices(mesh, part, potential.value);
        flow_.iterations += potential.iterations;
    }

    const Step& step_;
    Region region_;
    Cells cells_;
    bool by_mass_;  // what is conserved
    const ToldFlow* told_;  // or nothing
    MaterialFlow& flow_;
    Array<Vertex, double> asked_;  // of the potential, at each vertex
    FaceRates rates_;
};

}  // namespace

MaterialFlow material_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                           const std::vector<Region>& flowing, double dt, const SolvedFlow& solved,
                           const std::vector<ToldFlow>& told) {
    const std::size_t regions = count_regions(current);
    MaterialFlow flow{.potential = Array<Region, Array<Vertex, double>>(regions),
                      .velocity = solved.velocity,
                      .told = Array<Region, Array<Vertex, Vec3>>(regions),
                      .expansion = Array<Region, Array<Vertex, double>>(regions)};
    if (!solved.density.empty()) {
        flow.by_mass = flowing.front();
        flow.density_before = solved.density_before;
        flow.density = solved.density;
    }
    const Step step{before, current, dt};
    for (Region region : flowing) {
        if (as_size(region.value) >= regions) continue;  // it has no cells any more
        const auto of = std::ranges::find(told, region, &ToldFlow::region);
        if (of != told.end()) flow.told[region] = of->velocity;
        FlowOfRegion part(step, region, solved, of != told.end() ? &*of : nullptr, flow);
        if (part.moves()) part.solve(ranks, solved.open);
    }
    return flow;
}

}  // namespace kropla
