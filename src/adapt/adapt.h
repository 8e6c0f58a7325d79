#pragma once

#include <kropla/base/watch.h>
#include <kropla/domain/domain.h>
#include <kropla/mesh/cavity.h>
#include <kropla/mesh/mesh.h>
#include <kropla/mesh/topology.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kropla {

// --- What adaptation did ---------------------------------------------------------------------------------------

/// What was changed and how often each operator was used. `vertices` are new or were moved at a fixed time,
/// so that the solution is to be carried there; `cells` are new. Each may stand more than once, some may be
/// gone again.
struct Changes {
    std::vector<Vertex> vertices;
    std::vector<Tet> cells;
    std::vector<Tet> removed;  // slots of cells that were replaced; new cells may stand in them
    int smoothing_sweeps = 0, moved = 0, swaps = 0, splits = 0, collapses = 0;
    int local_remeshes = 0, largest_ring = 0, global_remeshes = 0;
    int cells_replaced = 0, vertices_inserted = 0;
    int treated = 0;  // bad cells for which an operator was sought that helps
    int cut_out = 0;  // cells of the clusters that were cut out, whether or not it helped
    int given_up = 0; // bad cells that were left as they are since a budget was spent

    Changes& operator+=(const Changes& other);
};

/// Carries a proposal out and notes it.
void carry_out(Mesh& mesh, const Cavity& cavity, Changes& changes);

// --- Smoothing (paper 1.1) ---------------------------------------------------------------------------------------

/// The paper's weights (Fig. 4): for the neighbours Pi of a vertex, w_i = sum of the distances from Pi to the
/// other neighbours, divided by the mean of those sums; new place = sum (x1 + x2 w_i) Pi / sum (x1 + x2 w_i).
/// x2 = 0 is the standard Laplacian; x1 = 0, x2 = 1 equalises volumes.
struct LaplaceWeights {
    double x1 = 1, x2 = 0;
};

/// Where the weighted Laplacian puts a vertex with neighbours at these places.
[[nodiscard]] Vec3 laplacian_place(std::span<const Vec3> neighbours, const LaplaceWeights& weights);
/// Where it puts `v`, kept on the faces of the box it lies on; on an interface it stays.
[[nodiscard]] Vec3 laplacian_place(const Mesh& mesh, Vertex v, const LaplaceWeights& weights);

/// One sweep over `vertices`, in order, each seeing the new places of those before it. Unguarded: cells may
/// turn over.
void smooth_laplacian(Mesh& mesh, std::span<const Vertex> vertices, const LaplaceWeights& weights);

/// One sweep that takes a move only if the worst aspect ratio of the vertex's ball does not get worse.
/// Returns the vertices that moved.
std::vector<Vertex> smooth_guarded(Mesh& mesh, std::span<const Vertex> vertices, const LaplaceWeights& weights);

/// Moves `v` to where the worst aspect ratio of its ball is least, or as low as `good_enough`; slides on the
/// faces of the box; stays on interfaces. Returns whether it moved: only if the worst ratio fell.
bool optimise_vertex(Mesh& mesh, Vertex v, double good_enough);

// --- Proposals: swapping, splitting, collapsing, inserting ------------------------------------------------------

/// What a swap is to reach: a worst aspect ratio below that of the cells it replaces, or below `limit` if one is
/// given; or, by energy, a lower sum of volume times (R/r)^4 [m^3], which does not depend on the number of cells and is
/// ruled by the bad ones, with no cell worse than `limit` after. `worst_before` and `worst_after` of the proposal are
/// then energies.
struct SwapGoal {
    bool by_energy = false;
    double limit = std::numeric_limits<double>::infinity();  // [-] R/r
};

/// Face removal: the two tets at a facet become three around a new edge. Nothing on the boundary or an
/// interface, or if the goal is not served.
[[nodiscard]] std::optional<Cavity> face_removal(const Mesh& mesh, Facet facet, SwapGoal goal = {});

/// Edge removal: the shell of the edge is replaced by the best triangulation of its ring, joined to both
/// ends; on a face of the box too, within the face. Nothing for an edge of an interface or of two patches,
/// for a ring of more than `longest_ring` vertices, or if the goal is not served.
inline constexpr int longest_ring = 9;
[[nodiscard]] std::optional<Cavity> edge_removal(const Mesh& mesh, const Shell& shell, Edge edge, SwapGoal goal = {});

/// Pulls `from` onto `to`. Nothing if `from` is held by something that the edge does not lie on, or if the
/// worst aspect ratio after would exceed `worst_allowed`.
[[nodiscard]] std::optional<Cavity> edge_collapse(const Mesh& mesh, Vertex from, Vertex to, double worst_allowed);
/// As above, with the ball of `from`: for loops that ask often.
[[nodiscard]] std::optional<Cavity> edge_collapse(const Mesh& mesh, Vertex from, Vertex to, std::span<const Tet> around,
                                                  double worst_allowed);

/// A new vertex on the edge, at the best place inside its shell (on a face of the box: within the face).
/// Nothing for an edge of an interface, or if the worst aspect ratio after would exceed `worst_allowed`.
[[nodiscard]] std::optional<Cavity> edge_split(const Mesh& mesh, const Shell& shell, Edge edge, double worst_allowed);

// --- Improvement: operators chosen worst-first -------------------------------------------------------------------

/// The paper's own way with a step, to be seen and compared: smoothing until it does not do, then the local cluster. No
/// size adaptation: cells are remeshed only where their quality falls. The limit is AdaptOptions::floor, ten in the paper.
struct PaperMethod {
    LaplaceWeights weights = {.x1 = 1, .x2 = 1};
    double much_less = 0.5;  // [limits] of R/r: "much less than ten", better cells are left alone
    double about = 0.8;      // [limits] of R/r: "about ten or more", the three steps of Fig. 5; after the step, the cluster
    double remeshed = 0.6;   // [limits] of R/r: what a cluster of one or two rings is to come to; a larger one, to `about`
    int sweeps = 10;         // of smoothing, at most, each time
};

struct AdaptOptions {
    int relaxations = 1;              // sweeps that equalise volumes as the mesh moves
    double swap_above = 3.8;          // [-] R/r: worse cells are swapped away where that lowers the energy
    double good_enough = 5.0;         // [-] R/r: worse cells are optimised by all means
    double passing = 50.0;            // [-] R/r: cells of the wrong size may become as bad, to be improved at once
    double floor = 10.0;              // [-] R/r: the case's limit; cells above it are what the ladder climbs for
    double split_above = 1.59;        // [target sizes] longer edges are split
    double collapse_below = 0.625;    // [target sizes] shorter edges are collapsed
    double treatments = 30;           // of bad cells that `improve` may seek an operator for, per bad cell it begins with
    double cut_out = 5;               // cells that may be cut out in clusters, per cell looked at
    bool clusters = true;             // what nothing else helps is re-triangulated with the ring around it
    int largest_ring = 6;             // rings of cells that are added to a cluster one by one
    bool whole_region = true;         // then the whole region is remeshed, the ladder's last rung
    std::uint64_t seed = 1;           // of the new points of a cluster
    std::optional<PaperMethod> paper = {};  // in a step; nothing: our way
    const Watch* watch = nullptr;     // may end the work, which throws Interrupted then
};

/// Swaps away the longest edges of `cells` (and of those that replace them) where that lowers the energy; where
/// a swap has been overtaken by another, again.
Changes swap_for_energy(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options = {});

/// Works on the cells of `cells` (and those that replace them): above `good_enough` worst first, swap, else
/// move a vertex, else collapse, else insert, never making the worst cell of a cavity worse; before and after
/// that by swaps for the energy. Of several vertices the one is moved that has most of its
/// cells among those that are new, or in `changed`: the solution is to be carried there anyway. Ends for every mesh,
/// also one with cells turned over or flat, or with places that are not finite: these are mended or left.
Changes improve(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at, const AdaptOptions& options = {},
                std::span<const Tet> changed = {});

/// Splits and collapses edges of `cells` towards the target size; a cell is made worse than `passing` only if
/// one of those it replaces was. To be followed by `improve`.
Changes adapt_to_size(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at, const AdaptOptions& options = {});

/// Moves vertices only (connectivity is unchanged): equalises volumes; then, of cells that have come near the
/// floor (and are above `good_enough`), takes vertices back, and optimises what is left.
Changes optimise_places(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options = {});

/// Cuts a cluster of tets of one region out, keeps its boundary facets, drops its free vertices, fills it
/// with new points of the target size, re-triangulates and unites; where a boundary facet is not recovered,
/// the cell across it joins the cluster. Nothing if that does not end, or the worst aspect ratio would not
/// fall.
[[nodiscard]] std::optional<Cavity> cluster_remesh(const Mesh& mesh, std::vector<Tet> cluster, const Snapshot& at,
                                                   const AdaptOptions& options = {});

/// The cells and one more ring of cells of their region, that of the first.
[[nodiscard]] std::vector<Tet> with_ring(const Mesh& mesh, std::span<const Tet> cells);

/// The repair ladder (paper 1.2-1.3): what `improve` leaves above the floor is cut out and re-triangulated,
/// with one more ring of cells each time, at last, once, with the whole region. `given_up` tells how many cells it left
/// above the floor because its budget (`cut_out`) was spent.
Changes repair(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at, const AdaptOptions& options = {});

}  // namespace kropla
