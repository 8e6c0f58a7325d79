#pragma once

#include <cstddef>
#include <limits>
#include <numbers>

namespace kropla {

// The constants of adaptation that are no option (AdaptOptions, PaperMethod), each with its unit, what becomes worse when
// it is smaller or larger, and where it comes from: a paper; or measured on cases/quick.toml without heat, size.surface
// 3e-4 and growth 0.15, where the ten steps take 1097 swaps, 98 splits, 157 collapses, no cluster, and end with R/r 5.00
// at worst ("the ten steps"); or chosen, where nothing measured decides.

inline constexpr double infinity = std::numeric_limits<double>::infinity();  // R/r of what is no cell

// --- What pays
/// [-] fall of the worst R/r, relative, by a swap, a collapse, a split or a cluster. Smaller: 3 % more swaps at 1e-5, for
/// nothing. Larger: cells stay bad; worst R/r 5.05 at 0.05. The ten steps.
inline constexpr double least_gain = 1e-3;
/// [-] the same by a step of smoothing. Smaller: more steps. Larger: 4 clusters, R/r 5.06 at 0.05. The ten steps.
inline constexpr double least_smoothing_gain = 1e-2;
/// [-] fall of the energy, relative, by a swap. Smaller: 2 % more swaps at 0.01, no better cells. Larger: at 0.2 fewer
/// swaps, 16 % more splits. The ten steps.
inline constexpr double least_energy_gain = 0.05;
/// [good_enough] no swap for the energy makes a worse cell. Smaller: at 0.8, 30 % more splits. Larger: at 1, swaps that
/// leave cells which are bad in the next step, 7 % more of them. The ten steps.
inline constexpr double passable_after_swap = 0.96;

// --- Swaps (swap.cpp, improve.cpp)
/// [-] how much longer than the edge that goes a new diagonal may be. Smaller: at 1, 1 % of the swaps are missed. Larger:
/// questions for nothing. The ten steps.
inline constexpr double diagonal_tolerance = 1.05;
/// times that swaps overtaken by others are proposed again. Fewer: some stay undone (10 of 1097 at one round). More: nothing
/// at 12. The ten steps.
inline constexpr int most_swap_rounds = 6;

// --- Smoothing (star.cpp, optimise.cpp, improve.cpp)
/// [of the bound] to which a bad vertex is smoothed. Smaller: more steps of descent. Larger: at 1, cells are bad again at
/// the next step, 4 % more swaps, 9 % more splits. The ten steps.
inline constexpr double smoothing_goal = 0.9;
/// The same for the vertex of a split [of the worst R/r allowed]. Of no account from 0.5 to 1 in the ten steps; chosen.
inline constexpr double split_goal = 0.8;
/// [-] R/r from which a cell is flat but for rounding, and tells no direction in which to go. Chosen.
inline constexpr double flat = 1e6;
/// [of the worst R/r] cells that are as bad take part in the direction of descent, as in [Freitag, Ollivier-Gooch 1997].
/// Smaller: directions that help no cell much, 6 clusters at 0.8. Larger: the descent zigzags, R/r 5.05 at 0.99. The ten
/// steps.
inline constexpr double active_share = 0.93;
/// of descent, and halvings of each. Fewer: bad cells are left, R/r 5.05 at 3 steps or 2 halvings. More: time for nothing
/// at 20 steps or 8 halvings. The ten steps.
inline constexpr int most_steps = 8;
inline constexpr int most_halvings = 4;
/// [of the distance to the nearest vertex of the link] the first step at most. Smaller: R/r 5.09 at 0.1. Larger: more
/// halvings, R/r 5.01 at 0.5. The ten steps.
inline constexpr double first_step = 0.25;
/// [-] by how much a step goes beyond where the linear model of the ratio has the goal, which is this share of the one
/// given, as the model is too good. Smaller, overshoot 1: R/r 5.05. Larger: of no account in the ten steps.
inline constexpr double overshoot = 1.2;
inline constexpr double descent_goal = 0.8;
/// of [Frank, Wolfe 1956] for the direction, and the share of its squared length that ends them: three figures. Fewer, or
/// more: of no account from 5 to 60 in the ten steps; chosen.
inline constexpr int hull_iterations = 20;
inline constexpr double hull_tolerance = 1e-3;
/// [floor] vertices of worse cells are moved in 2.4. Smaller: vertices crowd, at 0.5 twice as many splits and collapses.
/// Larger: of no account at 1 in the ten steps, but a step ends nearer to being refused.
inline constexpr double near_the_floor = 0.8;
/// times that vertices are taken back, which may spoil the cells of others; and passes over the vertices of bad cells.
/// Fewer: cells are left above the floor. More: nothing, as they end by themselves. Chosen.
inline constexpr int most_retreats = 5;
inline constexpr int most_passes = 4;

// --- Collapses
/// [target sizes] the longest edge that a collapse for quality may make. Smaller: it is refused, and a split comes instead.
/// Larger: the edge is split again. Of no account from 1.5 to 3 in the ten steps; chosen.
inline constexpr double longest_by_quality = 2.0;
/// [split_above] the same for a collapse by size. Above 1, so that crowded vertices can go although others are too few:
/// what is squeezed along one axis is torn along another. Smaller: at 0.9 a third fewer, and 2.5 % more vertices after
/// ten steps. Larger: 1 % more swaps at 1.3. The ten steps.
inline constexpr double longest_by_size = 1.05;

// --- Clusters (remesh.cpp, improve.cpp)
/// [good_enough] worse cells are cut out with two rings around them instead of one. Smaller: larger clusters for
/// little. Larger: bad cells are left. Chosen.
inline constexpr double two_rings_above = 1.03;
/// [target sizes] between new points, as in the initial mesh; random sampling leaves gaps of twice that. Smaller: edges too
/// short, to be collapsed. Larger: too long. Chosen.
inline constexpr double spacing_in_sizes = 0.8;
/// [target sizes] of new points from the facets around the cluster. Smaller: flat cells at the rim. Larger: long ones
/// there. Chosen: half of an edge.
inline constexpr double clearance_in_sizes = 0.5;
/// random candidates per point that would fit. Fewer: gaps. More: time. Chosen.
inline constexpr int tries_per_point = 30;
/// of a cluster, to take in facets that were not recovered. Fewer: more clusters fail. More: time for those that end
/// nowhere. Chosen.
inline constexpr int most_growths = 30;
/// new points per cell of a cluster. Fewer: coarse cells are not cut out. More: time, to adapt sizes, which splits do.
/// Chosen.
inline constexpr double most_points_per_cell = 10;
/// rings of the clusters that are to last, by the paper's method: they are to be better than they must.
/// Fewer: cells are bad again soon. More: larger clusters. Chosen.
inline constexpr int lasting_rings = 2;

// --- Budgets, in what is handled. Smaller: bad cells are given up. Larger: longer until a hopeless mesh is refused
/// rounds in which a cell found stuck is tried again as others have changed. Chosen.
inline constexpr int most_rounds = 3;
/// cells for which an operator is sought, and splits, for a single bad one; splits for each further one: more vertices only
/// make more bad cells. Chosen.
inline constexpr double least_treatments = 100;
inline constexpr double least_splits = 50;
inline constexpr double splits_per_bad_cell = 1;
/// cells that may be cut out for a single bad one. Chosen: a cluster that grows by six rings.
inline constexpr double least_cut_out = 20000;
/// What costs as much time as to triangulate a cell: so many distances to facets; a treatment costs so many cells.
inline constexpr double facets_like_a_cell = 64;
inline constexpr double cells_like_a_treatment = 3;
/// of a cluster's filling, per bad cell: it is thrown away if it does not become good. Chosen.
inline constexpr double treatments_within = 5;

// --- Motion (move.cpp, way.cpp, mesh_step.cpp)
/// [of a cell's volume] that it keeps anywhere on its way. Smaller: flat cells half-way. Larger: refused early. Chosen.
inline constexpr double least_volume_kept = 0.05;
/// [largest semi-axes] how far a displacement goes. Smaller: cells are strained more. Larger: more of them move; with eight,
/// twice as many, and a step takes 1.6 times as long: docs/performance.md.
inline constexpr double reach_in_body_sizes = 6.0;
/// [the same] in a narrow box, where walls cut much of that away; and how finely it is looked for. Chosen: no more work.
inline constexpr double most_reach = 10.0;
inline constexpr double reach_step = 0.25;
/// [surface sizes] and at least. Smaller: few layers of cells share the motion of a coarsely meshed body. Chosen.
inline constexpr double least_reach_in_sizes = 10.0;
/// [cells in reach] that a zone holds. Smaller: left out and taken in again, step by step. Larger: room for what is behind.
inline constexpr std::size_t most_unused = 2;
/// into which the motion of a step is cut. Fewer: steps are refused. More: hopeless ones take longer. Chosen.
inline constexpr int most_legs = 8;
/// [of the way on which cells keep their volume] that a leg takes. Smaller: more legs. Larger: cells that are nearly flat at
/// its end. Chosen.
inline constexpr double share_of_safe = 0.7;
/// [of what is left] a shorter leg means that the motion is stuck. Smaller: legs for nothing. Larger: refused early.
inline constexpr double least_leg = 0.02;
/// [-] scaled Jacobian of a prism's corners. Smaller: prisms that a solver cannot use. Larger: refused early. Chosen.
inline constexpr double least_jacobian = 0.1;

// --- Surfaces that change (adapt_surface.cpp, surface.cpp, surface_star.cpp, move.cpp)
/// [rad] the sum of the angles across an edge, beyond which it is swapped: Delaunay's pi, and a little. Smaller: swaps to and
/// fro where the surface is not flat. Larger: obtuse triangles stay. Chosen.
inline constexpr double flat_pair = 1.05 * std::numbers::pi;
/// [rad] of a triangle, 34 degrees: its vertices are slid. Smaller: needles stay. Larger: more cells change. Chosen.
inline constexpr double poor_angle = 0.6;
/// of swaps and slides. Fewer: triangles are left as they are. More: nothing, as they end by themselves. Chosen.
inline constexpr int most_surface_rounds = 3;
/// halvings of a slide that does not help. Chosen.
inline constexpr int most_slide_halvings = 3;
/// [of an edge] by which a vertex may be shifted along the normal, to keep the volume or to meet a quadric. Smaller: changes
/// are refused where the surface bends. Larger: dents. Chosen.
inline constexpr double most_shift = 0.3;
/// [-] cosine between the normals of a triangle before and after. Smaller: folds. Larger: changes are refused. Chosen.
inline constexpr double least_agreement = 0.5;
/// to fit a quadric of six unknowns by least squares, and its least pivot [of the largest, scaled by the distances]: with
/// less, the surface is taken as flat. Chosen.
inline constexpr std::size_t least_quadric_points = 8;
inline constexpr double least_quadric_pivot = 1e-6;
/// of Newton's method for a shift that keeps a volume: all vertices of a surface along their normals; a few along several
/// faces, with differences over this share [of an edge]. Both are next to linear: more bring nothing. Chosen.
inline constexpr int even_shift_steps = 4;
inline constexpr int most_shift_steps = 8;
inline constexpr double shift_difference = 1e-3;
/// [good_enough] for the sake of worse cells triangles of a liquid's surface are changed. Smaller: more changes, each of which
/// disturbs the flow. Larger: worse cells there. Chosen.
inline constexpr double poor_at_liquids = 1.1;

// --- After a refusal (2.2)
/// [target sizes] around the place of trouble that are remeshed. Smaller: it gets stuck again. Larger: more cells are
/// replaced, and the solution projected. Chosen.
inline constexpr double trouble_in_sizes = 3;
/// [good_enough] the bound there, and the least it comes to [-]: 3 is perfect, and few cells are below 3.5. Smaller: no end.
/// Larger: stuck again. Chosen.
inline constexpr double stricter = 0.92;
inline constexpr double least_good_enough = 3.5;
/// [-] R/r: worse cells are cut out there if they stop a second attempt, with so many rings around them. Smaller, more
/// rings: much is remeshed. Larger, fewer: stuck again. Chosen.
inline constexpr double trouble_floor = 6;
inline constexpr int rings_of_trouble = 2;
/// By the paper's method: refusals until the whole region is meshed anew, and AdaptOptions::cut_out there. Chosen.
inline constexpr std::size_t refusals_until_all_anew = 3;
inline constexpr double cut_out_of_trouble = 50;

// --- What is told (refusal.cpp, fits_domain.cpp)
/// [target sizes] across a place of trouble: in less, a cell has to be flat, or smaller than wanted, and the gap is named.
inline constexpr double narrow_in_sizes = 1;
/// [target sizes] across a neck of a body that deforms, likewise: there triangles lie opposite each other.
inline constexpr double narrow_neck_in_sizes = 1.5;
/// [of the box's width] vertices on a face may be off it. Smaller: rounding is refused. Larger: a box that does not fit.
inline constexpr double most_off_its_face = 1e-9;
/// [surface sizes] vertices of a body may be off its surface. Smaller: the generator's own meshes, 0.15 at most off, come
/// near. Larger: a body in another place is not noticed.
inline constexpr double most_off_its_shape = 0.5;

}  // namespace kropla
