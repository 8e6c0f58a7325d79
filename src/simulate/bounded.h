#pragma once

#include "simulate/assembly.h"

#include <cmath>
#include <vector>

namespace kropla {

// Bounds for what is carried and diffused, kept by looking afterwards, in two ways.
//
// *Lower order.* A system of high order is solved; a row whose value is noticeably a new extremum, beyond the old values
// around it and the new ones beside it, is marked, and with it those near it; the cells at marked rows are assembled
// anew in low order (masses lumped, nothing upwinded by residuals), and every coupling of a marked row that has the wrong
// sign is cancelled by as much diffusion along its edge. In a row made so, the value is a mean of old and new values
// around it with positive weights: no new extremum, at any length of step. Diffusion along edges, and cells of one order
// or the other, keep what is conserved, and constants. It ends when no row is marked any more, at the latest when all are.
//
// *Repair.* What then still lies beyond the bounds of all values is brought back to them, and what this takes comes from
// its neighbours, from each as much as it has beyond the bound, in proportion; from all others what they do not have.
//
//   [Clain, Diot, Loubere 2011] A high-order finite volume method for systems of conservation laws - multi-dimensional
//     optimal order detection (MOOD). J. Comput. Phys. 230: look afterwards, lower the order there, do it again.
//   [Kuzmin, Turek 2002] Flux correction tools for finite elements. J. Comput. Phys. 175: the diffusion along edges.
//   [Shashkov, Wendroff 2004] The repair paradigm and application to conservation laws. J. Comput. Phys. 198.
// Against flux correction by limiters: no second field of low order is solved for where nothing is wrong, and what
// implicit diffusion moves through many cells in one step is not cut off by a bound that looks at one.

/// What a value may be besides a mean of the old and new values around it, per owned row.
struct Allowance {
    explicit Allowance(std::size_t rows)
        : least(rows, INFINITY), most(rows, -INFINITY), below(rows, 0.0), above(rows, 0.0), fixed(rows, 0) {}

    std::vector<double> least, most;   // of the mean, too, are values from outside
    std::vector<double> below, above;  // by so much beyond any mean
    std::vector<char> fixed;           // these are not looked at
};

/// Adds to the edges of marked rows (all rows, by number) the least diffusion that leaves no coupling of the wrong sign,
/// and returns it: a place for each coupling of the pattern's rows.
std::vector<double> add_diffusion(const Pattern& pattern, const CellSystems& systems, const std::vector<char>& marked,
                                  LinearSystem& system);

/// Marks the rows, of all ranks, whose new value is a new extremum by more than `negligible`, and those up to two
/// couplings away. Returns whether any was marked that had not been; all ranks are told the same.
[[nodiscard]] bool mark_extrema(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& before,
                                const std::vector<double>& after, const Allowance& allowance, double negligible,
                                std::vector<char>& marked);

/// Marks these rows, known on the rank that owns them at least, and those up to two couplings away. Returns as above.
[[nodiscard]] bool mark_with_those_near(const Ranks& ranks, const Pattern& pattern, std::vector<char> rows,
                                        std::vector<char>& marked);

/// What is exchanged along couplings, for the rows of this rank.
struct Repair {
    std::vector<double> gained;  // a place for each coupling: what its row gets from its column
    double spread = 0;           // [-] of what each row had beyond the bound, that went to rows that had no such neighbour
};

/// Brings values (of all rows) back to at least `bound`, or at most if `side` is -1. `capacity`, of all rows, says how
/// much a row holds per unit of its value; zero for rows that are left alone.
Repair repair(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& capacity, double bound, double side,
              std::vector<double>& values);

}  // namespace kropla
