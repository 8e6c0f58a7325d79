// Local remeshing (paper 1.3): cut a cluster out, keep its boundary, fill it with new points, triangulate,
// unite. The paper keeps the vertices next to the cluster; here its boundary facets are kept, so that uniting
// is exact, and where the Delaunay triangulation of the cluster's points lacks one of them, the cluster grows
// across it: remeshing spreads only where it must. The repair ladder climbs from there ring by ring.

#include "adapt/budget.h"
#include "adapt/constants.h"
#include "adapt/propose.h"
#include "base/random.h"
#include <kropla/generate/generate.h>
#include "generate/sampling.h"
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

namespace kropla {
namespace {

constexpr Patch frozen{box_faces};           // the cluster's boundary, while it is a mesh of its own

/// A set of tets with quick membership, in a fixed order.
struct Cluster {
    std::vector<Tet> cells;
    IndexSet<Tet> has;

    explicit Cluster(std::span<const Tet> tets) {
        for (Tet t : tets) add(t);
    }
    void add(Tet t) {
        if (has.insert(t)) cells.push_back(t);
    }
    [[nodiscard]] bool contains(Tet t) const { return has.contains(t); }
};

/// The cluster as a problem of its own, by numbers of its own for the vertices of its boundary.
struct Hole {
    std::vector<Vertex> vertices;                   // of the boundary, by number
    std::vector<std::array<int, 3>> facets;         // all of the boundary, counter-clockwise from outside
    std::vector<Facet> facets_in_mesh;
    std::vector<char> stays;                        // per facet; those on faces of the box may be exchanged
    std::vector<Vec3> points;                       // of the vertices, then new ones
    std::set<std::pair<Patch, double>> planes;      // in which the others lie: patch, and place along its axis [m]
};

Hole boundary_of(const Mesh& mesh, const Cluster& cluster) {
    Hole hole;
    std::unordered_map<std::int32_t, int> number;
    for (Tet t : cluster.cells)
        for (int i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[t][as_size(i)];
            if (n.exists() && cluster.contains(n)) continue;
            std::array<int, 3> facet{};
            const auto corners = facet_vertices(mesh, {t, i});
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [known, is_new] = number.emplace(corners[k].value, static_cast<int>(hole.vertices.size()));
                if (is_new) {
                    hole.vertices.push_back(corners[k]);
                    hole.points.push_back(mesh.position[corners[k]]);
                }
                facet[k] = known->second;
            }
            hole.facets.push_back(facet);
            hole.facets_in_mesh.push_back({t, i});
            const Patch patch = n.exists() ? Patch{} : mesh.patch[t][as_size(i)];
            hole.stays.push_back(n.exists() || patch.value >= box_faces);
            if (hole.stays.back() == 0) hole.planes.insert({patch, mesh.position[corners[0]][patch.value / 2]});
        }
    return hole;
}

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = cross(b - a, c - a);
    const auto inside = [&](const Vec3& p, const Vec3& q) { return dot(cross(q - p, x - p), normal) >= 0; };
    if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(dot(x - a, normal)) / norm(normal);
    const auto to_segment = [&](const Vec3& p, const Vec3& q) {
        const double s = std::clamp(dot(x - p, q - p) / squared_norm(q - p), 0.0, 1.0);
        return distance(x, p + s * (q - p));
    };
    return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

/// Is a point nearer to `x` than the target spacing?
bool is_taken(const PointGrid& taken, const Vec3& x, double size) {
    return taken.any_within(x, spacing_in_sizes * size, 0, infinity);
}

/// Is a boundary facet too close to `x` for a new point?
bool is_near_boundary(const Hole& hole, const Vec3& x, double size) {
    const auto place = [&](int number) { return hole.points[as_size(number)]; };
    return std::ranges::any_of(hole.facets, [&](const std::array<int, 3>& f) {
        return distance_to_triangle(x, place(f[0]), place(f[1]), place(f[2])) < clearance_in_sizes * size;
    });
}

Vec3 random_place(const Mesh& mesh, Tet t, Random& random) {
    // Four exponential variates, normalised, are uniform barycentric coordinates.
    Vec3 sum;
    double total = 0;
    for (Vertex v : mesh.tets[t]) {
        const double w = -std::log(1 - random.uniform());
        sum += w * mesh.position[v];
        total += w;
    }
    return sum / total;
}

/// How many points of the target spacing fit into the cell; none into one that is turned over.
double fitting_points(const Mesh& mesh, Tet t, const Snapshot& at_time) {
    const double size = target_size(at_time, centroid(mesh, t));
    const double points = volume(mesh, t) / (std::pow(spacing_in_sizes * size, 3) / std::numbers::sqrt2);
    return points > 0 ? points : 0;
}

/// Returns false if the budget is spent.
bool fill_with_points(const Mesh& mesh, const Cluster& cluster, const Snapshot& at_time, Random& random, Hole& hole,
                      Budget& budget, const Watch* watch) {
    PointGrid taken;
    for (const Vec3& p : hole.points) taken.insert(p, target_size(at_time, p));
    for (Tet t : cluster.cells) {
        if (aspect_ratio(mesh, t) == infinity) continue;
        const int tries = 1 + static_cast<int>(std::ceil(tries_per_point * fitting_points(mesh, t, at_time)));
        for (int i = 0; i < tries; ++i) {
            heed(watch);
            const Vec3 x = random_place(mesh, t, random);
            const double here = target_size(at_time, x);
            if (is_taken(taken, x, here)) continue;
            budget.take(static_cast<double>(hole.facets.size()) / facets_like_a_cell);
            if (budget.spent()) return false;
            if (is_near_boundary(hole, x, here)) continue;
            hole.points.push_back(x);
            taken.insert(x, here);
        }
    }
    return true;
}

/// Has the cluster a boundary at places that can be triangulated, and are its cells so near to their size that few points fit?
bool can_be_filled(const Mesh& mesh, const Cluster& cluster, const Hole& hole, const Snapshot& at_time) {
    constexpr int degree = 6;  // of lengths in the predicates of triangulation, at most
    double points = 0;
    for (Tet t : cluster.cells) points += fitting_points(mesh, t, at_time);
    return points <= most_points_per_cell * static_cast<double>(cluster.cells.size()) &&
           std::ranges::all_of(hole.points, [&](const Vec3& x) {
               return std::isfinite(std::pow(distance(x, hole.points.front()), degree));
           });
}

std::array<int, 3> rotated_to_least(std::array<int, 3> f) {
    std::rotate(f.begin(), std::ranges::min_element(f), f.end());
    return f;
}

/// The Delaunay tets inside the hole; `missing` are the facets that should stay but are none of the
/// triangulation.
struct Filling {
    std::vector<std::array<Vertex, 4>> tets;
    std::vector<BoundaryFacet> on_box;  // the facets inside which the hole is bounded by the box
    std::vector<std::size_t> missing;
    bool closed = true;  // the tets inside are bounded by the facets that stay and the box
};

/// The plane patch of the mesh in which the facet lies, if it does.
Patch plane_patch(const Hole& hole, const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const auto& [patch, plane] : hole.planes) {
        const int axis = patch.value / 2;
        if (a[axis] == plane && b[axis] == plane && c[axis] == plane) return patch;
    }
    return Patch{};
}

/// The oriented facets of all tets, to be looked up by their vertices.
std::map<std::array<int, 3>, Facet> facets_by_vertices(const Triangulation& all) {
    std::map<std::array<int, 3>, Facet> seen;
    for (Tet t : all.tets.indices())
        for (int i = 0; i < 4; ++i) {
            const auto [a, b, c] = facet_vertices(all.tets[t], i);
            seen[rotated_to_least({a.value, b.value, c.value})] = {t, i};
        }
    return seen;
}

Filling fill_hole(const Hole& hole, const Watch* watch) {
    const Triangulation all = triangulate(hole.points, watch);
    const auto seen = facets_by_vertices(all);
    Filling filling;
    std::vector<char> inside(all.tets.size(), 0), barred(4 * all.tets.size(), 0);
    std::vector<Tet> reached;
    const auto reach = [&](Tet t) {
        if (std::exchange(inside[as_size(t.value)], 1) == 0) reached.push_back(t);
    };
    for (std::size_t f = 0; f < hole.facets.size(); ++f) {
        if (hole.stays[f] == 0) continue;
        const auto found = seen.find(rotated_to_least(hole.facets[f]));
        if (found == seen.end()) {
            filling.missing.push_back(f);
            continue;
        }
        barred[4 * as_size(found->second.tet.value) + as_size(found->second.corner)] = 1;
        reach(found->second.tet);
    }
    if (!filling.missing.empty()) return filling;
    if (reached.empty() && !all.tets.empty()) reach(Tet{0});  // the whole box
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const Tet t = reached[i];
        filling.tets.push_back(all.tets[t]);
        for (int corner = 0; corner < 4; ++corner) {
            if (barred[4 * as_size(t.value) + as_size(corner)] != 0) continue;
            if (const Tet n = all.neighbour[t][as_size(corner)]; n.exists()) {
                reach(n);
                continue;
            }
            const auto v = facet_vertices(all.tets[t], corner);
            const auto place = [&](std::size_t k) { return hole.points[as_size(v[k].value)]; };
            const Patch face = plane_patch(hole, place(0), place(1), place(2));
            filling.closed &= face.exists();
            filling.on_box.push_back({v, face});
        }
    }
    return filling;
}

/// Takes in the cells across the facets that were not recovered. Nothing can be taken in across the boundary
/// or an interface: then false.
bool grow_across(const Mesh& mesh, const Hole& hole, std::span<const std::size_t> missing, Cluster& cluster) {
    bool grown = false;
    for (std::size_t f : missing) {
        const Facet facet = hole.facets_in_mesh[f];
        const Tet n = mesh.neighbour[facet.tet][as_size(facet.corner)];
        if (!n.exists() || mesh.region[n] != mesh.region[facet.tet]) continue;
        cluster.add(n);
        grown = true;
    }
    return grown;
}

/// The filled hole as a mesh of its own, improved with the facets that stay frozen.
Mesh improved_filling(const Hole& hole, const Filling& filling, const Snapshot& at_time, const AdaptOptions& options,
                      Budget& budget) {
    Array<Vertex, Vec3> position;
    for (const Vec3& x : hole.points) position.push_back(x);
    Array<Tet, std::array<Vertex, 4>> tets;
    for (const auto& t : filling.tets) tets.push_back(t);
    Array<Tet, Region> region(tets.size(), surroundings);
    std::vector<BoundaryFacet> boundary = filling.on_box;
    for (std::size_t i = 0; i < hole.facets.size(); ++i) {
        const auto& f = hole.facets[i];
        if (hole.stays[i] != 0) boundary.push_back({{Vertex(f[0]), Vertex(f[1]), Vertex(f[2])}, frozen});
    }
    Mesh mesh = make_mesh(std::move(position), std::move(tets), std::move(region), boundary);
    std::vector<Tet> cells;
    for (Tet t : mesh.tets.indices()) cells.push_back(t);
    AdaptOptions within = options;
    within.clusters = false;
    within.treatments = treatments_within;
    budget.take(cells_like_a_treatment * improve(mesh, cells, at_time, within).treated);
    return mesh;
}

Cavity as_cavity(const Mesh& mesh, const Cluster& cluster, const Hole& hole, const Mesh& filled) {
    Cavity cavity;
    cavity.removed = cluster.cells;
    cavity.worst_before = worst_aspect_ratio(mesh, cluster.cells);
    Array<Vertex, Vertex> name(filled.position.size());
    for (Vertex v : filled.position.indices()) {
        if (!alive(filled, v)) continue;
        // A vertex of a face of the box that has slid on it comes as a new one: no cell outside had the old
        // one.
        const bool known = as_size(v.value) < hole.vertices.size();
        if (known && filled.position[v] == hole.points[as_size(v.value)]) {
            name[v] = hole.vertices[as_size(v.value)];
        } else {
            name[v] = inserted_vertex(cavity.inserted.size());
            cavity.inserted.push_back(filled.position[v]);
        }
    }
    for (Tet t : filled.tets.indices()) {
        if (!alive(filled, t)) continue;
        auto v = filled.tets[t];
        for (auto& corner : v) corner = name[corner];
        auto patch = filled.patch[t];
        for (Patch& p : patch)
            if (p == frozen) p = Patch{};
        cavity.added.push_back({v, mesh.region[cluster.cells.front()], patch});
        cavity.worst_after = std::max(cavity.worst_after, aspect_ratio(filled, t));
    }
    return cavity;
}

}  // namespace

std::optional<Cavity> cluster_remesh(const Mesh& mesh, std::vector<Tet> tets, const Snapshot& at_time,
                                     const AdaptOptions& options, Budget& budget) {
    Cluster cluster(tets);
    Random random{options.seed};
    for (int growth = 0; growth < most_growths; ++growth) {
        heed(options.watch);
        budget.take(static_cast<double>(cluster.cells.size()));
        if (budget.spent()) return std::nullopt;
        Hole hole = boundary_of(mesh, cluster);
        if (!can_be_filled(mesh, cluster, hole, at_time)) return std::nullopt;
        if (!fill_with_points(mesh, cluster, at_time, random, hole, budget, options.watch)) return std::nullopt;
        const Filling filling = fill_hole(hole, options.watch);
        if (!filling.missing.empty()) {
            if (!grow_across(mesh, hole, filling.missing, cluster)) return std::nullopt;
            continue;
        }
        if (!filling.closed) return std::nullopt;
        const Mesh filled = improved_filling(hole, filling, at_time, options, budget);
        Cavity cavity = as_cavity(mesh, cluster, hole, filled);
        if (cavity.worst_after < (1 - least_gain) * cavity.worst_before) return cavity;
        return std::nullopt;
    }
    return std::nullopt;
}

std::optional<Cavity> cluster_remesh(const Mesh& mesh, std::vector<Tet> tets, const Snapshot& at_time,
                                     const AdaptOptions& options) {
    Budget budget(cells_to_cut_out(tets.size(), options));
    return cluster_remesh(mesh, std::move(tets), at_time, options, budget);
}

std::vector<Tet> with_ring(const Mesh& mesh, std::span<const Tet> cells) {
    Cluster cluster(cells);
    IndexSet<Vertex> seen;
    std::vector<Tet> around;
    for (Tet t : cells)
        for (Vertex v : mesh.tets[t]) {
            if (!seen.insert(v)) continue;
            ball(mesh, v, around);
            for (Tet n : around)
                if (mesh.region[n] == mesh.region[cells.front()]) cluster.add(n);
        }
    return cluster.cells;
}

namespace {

/// Climbs from one bad cell: its neighbourhood is remeshed, ring by ring, until its place is below the floor. Returns
/// whether it is.
bool climb(Mesh& mesh, Tet bad, const Snapshot& at_time, AdaptOptions options, Budget& budget, Changes& changes) {
    std::vector<Tet> cluster{bad};
    for (int ring = 1; ring <= options.largest_ring && !budget.spent(); ++ring) {
        cluster = with_ring(mesh, cluster);
        options.seed = random_bits(options.seed, static_cast<std::uint64_t>(ring));
        const auto cavity = cluster_remesh(mesh, cluster, at_time, options, budget);
        if (!cavity || cavity->worst_after > options.floor) continue;
        carry_out(mesh, *cavity, changes);
        ++changes.local_remeshes;
        changes.largest_ring = std::max(changes.largest_ring, ring);
        return true;
    }
    return false;
}

/// The last rung, for each region that has a bad cell: as costly as making its mesh anew, so it is tried once.
void remesh_regions(Mesh& mesh, const std::vector<Tet>& bad, const Snapshot& at_time, const AdaptOptions& options,
                    Changes& changes) {
    std::set<Region> tried;
    for (Tet t : bad) {
        if (!is_worse(mesh, t, options.floor)) continue;
        if (!tried.insert(mesh.region[t]).second) continue;
        const auto cavity = cluster_remesh(mesh, all_tets(mesh, mesh.region[t]), at_time, options);
        if (!cavity) continue;
        carry_out(mesh, *cavity, changes);
        ++changes.global_remeshes;
    }
}

}  // namespace

Changes repair(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options) {
    Changes changes;
    const double allowed = cells_to_cut_out(cells.size(), options);
    Budget budget(allowed);
    std::vector<Tet> left;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (!is_worse(mesh, cells[i], options.floor)) continue;
        heed(options.watch, "repairing cells", static_cast<double>(i) / static_cast<double>(cells.size()));
        if (!climb(mesh, cells[i], at_time, options, budget, changes)) left.push_back(cells[i]);
    }
    if (options.whole_region) remesh_regions(mesh, left, at_time, options, changes);
    changes.cut_out += static_cast<int>(allowed - budget.left());
    if (budget.spent()) changes.given_up += count_worse(mesh, left, options.floor);
    return changes;
}

}  // namespace kropla
