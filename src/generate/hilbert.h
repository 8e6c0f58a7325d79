#pragma once

#include <kropla/base/vec3.h>
#include <kropla/mesh/mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kropla {

/// Bits per axis of the grid whose cells the curve visits.
inline constexpr int hilbert_bits = 20;

/// How many cells the Hilbert curve visits before this one; neighbours on the curve are neighbours in space.
/// Coordinates are below 2^hilbert_bits.
[[nodiscard]] std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& cell);

/// Points along a Hilbert curve through a cube that holds them all. Equal points stand together; each comes
/// once, by its least index, and `same_as` names that one for the others.
struct SpatialOrder {
    std::vector<Vertex> order;
    Array<Vertex, Vertex> same_as;  // none for points in `order`
};
[[nodiscard]] SpatialOrder hilbert_order(std::span<const Vec3> points);

/// Divides an order into rounds, each about eight times as large as the one before and drawn at random, in
/// which points keep their order: a biased randomised insertion order (BRIO).
[[nodiscard]] std::vector<Vertex> in_random_rounds(std::span<const Vertex> order);

}  // namespace kropla
