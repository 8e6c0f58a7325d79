#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// The working state of the Delaunay kernel and its one step. Private to the triangulation.

namespace kropla::delaunay {

using std::uint32_t;

inline constexpr uint32_t none = 0xffffffff;
inline constexpr uint32_t ghost = 0;  // the site at infinity, to which all facets of the hull are joined

/// A point to be inserted, in the order of insertion; half a cache line.
struct alignas(32) Site {
    Vec3 at;
    std::int32_t rank = -1;  // the point's index in the input
    uint32_t local = none;   // its number among the vertices of the rim, while the cavity is filled
};

/// A positively oriented tet; half a cache line. A ghost stands at corner 3 only: then corners 0 1 2 are a
/// facet of the hull, and a point d lies strictly beyond it if (0, 1, 2, d) is positively oriented.
struct alignas(32) Cell {
    std::array<uint32_t, 4> vertex;
    std::array<uint32_t, 4> across;  // 4 * cell + corner: the cell across the facet opposite each corner, and
                                     // which of its corners is opposite that facet
};

/// A facet around the cavity: (p, a, b, c) will be a positive tet; the ghost is c, if it is one of them.
struct RimFacet {
    uint32_t a, b, c;
    uint32_t outside;  // 4 * cell + corner of the cell that stays
};

/// For each corner the three others, such that all four are an even permutation and corner 3 comes last.
inline constexpr std::array<std::array<std::size_t, 3>, 4> others = {
    {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

inline constexpr std::size_t table_side = 64;  // cavities with more vertices are joined by sorting

/// A stack for inner loops: room is made ahead, and an item is kept or not without a branch.
template <class T>
struct Stack {
    std::vector<T> slots;
    std::size_t size = 0;

    void make_room(std::size_t more) {
        if (size + more > slots.size()) slots.resize(2 * (size + more));
    }
    void push_if(bool wanted, const T& item) {
        slots[size] = item;
        size += wanted;
    }
    void push(const T& item) {
        make_room(1);
        push_if(true, item);
    }
    T& operator[](std::size_t i) { return slots[i]; }
};

enum class Mark : std::uint8_t { unseen, inside, outside };

/// An edge of the rim as a new tet sees it, and 4 * cell + corner of the facet it spans with the new point.
struct RimEdge {
    uint32_t low, high, facet;
};

struct Kernel {
    std::vector<Site> sites;  // the ghost, then the points
    std::vector<Cell> cells;
    std::vector<uint32_t> free_cells;
    std::vector<Mark> mark;  // per cell, of the cavity: unseen again when it is filled
    uint32_t last = 0;       // a finite cell, where the next walk starts
    Stack<uint32_t> cavity;  // the cells in conflict, breadth first, as 4 * cell + corner: the facet opposite
                             // that corner is the one across which the search came
    Stack<RimFacet> rim;
    std::vector<uint32_t> slots;  // for the new cells, one per facet of the rim
    Stack<uint32_t> rim_vertices;
    std::vector<RimEdge> rim_edges;  // for large cavities
    std::array<uint32_t, table_side * table_side> facet_at_edge;  // by local numbers: a new cell's facet
};

[[nodiscard]] inline bool is_ghost(const Cell& c) { return c.vertex[3] == ghost; }

/// Inserts a site that is not in the triangulation yet and differs from all that are.
void insert(Kernel& k, uint32_t site);

}  // namespace kropla::delaunay
