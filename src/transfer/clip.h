#pragma once

#include <array>
#include <cstdint>

namespace kropla {

// Parts of a tet, in its own coordinates: a point is a = (a1, a2, a3), its barycentric coordinates at the
// corners 1, 2, 3; that at corner 0 is 1 - a1 - a2 - a3. The whole tet has volume 1 in these units, whatever
// its shape.

/// A convex polyhedron, as tets that fill it; their corners stand in any order.
struct TetPart {
    static constexpr int most_tets = 81;  // cut by four planes: each makes at most three tets of one
    int count = 0;                        // 0: empty
    std::array<std::array<std::array<double, 3>, 4>, most_tets> tets;
};

[[nodiscard]] TetPart whole_tet();

/// Takes away the side of a plane on which a linear function, given by its values at the tet's four corners,
/// is negative. Returns whether there was any such side. The plane of the values and that of their negatives
/// give two parts that share the corners of their cut to the bit: together they are what was there.
bool cut(TetPart& part, const std::array<double, 4>& at_corners);

/// The integrals of products of two barycentric coordinates over a part, by the volume of the tet. They sum
/// to the share that the part has of the tet.
using TetMoments = std::array<std::array<double, 4>, 4>;

[[nodiscard]] TetMoments moments(const TetPart& part);
[[nodiscard]] constexpr TetMoments whole_moments() {
    TetMoments m{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) m[i][j] = i == j ? 0.1 : 0.05;
    return m;
}

}  // namespace kropla
