#pragma once

#include "base/for_all.h"
#include <kropla/base/watch.h>
#include "simulate/pattern.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

namespace kropla {

/// What a cell adds to the rows of its corners: the row i of its matrix A on values x is
///     row_sum[i] x_i + sum over j of matrix[i][j] (x_j - x_i).
/// What is exchanged is in the second part alone: of a constant it makes exactly nothing.
template <std::size_t n, class Number = double>
struct CellSystem {
    std::array<std::array<Number, n>, n> matrix = {};  // A off its diagonal; what is on it is of no matter
    std::array<Number, n> row_sum = {};                // of A
    std::array<Number, n> held = {};                   // of it, by what is there
    std::array<Number, n> right = {};
    std::array<Number, n> load = {};                   // more of the right-hand side: what comes from outside
};

/// A x - b of the cell.
template <std::size_t n>
[[nodiscard]] std::array<double, n> gained(const CellSystem<n>& system, const std::array<double, n>& x) {
    std::array<double, n> sum;
    for (std::size_t i = 0; i < n; ++i) {
        sum[i] = system.row_sum[i] * x[i] - system.right[i] - system.load[i];
        for (std::size_t j = 0; j < n; ++j) sum[i] += system.matrix[i][j] * (x[j] - x[i]);
    }
    return sum;
}

/// In the order of the cells.
struct CellSystems {
    std::vector<CellSystem<4>> tets;
    std::vector<CellSystem<6>> prisms;
};

/// Where four tets' parts are to be.
using FourPlaces = std::array<CellSystem<4>*, 4>;

/// Asks the kernel, `CellSystem<4> kernel(Tet)` and `CellSystem<6> kernel(Prism)`, of each cell that `wanted` names,
/// from several threads at once; the others stay as they are. If it can, it is asked of four tets at once,
/// `kernel(std::array<Tet, 4>, FourPlaces)`, which is to give the same bits. Throws Interrupted if the watch says so.
template <class Kernel, class Wanted>
void ask_cells(const Cells& cells, const Kernel& kernel, const Wanted& wanted, CellSystems& systems, const Watch* watch) {
    constexpr std::size_t at_once = 256;
    const auto ask = [&](const auto& names, auto& parts) {
        parts.resize(names.size());
        for_all((names.size() + at_once - 1) / at_once, [&](std::size_t part) {
            heed(watch);
            const std::size_t end = std::min(names.size(), (part + 1) * at_once);
            std::array<std::size_t, at_once> asked;
            std::size_t count = 0, done = 0;
            for (std::size_t c = part * at_once; c < end; ++c)
                if (wanted(names[c])) asked[count++] = c;
            if constexpr (requires(std::array<std::decay_t<decltype(names[0])>, 4> four, FourPlaces to) { kernel(four, to); }) {
                for (; done + 4 <= count; done += 4) {
                    const auto* const c = asked.data() + done;
                    kernel(std::array{names[c[0]], names[c[1]], names[c[2]], names[c[3]]},
                           FourPlaces{&parts[c[0]], &parts[c[1]], &parts[c[2]], &parts[c[3]]});
                }
            }
            for (; done < count; ++done) parts[asked[done]] = kernel(names[asked[done]]);
        }, 1);
    };
    ask(cells.tets, systems.tets);
    ask(cells.prisms, systems.prisms);
}

/// Adds what the cells of the pattern say to the system: each row in the cells' order, so that the sums are the same to
/// the bit for any number of threads and of ranks.
void add_cells(const Pattern& pattern, const CellSystems& systems, LinearSystem& system);

}  // namespace kropla
