// The potential flow around moving bodies, by linear tets and prisms, and what corrects a velocity.
//   [Batchelor 1967] An introduction to fluid dynamics, 2.7 and 6.4: the irrotational flow that a moving
//     boundary sets up has the least kinetic energy of all that satisfy continuity.
#include <kropla/simulate/material_flow.h>

#include "simulate/assembly.h"
#include "simulate/elements.h"
#include "simulate/solver.h"

#include <algorithm>

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

/// Lists what passes the faces of the box, from a region.
void add_through(const Mesh& mesh, Region region, const Cells& cells, const Array<Vertex, Vec3>& velocity,
                 MaterialFlow& flow) {
    const FaceFacets facets = facets_of_faces(mesh, cells);
    for (std::size_t face = 0; face < facets.size(); ++face) {
        Array<Vertex, double> rate(mesh.position.size(), 0.0);
        for (const auto& facet : facets[face]) {
            const Vec3 area = area_vector(mesh, facet);
            const Vec3 sum = velocity[facet[0]] + velocity[facet[1]] + velocity[facet[2]];
            for (Vertex v : facet) rate[v] += dot(area, velocity[v] + sum) / 12;
        }
        for (Vertex v : rate.indices())
            if (rate[v] != 0) flow.through.push_back({v, region, face, rate[v]});
    }
}

/// Of each piece.
std::vector<double> sums_of(const Pieces& pieces, const Array<Vertex, double>& values) {
    std::vector<double> sum(as_size(pieces.count), 0.0);
    for (Vertex v : values.indices())
        if (pieces.of[v] >= 0) sum[as_size(pieces.of[v])] += values[v];
    return sum;
}

/// Takes the sum over each piece out of the source by what passes the open faces that it meets, evenly.
void let_rest_out(const Mesh& mesh, Region region, const Cells& cells, const Pieces& pieces, const std::array<bool, 6>& open,
                  Array<Vertex, double>& source, MaterialFlow& flow) {
    const FaceFacets facets = facets_of_faces(mesh, cells);
    const std::vector<double> rest = sums_of(pieces, source);
    std::vector<double> area(rest.size(), 0.0);
    const auto for_each_corner = [&](const auto& visit) {
        for (std::size_t face = 0; face < facets.size(); ++face)
            for (const auto& facet : facets[face])
                for (Vertex v : facet)
                    if (open[face]) visit(v, as_size(pieces.of[v]), face, norm(area_vector(mesh, facet)) / 3);
    };
    for_each_corner([&](Vertex, std::size_t piece, std::size_t, double share) { area[piece] += share; });
    for_each_corner([&](Vertex v, std::size_t piece, std::size_t face, double share) {
        const double rate = -rest[piece] * share / area[piece];
        flow.through.push_back({v, region, face, rate});
        source[v] += rate;
    });
}

/// The same of a region that is told, by more or less of what passes faces anyway, if that is more than the sum: where the body
/// is round, its volume and what is seen of it in a face are polygons of their own.
void let_rest_along(Region region, const Pieces& pieces, Array<Vertex, double>& source, MaterialFlow& flow) {
    const std::vector<double> rest = sums_of(pieces, source);
    std::vector<double> passes(rest.size(), 0.0);
    for (const MaterialFlow::Through& part : flow.through)
        if (part.region == region) passes[as_size(pieces.of[part.vertex])] += std::abs(part.rate);
    for (MaterialFlow::Through& part : flow.through) {
        if (part.region != region) continue;
        const auto piece = as_size(pieces.of[part.vertex]);
        if (std::abs(rest[piece]) >= passes[piece]) continue;
        const double more = -rest[piece] * std::abs(part.rate) / passes[piece];
        part.rate += more;
        source[part.vertex] += more;
    }
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

/// Takes the sum over each piece out of `swept`, from each vertex after its share of the volume: else there is no solution.
/// Returns what was taken per share.
Array<Vertex, double> balance(const Pieces& pieces, const Array<Vertex, double>& share, Array<Vertex, double>& swept) {
    const std::vector<double> rest = sums_of(pieces, swept), volume = sums_of(pieces, share);
    Array<Vertex, double> taken(swept.size(), 0.0);
    for (Vertex v : swept.indices()) {
        if (pieces.of[v] < 0) continue;
        taken[v] = rest[as_size(pieces.of[v])] / volume[as_size(pieces.of[v])];
        swept[v] -= taken[v] * share[v];
    }
    return taken;
}

/// Is the volume kept, but for rounding?
bool is_rounding(const Array<Vertex, double>& expansion, const Array<Vertex, double>& share, double dt) {
    constexpr double rounding = 1e-13;  // [-] of the volume
    return std::ranges::all_of(expansion.indices(), [&](Vertex v) { return share[v] == 0 || std::abs(expansion[v]) * dt < rounding; });
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

/// What the mesh asks for at each vertex of a region, and what passes faces there, less what the velocity has of it. Lists what
/// passes faces.
Array<Vertex, double> asked_for(const Step& step, Region region, const Cells& cells, const SolvedFlow& solved, MaterialFlow& flow) {
    Array<Vertex, double> source;
    const std::size_t known = flow.through.size();
    if (region == flow.by_mass) {
        source = missing_mass(step, cells, solved);
        for (const FaceMass& part : solved.through) flow.through.push_back({part.vertex, region, part.face, part.rate});
    } else {
        source = swept_by_boundary(step, region);
        if (const Array<Vertex, Vec3>& velocity = flow.velocity_in(region); !velocity.empty()) {
            add_through(step.current, region, cells, velocity, flow);
            take_divergence(step.current, cells, velocity, source);
        }
    }
    for (std::size_t k = known; k < flow.through.size(); ++k) source[flow.through[k].vertex] += flow.through[k].rate;
    return source;
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

}  // namespace

MaterialFlow material_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                           const std::vector<Region>& flowing, double dt, const SolvedFlow& solved,
                           const std::vector<ToldFlow>& told) {
    const std::size_t regions = count_regions(current);
    MaterialFlow flow{Array<Region, Array<Vertex, double>>(regions), solved.velocity, Array<Region, Array<Vertex, Vec3>>(regions),
                      Array<Region, Array<Vertex, double>>(regions)};
    Array<Region, const ToldFlow*> said(regions, nullptr);
    for (const ToldFlow& of : told) {
        said[of.region] = &of;
        flow.told[of.region] = of.velocity;
    }
    const Step step{before, current, dt};
    const SolverChoice choice{.name = "potential flow",
                              .prefix = "potential_",
                              .preconditioner = Preconditioner::multigrid,
                              .tolerance = 2e-13,
                              .potential = true};
    if (!solved.density.empty()) {
        flow.by_mass = flowing.front();
        flow.density_before = solved.density_before;
        flow.density = solved.density;
    }
    for (Region region : flowing) {
        const Cells cells = living_cells(current, region);
        Array<Vertex, double> source = asked_for(step, region, cells, solved, flow);
        const bool expands = said[region] && !said[region]->expansion.empty();
        if (!expands && std::ranges::all_of(source, [](double s) { return s == 0; })) continue;
        const Pieces pieces = pieces_of(current, cells);
        const Array<Vertex, double> share = region == flow.by_mass ? shares_of_mass(current, cells, flow.density)
                                                                   : shares_of_volume(current, cells);
        const Array<Vertex, double> of_told = expands ? said[region]->expansion : Array<Vertex, double>(share.size(), 0.0);
        for (Vertex v : source.indices()) source[v] -= of_told[v] * share[v];
        if (said[region]) let_rest_along(region, pieces, source, flow);
        else if (region != flow.by_mass) let_rest_out(current, region, cells, pieces, solved.open, source, flow);
        Array<Vertex, double> expansion = balance(pieces, share, source);
        for (Vertex v : expansion.indices()) expansion[v] += of_told[v];
        if (!is_rounding(expansion, share, dt)) flow.expansion[region] = std::move(expansion);
        if (!flow.pattern) flow.pattern = std::make_shared<Pattern>(make_pattern(current, living_cells(current), ranks));
        const Part part = part_of(*flow.pattern, pieces);
        const std::vector<double> matrix =
            laplacian(current, *flow.pattern, region, region == flow.by_mass ? flow.density : Array<Vertex, double>{}, ranks.watch);
        const LinearSystem system = potential_system(part, matrix, source, share, dt);
        const Solution potential = solve(ranks, system, choice);
        flow.potential[region] = at_vertices(current, part, potential.value);
        flow.iterations += potential.iterations;
    }
    return flow;
}

}  // namespace kropla
