#pragma once

#include "transfer/cluster.h"

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// A new cell as part of a projection.
struct MassCell {
    Tet tet;
    std::int32_t come;                    // place in ChangedCells::come; -1: it did not change
    double volume;                        // [m^3]
    std::array<std::int32_t, 4> unknown;  // place in MassBlock::free; -1: the corner's value is held
};

/// A cell that is gone, or the place of one that did not change.
struct OldMass {
    std::array<Vertex, 4> vertices;
    double volume;  // [m^3]
};

/// The mass matrix beside its diagonal, by rows.
struct MassRows {
    std::vector<std::uint32_t> end;    // per unknown
    std::vector<std::int32_t> column;  // the unknowns next to it
    std::vector<double> value;         // [m^3]
    [[nodiscard]] std::span<const std::int32_t> columns(std::size_t row) const {
        const std::size_t first = row == 0 ? 0 : end[row - 1];
        return {column.data() + first, end[row] - first};
    }
};

/// The unknowns of one cluster: its vertices whose ball is all in it, and that nothing holds. `shape` is the
/// solution w of M w = m, m_i the integral of the shape function: the direction in which a given integral is
/// reached with the least change in the mean square.
struct MassBlock {
    std::vector<MassCell> cells;
    std::vector<OldMass> gone;
    std::vector<Vertex> free;
    std::vector<double> mass;   // m_i [m^3]: M's diagonal times 5/2
    MassRows rows;
    std::vector<double> shape;  // w_i [-]
    double shape_mass = 0;      // sum of m_i w_i [m^3]
};

/// Places of changed cells by their slots.
[[nodiscard]] SlotMap places_of(std::span<const Tet> tets);

[[nodiscard]] MassBlock mass_block(const Mesh& before, const Mesh& after, const ChangedCells& changed,
                                   const SlotMap& come, const Clusters& clusters, std::size_t cluster);

/// Solves M x = right to near rounding, starting from `x`.
void solve_mass(const MassBlock& block, std::span<const double> right, std::vector<double>& x);

}  // namespace kropla
