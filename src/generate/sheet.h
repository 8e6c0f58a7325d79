#pragma once

#include <kropla/base/index.h>
#include <kropla/generate/generate.h>

#include <optional>
#include <vector>

namespace kropla {

/// A half-edge: an edge as one of its two triangles sees it. Those of a triangle are 3 t, 3 t + 1, 3 t + 2, in its order.
using Half = Index<struct HalfTag>;

[[nodiscard]] constexpr Half next(Half h) { return Half(h.value % 3 == 2 ? h.value - 2 : h.value + 1); }
[[nodiscard]] constexpr Half previous(Half h) { return Half(h.value % 3 == 0 ? h.value + 2 : h.value - 1); }

/// A closed manifold of triangles, counter-clockwise seen from outside, that can be changed; some of its edges are
/// creases, which no operation loses. A corner table [Rossignac, Safonova, Szymczak 2001, "3D compression made simple:
/// Edgebreaker on a corner table"].
struct Sheet {
    /// What holds a vertex.
    enum class Hold : char { none, on_crease, corner };

    Array<Half, Vertex> origin;  // none: its triangle has been removed
    Array<Half, Half> twin;      // the same edge, seen from across
    Array<Half, char> crease;    // is the edge one?
    Array<Vertex, Vec3> place;   // [m]
    Array<Vertex, Hold> hold;
    Array<Vertex, Half> leaving;  // a half-edge that begins there; none: the vertex has been removed

    [[nodiscard]] Vertex target(Half h) const { return origin[next(h)]; }
    [[nodiscard]] Vertex apex(Half h) const { return origin[previous(h)]; }  ///< the corner opposite the edge
    [[nodiscard]] bool alive(Half h) const { return origin[h].exists(); }
    [[nodiscard]] double length(Half h) const { return distance(place[origin[h]], place[target(h)]); }
};

/// The surface must be closed and a manifold. Edges of `creases` are creases; what holds vertices is not told.
[[nodiscard]] Sheet make_sheet(const Surface& surface);
/// What is left of it, in the order of the sheet.
[[nodiscard]] Surface surface_of(const Sheet& sheet);

/// Calls `visit` with each half-edge that begins at `v`.
template <class Visit>
void for_each_leaving(const Sheet& sheet, Vertex v, const Visit& visit) {
    const Half first = sheet.leaving[v];
    Half h = first;
    do {
        const Half beyond = sheet.twin[previous(h)];
        visit(h);
        h = beyond;
    } while (h != first);
}

/// Twice the area of the triangle of `h`, along its normal [m^2]; the same if the corner at `moved` were at `to`.
[[nodiscard]] Vec3 normal_area(const Sheet& sheet, Half h);
[[nodiscard]] Vec3 normal_area(const Sheet& sheet, Half h, Vertex moved, const Vec3& to);

/// Puts a vertex at `place` into the edge; returns it. A crease stays one, in two parts.
Vertex split_edge(Sheet& sheet, Half h, const Vec3& place);

/// [-] how much triangles may be turned by what is done at once: the cosine.
inline constexpr double most_turned = 0.5;

/// May the edge be exchanged for the one across its two triangles? Not if it is a crease or that one is there already,
/// nor if the new triangles would be turned by more than `most_turned` against the old ones: long ones along a round wire would
/// fold.
[[nodiscard]] bool may_flip(const Sheet& sheet, Half h);
void flip_edge(Sheet& sheet, Half h);

/// May the edge's origin be drawn into its target? Not if the surface would touch itself or lose a crease by it, a
/// triangle would turn by more than 60 degrees, or an edge of the target become longer than `longest` [m].
[[nodiscard]] bool may_collapse(const Sheet& sheet, Half h, double longest);
void collapse_edge(Sheet& sheet, Half h);

/// Flips edges where that raises the least angle of their two triangles, until none is left: in a plane, what comes out is
/// a Delaunay triangulation [Lawson 1977].
void flip_for_angles(Sheet& sheet, const Watch* watch = nullptr);
/// Flips edges where that brings the counts of edges at four vertices nearer to six; once over all.
void flip_for_valences(Sheet& sheet);

/// Without what was removed, numbered anew.
[[nodiscard]] Sheet compacted(const Sheet& sheet);

}  // namespace kropla
