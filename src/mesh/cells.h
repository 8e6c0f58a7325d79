#pragma once

#include <array>

namespace kropla {

// The numbering of a tet's corners, facets and edges, said here once.
//
//            3                corners  0 1 2 3, det(v1-v0, v2-v0, v3-v0) > 0
//           /|\               facet i  is opposite corner i; its corners, listed so that their normal
//          / | \                       (right hand) points out of the tet
//         /  |  \             edge k   joins the corners tet_edges[k]; the edge opposite k is 5 - k
//        0---|---2
//         \  |  /
//          \ | /
//            1

inline constexpr std::array<std::array<int, 3>, 4> tet_facets = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

inline constexpr std::array<std::array<int, 2>, 6> tet_edges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// A prism (triangle, k) of a layer: the wall's side below, the shell's above.
//
//            5                corners  0 1 2 on the wall's side, 3 4 5 above them, one column each;
//           /|\                        0 1 2 counter-clockwise seen from above
//          3---4
//          | | |              det(v1-v0, v2-v0, v3-v0) > 0
//          | 2 |
//          |/ \|
//          0---1

}  // namespace kropla
