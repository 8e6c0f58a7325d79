#include "adapt/adapt_surface.h"

#include "adapt/constants.h"
#include "adapt/propose.h"
#include "adapt/surface.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kropla {
namespace {

/// The surface of one body while it is adapted.
class Surface {
public:
    Surface(Mesh& mesh, const SurfaceOf& of, Array<Vertex, double>& size, const AdaptOptions& options)
        : mesh_(mesh), of_(of), size_(size), options_(options) {}

    /// All edges of the triangles, each once.
    void take(std::span<const std::array<Vertex, 3>> triangles) {
        for (const auto& [a, b, c] : triangles)
            for (const Edge e : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
                if (e.a < e.b) edges_.push_back(e);
        std::vector<Edge> known = edges_;  // the others are of one triangle, which sees them the other way round
        std::ranges::sort(known, comes_before);
        for (const auto& [a, b, c] : triangles)
            for (const Edge e : {Edge{b, a}, Edge{c, b}, Edge{a, c}})
                if (e.a < e.b && !std::ranges::binary_search(known, e, comes_before)) edges_.push_back(e);
    }

    /// The edges that are new after a round may have wrong sizes still.
    void adapt_sizes() {
        for (int round = 0; round < most_surface_rounds; ++round)
            if (!adapt_sizes_once()) break;
        raise_new();
    }
    /// The vertices of splits, from the flat edges on which they are to where the surface bends.
    void raise_new() {
        for (Vertex v : new_)
            if (alive(mesh_, v)) try_change(raise_to_quadric(mesh_, v, of_), passable);
        new_.clear();
    }

    /// From now on, only edges are looked at that have changed, and those around them.
    void keep_to_changed() {
        edges_.clear();
        for (Vertex v : changes.vertices) {
            if (!alive(mesh_, v)) continue;
            for (const auto& [a, b] : surface_star(mesh_, v, of_.region).sides) {
                edges_.push_back({std::min(a, b), std::max(a, b)});
                edges_.push_back({std::min(a, v), std::max(a, v)});
            }
        }
        std::ranges::sort(edges_, comes_before);
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }

    void adapt_shapes() {
        for (int round = 0; round < most_surface_rounds; ++round) {
            bool helped = false;
            const auto edges = edges_;
            for (const Edge e : edges) {
                heed(options_.watch);
                const auto around = surface_shell(mesh_, e, of_.region);
                if (!around || !is_flat_pair(e)) continue;
                if (swap(e, *around, passable)) helped = true;
            }
            for (Vertex v : vertices()) {
                if (is_pinned(v)) continue;
                const SurfaceStar star = surface_star(mesh_, v, of_.region);
                if (least_angle(mesh_, star, mesh_.position[v]) >= poor_angle) continue;
                if (try_change(slide(mesh_, v, of_), passable)) {
                    ++changes.moved;
                    helped = true;
                }
            }
            if (!helped) return;
        }
    }

    /// What helps the cell, if it is at the surface, and changes that least.
    bool help(Tet t) {
        for (std::size_t k = 0; k < tet_edges.size(); ++k) {
            const Edge e = tet_edge(mesh_, t, k);
            const auto around = surface_shell(mesh_, e, of_.region);
            if (!around) continue;
            if (swap(e, *around, better)) return true;
        }
        const auto vertices = mesh_.tets[t];
        for (Vertex v : vertices) {
            if (is_pinned(v) || surface_star(mesh_, v, of_.region).sides.empty()) continue;
            if (try_change(slide_for_cells(mesh_, v, of_), better)) {
                ++changes.moved;
                return true;
            }
        }
        for (std::size_t k = 0; k < tet_edges.size(); ++k)
            if (const Edge e = tet_edge(mesh_, t, k); surface_shell(mesh_, e, of_.region) && collapse(e, longest_at(e), better))
                return true;
        for (std::size_t k = 0; k < tet_edges.size(); ++k) {
            const Edge e = tet_edge(mesh_, t, k);
            const auto around = surface_shell(mesh_, e, of_.region);
            if (around && split(e, *around, better)) return true;
        }
        return false;
    }

    Changes changes;

private:
    static bool comes_before(Edge a, Edge b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); }
    enum Demand { passable, better };

    [[nodiscard]] bool is_pinned(Vertex v) const {
        return of_.pinned != 0 && (constraint(mesh_, v, ball(mesh_, v)).patches & of_.pinned) != 0;
    }
    [[nodiscard]] double ratio(Edge e) const {
        return distance(mesh_.position[e.a], mesh_.position[e.b]) / size(e);
    }
    [[nodiscard]] double size(Edge e) const { return (size_[e.a] + size_[e.b]) / 2; }
    /// Of the edges at both ends, how long the longest is [m].
    [[nodiscard]] double longest_at(Edge e) const {
        double longest = 0;
        for (Vertex end : {e.a, e.b})
            for (Vertex v : ring(surface_star(mesh_, end, of_.region)))
                longest = std::max(longest, distance(mesh_.position[end], mesh_.position[v]));
        return longest;
    }
    [[nodiscard]] std::vector<Vertex> vertices() const {
        std::vector<Vertex> all;
        for (const Edge e : edges_)
            for (Vertex v : {e.a, e.b})
                if (alive(mesh_, v)) all.push_back(v);
        std::ranges::sort(all);
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }
    /// The angles across the edge add up to more than those of a quadrangle in a circle.
    [[nodiscard]] bool is_flat_pair(Edge e) const {
        double sum = 0;
        for (const auto& side : surface_star(mesh_, e.a, of_.region).sides) {
            if (side[0] != e.b && side[1] != e.b) continue;
            const Vec3& tip = mesh_.position[side[0] == e.b ? side[1] : side[0]];
            const Vec3 p = mesh_.position[e.a] - tip, q = mesh_.position[e.b] - tip;
            sum += std::atan2(norm(cross(p, q)), dot(p, q));
        }
        return sum > flat_pair;
    }

    /// Was any edge brought nearer to its size?
    bool adapt_sizes_once() {
        struct Wrong {
            double ratio;
            Edge edge;
        };
        std::vector<Wrong> wrong;
        for (const Edge e : edges_)
            if (const double r = ratio(e); r < options_.collapse_below || r > options_.split_above) wrong.push_back({r, e});
        const auto rank = [](double r) { return r > 1 ? 1 + 1 / r : r; };
        std::ranges::sort(wrong, {}, [&](const Wrong& w) { return std::tuple(rank(w.ratio), w.edge.a, w.edge.b); });
        bool helped = false;
        for (const auto& [was, edge] : wrong) {
            heed(options_.watch);
            const auto around = surface_shell(mesh_, edge, of_.region);
            if (!around || ratio(edge) != was) continue;
            const double longest = longest_by_size * options_.split_above * size(edge);
            helped |= was < 1 ? collapse(edge, longest, passable) : split(edge, *around, passable);
        }
        return helped;
    }
    [[nodiscard]] bool is_worth(const SurfaceChange& change, Demand demand) const {
        return change.worst_after <= (demand == passable ? std::max(options_.passing, change.worst_before)
                                                         : (1 - least_gain) * change.worst_before);
    }
    bool try_change(const std::optional<SurfaceChange>& change, Demand demand) {
        if (!change || !is_worth(*change, demand)) return false;
        note(carry_out_surface(mesh_, *change, changes));
        return true;
    }
    void note(const Replacement& done) {
        if (done.vertices.empty()) return;
        const Vertex v = done.vertices.front();
        if (size_.size() < mesh_.position.size()) size_.resize(mesh_.position.size(), size_[v.value == 0 ? v : Vertex(0)]);
        double sum = 0;
        const auto around = ring(surface_star(mesh_, v, of_.region));
        for (Vertex w : around) {
            sum += size_[w];
            edges_.push_back({std::min(v, w), std::max(v, w)});
        }
        size_[v] = sum / static_cast<double>(around.size());
    }
    bool split(Edge e, const Shell& around, Demand demand) {
        const SurfaceChange change = surface_split(mesh_, around, e);
        if (!is_worth(change, demand)) return false;
        const Replacement done = carry_out_surface(mesh_, change, changes);
        note(done);
        new_.push_back(done.vertices.front());
        ++changes.splits;
        return true;
    }
    bool collapse(Edge e, double longest, Demand demand) {
        if (is_pinned(e.a) || is_pinned(e.b)) return false;
        if (!try_change(surface_collapse(mesh_, e, of_, longest), demand)) return false;
        ++changes.collapses;
        return true;
    }
    bool swap(Edge e, const Shell& around, Demand demand) {
        const auto change = surface_swap(mesh_, around, e, of_);
        if (!try_change(change, demand)) return false;
        const Vertex c = change->moved[2].vertex, d = change->moved[3].vertex;
        edges_.push_back({std::min(c, d), std::max(c, d)});
        ++changes.swaps;
        return true;
    }

    Mesh& mesh_;
    SurfaceOf of_;
    Array<Vertex, double>& size_;
    const AdaptOptions& options_;
    std::vector<Edge> edges_;   // of the surface; some may be gone
    std::vector<Vertex> new_;
};

}  // namespace

bool has_wrong_size(const Mesh& mesh, const BodySurface& surface, const Array<Vertex, double>& size,
                    const AdaptOptions& options) {
    const auto is_wrong = [&](Vertex a, Vertex b) {
        const double ratio = distance(mesh.position[a], mesh.position[b]) / ((size[a] + size[b]) / 2);
        return ratio < options.collapse_below || ratio > options.split_above;
    };
    return std::ranges::any_of(surface.triangles, [&](const std::array<Vertex, 3>& t) {
        return is_wrong(t[0], t[1]) || is_wrong(t[1], t[2]) || is_wrong(t[2], t[0]);
    });
}

Changes adapt_surface(Mesh& mesh, const SurfaceOf& of, std::span<const std::array<Vertex, 3>> triangles,
                      Array<Vertex, double>& size, bool all, const AdaptOptions& options) {
    Surface adapted(mesh, of, size, options);
    adapted.take(triangles);
    adapted.adapt_sizes();
    if (!all) adapted.keep_to_changed();
    adapted.adapt_shapes();
    return adapted.changes;
}

Changes improve_surface(Mesh& mesh, const SurfaceOf& of, std::span<const Tet> cells, const AdaptOptions& options) {
    Array<Vertex, double> unused(mesh.position.size(), 1);
    Surface improved(mesh, of, unused, options);
    for (Tet t : cells)
        if (is_worse(mesh, t, options.good_enough)) (void)improved.help(t);
    improved.raise_new();
    return improved.changes;
}

std::vector<Tet> cells_at(const Mesh& mesh, std::span<const Vertex> vertices) {
    IndexSet<Tet> cells;
    std::vector<Tet> around;
    for (Vertex v : vertices) {
        if (!alive(mesh, v)) continue;
        ball(mesh, v, around);
        for (Tet t : around) cells.insert(t);
    }
    return cells.list();
}

}  // namespace kropla
