// The supermesh of old and new cells, never kept: each part is integrated and added to sums.
//   [Farrell, Maddison 2011] Conservative interpolation between volume meshes by local Galerkin projection.
//   CMAME 200.
//   [Gander, Japhet 2013] Algorithm 932: PANG. ACM TOMS 40: advancing from neighbour to neighbour in both
//   meshes.
// Changed: planes are those of the old mesh's facets, one per facet and seen from both sides; corners that
// both meshes have in common lie on them exactly, as their numbers tell.

#include "transfer/overlap.h"

#include "base/tetrahedron.h"
#include "mesh/box_tree.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/topology.h>
#include "transfer/clip.h"
#include "transfer/slot_map.h"
#include <kropla/transfer/transfer.h>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

namespace kropla {
namespace {

constexpr double covered = 1e-12;  // [-] of a cell's volume: its parts add up to it
constexpr double inside = -1e-9;   // a barycentric coordinate down to this is rounding
constexpr int longest_walk = 200;  // steps

struct OldCell {
    std::array<Vertex, 4> vertices;
    std::array<Vec3, 4> inward;            // of the facet opposite corner i: normal, twice the area long
    std::array<Vec3, 4> on;                // a corner of that facet
    std::array<double, 4> inverse_height;  // by which `inward` tells the barycentric coordinate
    std::array<std::int32_t, 4> across;    // the old cell of the region beyond that facet; -1: none is gone
    Region region;
};

/// A new cell to be covered.
struct NewCell {
    std::array<Vertex, 4> vertices;  // those that the old mesh has in the same place
    std::array<double, 4> x, y, z;   // of its corners
    Vec3 centre;
    double volume;
    Region region;
};

/// Sets the plane of the facet opposite `corner`, computed from its vertices in ascending order: the two
/// cells at a facet get the same numbers, with opposite signs.
void set_plane(const Mesh& mesh, OldCell& cell, int corner) {
    std::array<Vertex, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = cell.vertices[as_size(tet_facets[as_size(corner)][k])];
    double sign = -1;  // tet_facets lists them with the normal pointing out
    const auto order = [&](std::size_t a, std::size_t b) {
        if (v[a] < v[b]) return;
        std::swap(v[a], v[b]);
        sign = -sign;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    const Vec3 p = mesh.position[v[0]];
    const std::size_t i = as_size(corner);
    cell.on[i] = p;
    cell.inward[i] = sign * cross(mesh.position[v[1]] - p, mesh.position[v[2]] - p);
    cell.inverse_height[i] = 1 / dot(cell.inward[i], mesh.position[cell.vertices[i]] - p);
}

class OldCells {
public:
    OldCells(const Mesh& mesh, std::span<const Tet> gone)
        : mesh_(mesh), gone_(gone), index_(gone.size()), cells_(gone.size()) {
        for (std::size_t i = 0; i < gone.size(); ++i)
            index_.insert(gone[i].value, static_cast<std::int32_t>(i));
        tbb::parallel_for(std::size_t{0}, gone.size(), [&](std::size_t i) {
            OldCell& cell = cells_[i];
            cell.vertices = mesh.tets[gone[i]];
            cell.region = mesh.region[gone[i]];
            for (int corner = 0; corner < 4; ++corner) {
                set_plane(mesh, cell, corner);
                const Tet n = mesh.neighbour[gone[i]][as_size(corner)];
                const bool same = n.exists() && mesh.region[n] == cell.region;
                cell.across[as_size(corner)] = same ? index_.find(n.value) : -1;
            }
        });
    }
    [[nodiscard]] const OldCell& operator[](std::int32_t i) const { return cells_[as_size(i)]; }
    [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(cells_.size()); }
    [[nodiscard]] std::int32_t find(Tet t) const { return index_.find(t.value); }
    [[nodiscard]] Tet tet(std::int32_t i) const { return gone_[as_size(i)]; }

    /// Each that has cells, once.
    [[nodiscard]] std::vector<Region> regions() const {
        std::vector<Region> all;
        for (const OldCell& cell : cells_)
            if (std::ranges::find(all, cell.region) == all.end()) all.push_back(cell.region);
        return all;
    }
    /// Those of the region whose boxes meet this one, in ascending order.
    void near(const Extent& box, Region region, std::vector<std::int32_t>& found) const {
        found.clear();
        (void)tree().any(box, [&](std::size_t i) {
            if (cells_[i].region == region) found.push_back(static_cast<std::int32_t>(i));
            return false;
        });
        std::ranges::sort(found);
    }
    /// That of the region whose box is nearest; -1 if there is none.
    [[nodiscard]] std::int32_t nearest(const Vec3& x, Region region) const {
        std::int32_t found = -1;
        double least = Extent::infinite;
        const auto from = [&](const Extent& box) { return box.squared_distance(x); };
        (void)tree().least(from, [&](std::size_t i) {
            const double d = cells_[i].region == region ? from(extent(i)) : Extent::infinite;
            if (d < least) {
                least = d;
                found = static_cast<std::int32_t>(i);
            }
            return d;
        });
        return found;
    }

private:
    [[nodiscard]] Extent extent(std::size_t i) const {
        Extent box;
        for (Vertex v : cells_[i].vertices) box.take_in(mesh_.position[v]);
        return box;
    }
    /// Made when it is first asked for.
    [[nodiscard]] const BoxTree& tree() const {
        std::call_once(made_, [&] {
            std::vector<Extent> boxes(cells_.size());
            for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = extent(i);
            tree_.emplace(std::move(boxes));
        });
        return *tree_;
    }

    const Mesh& mesh_;
    std::span<const Tet> gone_;
    SlotMap index_;
    std::vector<OldCell> cells_;
    mutable std::once_flag made_;
    mutable std::optional<BoxTree> tree_;
};

NewCell new_cell(const Mesh& before, const Mesh& after, Tet t) {
    NewCell cell;
    cell.region = after.region[t];
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vertex v = after.tets[t][k];
        corners[k] = after.position[v];
        cell.x[k] = corners[k].x;
        cell.y[k] = corners[k].y;
        cell.z[k] = corners[k].z;
        cell.vertices[k] = same_vertex(before, after, v) ? v : Vertex{};
        cell.centre += 0.25 * corners[k];
    }
    cell.volume = tet_volume(corners[0], corners[1], corners[2], corners[3]);
    return cell;
}

/// Distances of the new cell's corners from the planes of the old one, positive inside, in units of its own.
using Distances = std::array<std::array<double, 4>, 4>;

Distances distances(const OldCell& old, const NewCell& cell) {
    Distances d;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 n = old.inward[i], p = old.on[i];
        for (std::size_t k = 0; k < 4; ++k)
            d[i][k] = n.x * (cell.x[k] - p.x) + n.y * (cell.y[k] - p.y) + n.z * (cell.z[k] - p.z);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        if (!cell.vertices[k].exists()) continue;
        for (std::size_t own = 0; own < 4; ++own)  // the old cell's corner where the new cell's stands
            if (old.vertices[own] == cell.vertices[k])
                for (std::size_t i = 0; i < 4; ++i)
                    if (i != own) d[i][k] = 0;
    }
    return d;
}

/// What a new cell and an old one have in common.
struct Meeting {
    bool met = false;
    unsigned crossed = 0;  // the old cell's facets beyond which the new one goes on
    TetMoments common{};
};

/// How many tets a plane leaves of one, given how many of its corners are outside and within.
constexpr int pieces(int outside, int within) {
    return outside == 0 ? 0 : within == 1 ? 1 : outside + within - 1;
}

Meeting meet(const Distances& d) {
    Meeting meeting;
    std::array<int, 4> left;  // of the whole tet by each plane; 0: it does not cross
    for (std::size_t i = 0; i < 4; ++i) {
        const auto outside = std::ranges::count_if(d[i], [](double x) { return x < 0; }),
                   within = std::ranges::count_if(d[i], [](double x) { return x > 0; });
        if (within == 0) return meeting;
        left[i] = pieces(static_cast<int>(outside), static_cast<int>(within));
    }
    meeting.met = true;
    if (left == std::array{0, 0, 0, 0}) {
        meeting.common = whole_moments();
        return meeting;
    }
    TetPart part = whole_tet();
    for (int most = 1; most <= 3; ++most)  // first the planes that leave little
        for (int i = 0; i < 4; ++i) {
            if (left[as_size(i)] != most || !cut(part, d[as_size(i)])) continue;
            if (part.count == 0) return {};
            meeting.crossed |= 1u << i;
        }
    meeting.common = moments(part);
    return meeting;
}

/// Covers new cells one after another; what it keeps in between only saves memory and steps of the walk.
class Cover {
public:
    Cover(const Mesh& before, const Mesh& after, const OldCells& old, const Watch* watch)
        : before_(before), after_(after), old_(old), watch_(watch), seen_(as_size(old.size()), 0) {}

    void begin_chunk() { last_ = -1; }

    void cover(const NewCell& cell, Tet slot, Overlaps::Chunk& out) {
        nodal_.clear();
        shares_.clear();
        sum_ = 0;
        ++stamp_;
        if (const std::int32_t start = find(cell, slot); start >= 0) spread_from(start, cell);
        if (std::abs(sum_ - 1) > covered) search(cell, out);
        out.worst_gap = std::max(out.worst_gap, std::abs(sum_ - 1));
        write(cell, out);
    }

private:
    /// Tries all old cells near, as the walk may have missed one; where a surface has come to lie elsewhere, a new cell
    /// reaches beyond the old ones of its region, and is covered by what there is, or, within none, by the nearest.
    void search(const NewCell& cell, Overlaps::Chunk& out) {
        heed(watch_);
        ++out.searched;
        Extent box;
        for (std::size_t k = 0; k < 4; ++k) box.take_in({cell.x[k], cell.y[k], cell.z[k]});
        old_.near(box, cell.region, near_cells_);
        for (const std::int32_t i : near_cells_)
            if (seen_[as_size(i)] != stamp_) visit(i, cell);
        if (sum_ > 0) return;
        const std::int32_t nearest = old_.nearest(cell.centre, cell.region);
        if (nearest < 0) return;
        sum_ = 1;
        shares_ = {{nearest, 1}};
        for (Vertex v : old_[nearest].vertices) weights_of(v) = {1.0 / 16, 1.0 / 16, 1.0 / 16, 1.0 / 16};
    }

    /// An old cell that overlaps the new one: where a corner that both meshes have sees the new one's centre,
    /// or where the centre is. -1 if none is found.
    std::int32_t find(const NewCell& cell, Tet slot) {
        for (Vertex v : cell.vertices) {
            if (!v.exists()) continue;
            const std::int32_t found = old_.find(seen_from(v, cell));
            if (found >= 0 && old_[found].region == cell.region) return last_ = found;
        }
        for (Vertex v : near(cell, slot))
            if (const std::int32_t found = walk(old_.find(before_.tet_at[v]), cell); found >= 0)
                return last_ = found;
        const std::int32_t start = start_of_search(cell, slot);
        if (start < 0) return -1;
        const std::int32_t found = old_.find(locate(before_, cell.centre, old_.tet(start)).tet);
        return found < 0 ? -1 : last_ = found;
    }

    /// Vertices of the new cell and of those next to it that the old mesh has too, here or elsewhere.
    [[nodiscard]] std::span<const Vertex> near(const NewCell& cell, Tet slot) {
        near_.clear();
        const auto add = [&](Vertex v) {
            if (static_cast<std::size_t>(v.value) < before_.position.size() && before_.tet_at[v].exists())
                near_.push_back(v);
        };
        for (Vertex v : after_.tets[slot]) add(v);
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = after_.neighbour[slot][as_size(corner)];
            if (n.exists() && after_.region[n] == cell.region)
                add(after_.tets[n][as_size(mirror_corner(after_, {slot, corner}))]);
        }
        return near_;
    }

    /// Where a walk among the old cells that are gone finds the new cell's centre; -1 if it leaves them.
    [[nodiscard]] std::int32_t walk(std::int32_t i, const NewCell& cell) const {
        if (i >= 0 && old_[i].region != cell.region) return -1;
        for (int step = 0; step < longest_walk && i >= 0; ++step) {
            const OldCell& old = old_[i];
            double least = inside;
            int across = -1;
            for (int k = 0; k < 4; ++k) {
                const double coordinate =
                    dot(old.inward[as_size(k)], cell.centre - old.on[as_size(k)]) * old.inverse_height[as_size(k)];
                if (coordinate >= least) continue;
                least = coordinate;
                across = k;
            }
            if (across < 0) return i;
            i = old.across[as_size(across)];
        }
        return -1;
    }

    /// An old cell of the region: where the last walk ended, or that in the slot, or any.
    [[nodiscard]] std::int32_t start_of_search(const NewCell& cell, Tet slot) const {
        for (const std::int32_t guess : {last_, old_.find(slot)})
            if (guess >= 0 && old_[guess].region == cell.region) return guess;
        for (std::int32_t i = 0; i < old_.size(); ++i)
            if (old_[i].region == cell.region) return i;
        return -1;
    }

    /// The tet of the ball of `v` in the old mesh through which the centre of the new cell is seen, by a walk
    /// around `v`; none if it ends at the region's surface.
    [[nodiscard]] Tet seen_from(Vertex v, const NewCell& cell) const {
        Tet t = before_.tet_at[v];
        for (int step = 0; step < longest_walk && t.exists() && before_.region[t] == cell.region; ++step) {
            const Tet next = further_round(v, t, cell.centre);
            if (next == t) return t;
            t = next;
        }
        return {};
    }

    /// The tet next to `t` in the ball of `v` that comes nearer to being looked through; `t` if it is.
    [[nodiscard]] Tet further_round(Vertex v, Tet t, const Vec3& x) const {
        const auto& corners = before_.tets[t];
        const Vec3 origin = before_.position[v], ray = x - origin;
        double least = 0;
        std::size_t across = 4;
        for (std::size_t k = 0; k < 4; ++k) {
            if (corners[k] == v) continue;
            const auto& facet = tet_facets[k];  // v is one of its corners; the normal points out
            std::size_t a = 0;
            while (corners[as_size(facet[a])] != v) ++a;
            const Vec3 p = before_.position[corners[as_size(facet[(a + 1) % 3])]] - origin,
                       q = before_.position[corners[as_size(facet[(a + 2) % 3])]] - origin;
            const Vec3 outward = cross(p, q);
            const double beyond = dot(outward, ray);
            if (beyond <= 0 || beyond * beyond <= least * squared_norm(outward)) continue;
            least = beyond * beyond / squared_norm(outward);
            across = k;
        }
        return across == 4 ? t : before_.neighbour[t][across];
    }

    void spread_from(std::int32_t start, const NewCell& cell) {
        queue_.assign(1, start);
        seen_[as_size(start)] = stamp_;
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            unsigned crossed = visit(queue_[i], cell);
            if (i == 0) crossed = 15;  // the centre may be in a facet
            for (int k = 0; k < 4; ++k) {
                const std::int32_t n = old_[queue_[i]].across[as_size(k)];
                if ((crossed >> k & 1u) == 0 || n < 0 || seen_[as_size(n)] == stamp_) continue;
                seen_[as_size(n)] = stamp_;
                queue_.push_back(n);
            }
        }
    }

    /// Adds what the two cells have in common. Returns the facets that the new cell crosses.
    unsigned visit(std::int32_t i, const NewCell& cell) {
        const OldCell& old = old_[i];
        const Distances d = distances(old, cell);
        const Meeting meeting = meet(d);
        if (!meeting.met) return 0;
        std::array<double, 4> whole{};  // integrals of the new cell's shape functions
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& m = meeting.common[k];
            whole[k] = (m[0] + m[1]) + (m[2] + m[3]);
        }
        const double share = (whole[0] + whole[1]) + (whole[2] + whole[3]);
        sum_ += share;
        shares_.push_back({i, share});
        for (std::size_t corner = 0; corner < 4; ++corner) {
            std::array<double, 4> product{};
            for (std::size_t l = 0; l < 4; ++l)
                for (std::size_t k = 0; k < 4; ++k) product[k] += meeting.common[l][k] * d[corner][l];
            auto& weight = weights_of(old.vertices[corner]);
            for (std::size_t k = 0; k < 4; ++k) weight[k] += product[k] * old.inverse_height[corner];
        }
        return meeting.crossed;
    }

    std::array<double, 4>& weights_of(Vertex v) {
        for (NodalShare& share : nodal_)
            if (share.from == v) return share.weight;
        return nodal_.emplace_back(NodalShare{v, {}}).weight;
    }

    void write(const NewCell& cell, Overlaps::Chunk& out) {
        const double scale = sum_ > 0 ? 1 / sum_ : 0;
        for (NodalShare share : nodal_) {
            for (double& w : share.weight) w *= scale * cell.volume;
            out.nodal.push_back(share);
        }
        for (const CellShare& share : shares_) out.cell.push_back({share.gone, share.share * scale});
        out.nodal_end.push_back(static_cast<std::uint32_t>(out.nodal.size()));
        out.cell_end.push_back(static_cast<std::uint32_t>(out.cell.size()));
    }

    const Mesh& before_;
    const Mesh& after_;
    const OldCells& old_;
    const Watch* watch_;
    std::vector<std::uint32_t> seen_;  // per old cell: the stamp of the new cell that met it last
    std::uint32_t stamp_ = 0;
    std::int32_t last_ = -1;  // where the last walk ended
    std::vector<Vertex> near_;
    std::vector<std::int32_t> queue_, near_cells_;
    std::vector<NodalShare> nodal_;
    std::vector<CellShare> shares_;
    double sum_ = 0;
};

template <class Share>
std::span<const Share> part_of(const std::vector<Share>& all, const std::vector<std::uint32_t>& end,
                               std::size_t i) {
    const std::size_t first = i == 0 ? 0 : end[i - 1];
    return {all.data() + first, end[i] - first};
}

}  // namespace

std::span<const NodalShare> Overlaps::nodal(std::size_t come) const {
    const Chunk& chunk = chunks[come / chunk_size];
    return part_of(chunk.nodal, chunk.nodal_end, come % chunk_size);
}
std::span<const CellShare> Overlaps::cell(std::size_t come) const {
    const Chunk& chunk = chunks[come / chunk_size];
    return part_of(chunk.cell, chunk.cell_end, come % chunk_size);
}

Overlaps overlaps(const Mesh& before, const Mesh& after, const ChangedCells& changed, const Watch* watch) {
    const OldCells old(before, changed.gone);
    Overlaps result;
    const std::size_t count = changed.come.size();
    result.chunks.resize((count + Overlaps::chunk_size - 1) / Overlaps::chunk_size);
    tbb::enumerable_thread_specific<Cover> covers([&] { return Cover(before, after, old, watch); });
    tbb::parallel_for(std::size_t{0}, result.chunks.size(), [&](std::size_t c) {
        heed(watch);
        Cover& cover = covers.local();
        cover.begin_chunk();
        const std::size_t end = std::min(count, (c + 1) * Overlaps::chunk_size);
        for (std::size_t i = c * Overlaps::chunk_size; i < end; ++i) {
            const Tet t = changed.come[i];
            cover.cover(new_cell(before, after, t), t, result.chunks[c]);
        }
    });
    for (const Overlaps::Chunk& chunk : result.chunks) {
        result.searched += chunk.searched;
        result.worst_gap = std::max(result.worst_gap, chunk.worst_gap);
    }
    return result;
}

std::vector<Location> locate_in_gone(const Mesh& before, const ChangedCells& changed, std::span<const Vec3> places) {
    const OldCells old(before, changed.gone);
    std::vector<Location> found(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t p) {
        const auto weights_in = [&](std::int32_t i) {
            std::array<double, 4> weights;
            for (std::size_t k = 0; k < 4; ++k)
                weights[k] = dot(old[i].inward[k], places[p] - old[i].on[k]) * old[i].inverse_height[k];
            return weights;
        };
        Extent here;
        here.take_in(places[p]);
        std::vector<std::int32_t> near;
        for (Region region : old.regions()) {
            old.near(here, region, near);
            if (near.empty()) near = {old.nearest(places[p], region)};
            for (const std::int32_t i : near) {
                const auto weights = weights_in(i);
                const auto least = [](const std::array<double, 4>& w) { return std::min(0.0, *std::ranges::min_element(w)); };
                if (!found[p].tet.exists() || least(weights) > least(found[p].weights)) found[p] = {old.tet(i), weights};
            }
        }
    });
    return found;
}

}  // namespace kropla
