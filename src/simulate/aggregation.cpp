// Multigrid by smoothed aggregation, with sweeps of Gauss-Seidel: forwards before the coarser level, backwards after it.
//   [Vanek, Mandel, Brezina 1996] Algebraic multigrid by smoothed aggregation for second and fourth order elliptic
//     problems. Computing 56: strong couplings, aggregates, the smoothed prolongator.
//   [Brezina, Heberton, Mandel, Vanek 1999] An iterative method with convergence rate chosen a priori. UCD/CCM report
//     140; here the damping is row by row, by the row's sum of sizes, which bounds every eigenvalue by one.
#include "simulate/aggregation.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr double strong = 0.4;         // [-] of a row's most negative coupling: what joins two unknowns, so that those at
                                       //   the side of a prism do not. With 0.2, 0.3, 0.4, 0.5 the potential takes 21, 21,
                                       //   21, 22 iterations in cases/droplet.toml, and 192, 27, 27, 28 around twenty
                                       //   stretched prisms (heat_scale_test.cpp)
constexpr double damping = 4.0 / 3;    // [-] of a step of Jacobi: least over the upper half of the spectrum
constexpr std::size_t few_rows = 60;   // that are factored: 60^3/6 multiplications, less than one sweep above costs
constexpr std::size_t most_levels = 20;
constexpr double least_shrink = 0.8;   // [-] of the rows: what leaves more is no coarser level
constexpr double no_pivot = 1e-10;     // [-] of the diagonal: what constants leave of it, far above rounding
constexpr PetscInt none = -1;

using Matrix = Aggregation::Matrix;
using Interpolation = Aggregation::Interpolation;

/// Calls `visit(place)` for the entries of a row, but for its diagonal.
template <class Visit>
void for_each_entry(const Matrix& a, std::size_t row, const Visit& visit) {
    for (PetscInt k = a.begin[row]; k < a.begin[row + 1]; ++k) visit(static_cast<std::size_t>(k));
}

Matrix divided(const SparseRows& rows, std::span<const double> value) {
    Matrix a;
    a.column.reserve(rows.column.size());
    a.value.reserve(rows.column.size());
    for (std::size_t r = 0; r < rows.count(); ++r) {
        const auto own = static_cast<PetscInt>(r);
        a.right.push_back(0);
        a.diagonal.push_back(0);
        for (auto k = static_cast<std::size_t>(rows.begin[r]); k < static_cast<std::size_t>(rows.begin[r + 1]); ++k) {
            if (rows.column[k] == own) {
                a.diagonal[r] = value[k];
            } else if (value[k] != 0) {
                if (rows.column[k] < own) ++a.right[r];
                a.column.push_back(rows.column[k]);
                a.value.push_back(value[k]);
            }
        }
        a.right[r] += a.begin[r];
        a.begin.push_back(static_cast<PetscInt>(a.column.size()));
        if (!(a.diagonal[r] > 0)) throw SolverError("multigrid: the diagonal of a row is not positive");
    }
    return a;
}

/// Of each entry: does it join the unknowns? Only negative ones do, and those that are much less than a row's most
/// negative do not: through stretched prisms heat goes along the column, whatever its neighbours at the side look like.
std::vector<char> strong_entries(const Matrix& a) {
    std::vector<double> most(a.count(), 0.0);
    for (std::size_t r = 0; r < a.count(); ++r)
        for_each_entry(a, r, [&](std::size_t k) { most[r] = std::max(most[r], -a.value[k]); });
    std::vector<char> is(a.value.size(), 0);
    for (std::size_t r = 0; r < a.count(); ++r) {
        const double mine = strong * strong * most[r];
        for_each_entry(a, r, [&](std::size_t k) {
            is[k] = a.value[k] < 0 && a.value[k] * a.value[k] > mine * most[static_cast<std::size_t>(a.column[k])];
        });
    }
    return is;
}

/// The aggregate of each unknown; `none` of those that no strong entry joins to another.
struct Aggregates {
    std::vector<PetscInt> of;
    PetscInt count = 0;
};

/// First those around unknowns that have all their neighbours to themselves; what is left goes to the aggregate it is
/// joined to most strongly; what is left then makes its own.
Aggregates aggregates(const Matrix& a, const std::vector<char>& is_strong) {
    Aggregates made{std::vector<PetscInt>(a.count(), none), 0};
    const auto for_each_strong = [&](std::size_t r, const auto& visit) {
        for_each_entry(a, r, [&](std::size_t k) {
            if (is_strong[k] != 0) visit(static_cast<std::size_t>(a.column[k]), std::abs(a.value[k]));
        });
    };
    for (std::size_t r = 0; r < a.count(); ++r) {
        bool free = made.of[r] == none, joined = false;
        for_each_strong(r, [&](std::size_t c, double) {
            joined = true;
            free = free && made.of[c] == none;
        });
        if (!free || !joined) continue;
        made.of[r] = made.count;
        for_each_strong(r, [&](std::size_t c, double) { made.of[c] = made.count; });
        ++made.count;
    }
    const std::vector<PetscInt> first = made.of;
    for (std::size_t r = 0; r < a.count(); ++r) {
        if (first[r] != none) continue;
        double most = 0;
        for_each_strong(r, [&](std::size_t c, double size) {
            if (first[c] == none || size <= most) return;
            most = size;
            made.of[r] = first[c];
        });
    }
    for (std::size_t r = 0; r < a.count(); ++r) {
        if (made.of[r] != none) continue;
        bool joined = false;
        for_each_strong(r, [&](std::size_t c, double) {
            joined = true;
            if (made.of[c] == none) made.of[c] = made.count;
        });
        if (joined) made.of[r] = made.count++;
    }
    return made;
}

/// A row under construction: entries by their column.
class Row {
public:
    explicit Row(std::size_t columns) : last_met_(columns, none), sum_(columns), met_(columns) {}

    void add(PetscInt column, double value) {
        const auto c = static_cast<std::size_t>(column);
        if (last_met_[c] == row_) {
            sum_[c] += value;
            return;
        }
        last_met_[c] = row_;
        sum_[c] = value;
        met_[count_++] = column;
    }
    /// Visits what there is, and begins the next row.
    template <class Visit>
    void take(const Visit& visit) {
        for (std::size_t k = 0; k < count_; ++k) visit(met_[k], sum_[static_cast<std::size_t>(met_[k])]);
        count_ = 0;
        ++row_;
    }

private:
    PetscInt row_ = 0;
    std::vector<PetscInt> last_met_;  // of each column: in which row
    std::vector<double> sum_;         // of each column
    std::vector<PetscInt> met_;       // in this row, the first `count_`
    std::size_t count_ = 0;
};

/// The constants of aggregates after a damped step of Jacobi's method with what is strong; the weak is added to the
/// diagonal, so that constants stay.
Interpolation smoothed(const Matrix& a, const std::vector<char>& is_strong, const Aggregates& to) {
    Interpolation p;
    Row row(static_cast<std::size_t>(to.count));
    const auto end_row = [&] {
        row.take([&](PetscInt column, double value) {
            p.column.push_back(column);
            p.value.push_back(value);
        });
        p.begin.push_back(static_cast<PetscInt>(p.column.size()));
    };
    for (std::size_t r = 0; r < a.count(); ++r) {
        if (to.of[r] != none) {
            double diagonal = a.diagonal[r], others = 0;
            for_each_entry(a, r, [&](std::size_t k) {
                if (is_strong[k] == 0) diagonal += a.value[k];
                else others += std::abs(a.value[k]);
            });
            const double step = damping / (std::abs(diagonal) + others);
            row.add(to.of[r], 1 - step * diagonal);
            for_each_entry(a, r, [&](std::size_t k) {
                if (is_strong[k] != 0) row.add(to.of[static_cast<std::size_t>(a.column[k])], -step * a.value[k]);
            });
        }
        end_row();
    }
    return p;
}

/// Calls `visit(place)` for the entries of a row.
template <class Visit>
void for_each_entry(const Interpolation& p, std::size_t row, const Visit& visit) {
    for (PetscInt k = p.begin[row]; k < p.begin[row + 1]; ++k) visit(static_cast<std::size_t>(k));
}

/// A P.
Interpolation product(const Matrix& a, const Interpolation& p, PetscInt columns) {
    Interpolation ap;
    Row row(static_cast<std::size_t>(columns));
    for (std::size_t r = 0; r < a.count(); ++r) {
        const auto add = [&](std::size_t from, double times) {
            for_each_entry(p, from, [&](std::size_t k) { row.add(p.column[k], times * p.value[k]); });
        };
        add(r, a.diagonal[r]);
        for_each_entry(a, r, [&](std::size_t k) { add(static_cast<std::size_t>(a.column[k]), a.value[k]); });
        row.take([&](PetscInt column, double value) {
            ap.column.push_back(column);
            ap.value.push_back(value);
        });
        ap.begin.push_back(static_cast<PetscInt>(ap.column.size()));
    }
    return ap;
}

Interpolation transposed(const Interpolation& p, PetscInt columns) {
    Interpolation t{std::vector<PetscInt>(static_cast<std::size_t>(columns) + 1, 0), std::vector<PetscInt>(p.column.size()),
                    std::vector<double>(p.value.size())};
    for (PetscInt column : p.column) ++t.begin[static_cast<std::size_t>(column) + 1];
    for (std::size_t c = 0; c + 1 < t.begin.size(); ++c) t.begin[c + 1] += t.begin[c];
    std::vector<PetscInt> next(t.begin.begin(), t.begin.end() - 1);
    for (std::size_t r = 0; r + 1 < p.begin.size(); ++r) {
        for_each_entry(p, r, [&](std::size_t k) {
            const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(p.column[k])]++);
            t.column[place] = static_cast<PetscInt>(r);
            t.value[place] = p.value[k];
        });
    }
    return t;
}

/// P^T A P.
Matrix coarser(const Matrix& a, const Interpolation& p, PetscInt columns) {
    const Interpolation ap = product(a, p, columns), t = transposed(p, columns);
    Matrix c;
    Row row(static_cast<std::size_t>(columns));
    std::vector<std::pair<PetscInt, double>> right;
    for (std::size_t r = 0; r < static_cast<std::size_t>(columns); ++r) {
        for_each_entry(t, r, [&](std::size_t k) {
            for_each_entry(ap, static_cast<std::size_t>(t.column[k]),
                           [&](std::size_t j) { row.add(ap.column[j], t.value[k] * ap.value[j]); });
        });
        right.clear();
        c.diagonal.push_back(0);
        row.take([&](PetscInt column, double value) {
            if (column == static_cast<PetscInt>(r)) {
                c.diagonal[r] = value;
            } else if (column > static_cast<PetscInt>(r)) {
                right.emplace_back(column, value);
            } else {
                c.column.push_back(column);
                c.value.push_back(value);
            }
        });
        c.right.push_back(static_cast<PetscInt>(c.column.size()));
        for (const auto& [column, value] : right) {
            c.column.push_back(column);
            c.value.push_back(value);
        }
        c.begin.push_back(static_cast<PetscInt>(c.column.size()));
    }
    return c;
}

/// The sum over entries from `k` up to `end`.
[[gnu::always_inline]] inline double sum_of(const Matrix& a, PetscInt k, PetscInt end, const double* x) {
    const PetscInt* const column = a.column.data();
    const double* const value = a.value.data();
    double even = 0, odd = 0;  // two sums, so that neither has to wait for the other
    for (; k + 1 < end; k += 2) {
        even += value[k] * x[column[k]];
        odd += value[k + 1] * x[column[k + 1]];
    }
    if (k < end) even += value[k] * x[column[k]];
    return even + odd;
}

}  // namespace

Aggregation::Aggregation(const SparseRows& rows, std::span<const double> value) {
    levels_.push_back({divided(rows, value), {}, {}, {}, {}});
    while (levels_.back().matrix.count() > few_rows && levels_.size() < most_levels) {
        Level& fine = levels_.back();
        const std::vector<char> is_strong = strong_entries(fine.matrix);
        const Aggregates made = aggregates(fine.matrix, is_strong);
        const auto count = static_cast<double>(made.count);
        if (made.count == 0 || count > least_shrink * static_cast<double>(fine.matrix.count())) break;
        fine.from_coarser = smoothed(fine.matrix, is_strong, made);
        Matrix coarse = coarser(fine.matrix, fine.from_coarser, made.count);
        levels_.push_back({std::move(coarse), {}, {}, std::vector<double>(static_cast<std::size_t>(made.count)),
                           std::vector<double>(static_cast<std::size_t>(made.count))});
        }
    for (Level& level : levels_)
        for (double diagonal : level.matrix.diagonal) level.inverse.push_back(diagonal > 0 ? 1 / diagonal : 0);
    if (levels_.back().matrix.count() <= few_rows) factor_coarsest();
}

double Aggregation::complexity() const {
    double entries = 0;
    for (const Level& level : levels_) entries += static_cast<double>(level.matrix.value.size() + level.matrix.count());
    return entries / static_cast<double>(levels_.front().matrix.value.size() + levels_.front().matrix.count());
}

/// Cholesky's factor. Where constants are in the kernel, the last pivot is lost in rounding: that unknown is then zero.
void Aggregation::factor_coarsest() {
    const Matrix& a = levels_.back().matrix;
    const std::size_t n = a.count();
    factor_.assign(n * n, 0.0);
    for (std::size_t r = 0; r < n; ++r) {
        for_each_entry(a, r, [&](std::size_t k) { factor_[r * n + static_cast<std::size_t>(a.column[k])] = a.value[k]; });
        for (std::size_t c = 0; c < r; ++c) {
            double sum = factor_[r * n + c];
            for (std::size_t k = 0; k < c; ++k) sum -= factor_[r * n + k] * factor_[c * n + k];
            const double pivot = factor_[c * n + c];
            factor_[r * n + c] = pivot > 0 ? sum / pivot : 0;
        }
        double pivot = a.diagonal[r];
        for (std::size_t k = 0; k < r; ++k) pivot -= factor_[r * n + k] * factor_[r * n + k];
        factor_[r * n + r] = pivot > no_pivot * a.diagonal[r] ? std::sqrt(pivot) : 0;
    }
}

void Aggregation::solve_coarsest(std::span<const double> rest, std::span<double> found) const {
    const std::size_t n = found.size();
    for (std::size_t r = 0; r < n; ++r) {
        double sum = rest[r];
        for (std::size_t k = 0; k < r; ++k) sum -= factor_[r * n + k] * found[k];
        const double pivot = factor_[r * n + r];
        found[r] = pivot > 0 ? sum / pivot : 0;
    }
    for (std::size_t r = n; r-- > 0;) {
        const double pivot = factor_[r * n + r];
        found[r] = pivot > 0 ? found[r] / pivot : 0;
        for (std::size_t k = 0; k < r; ++k) found[k] -= factor_[r * n + k] * found[r];
    }
}

void Aggregation::correct(std::span<const double> residual, std::span<double> correction) {
    cycle(0, residual, correction);
}

void Aggregation::cycle(std::size_t at, std::span<const double> rest, std::span<double> found) {
    const Level& level = levels_[at];
    const bool coarsest = at + 1 == levels_.size();
    if (coarsest && !factor_.empty()) {
        solve_coarsest(rest, found);
        return;
    }
    const Matrix& a = level.matrix;
    const std::size_t n = a.count();
    for (std::size_t r = 0; r < n; ++r)  // from zero: nothing is right of the diagonal yet
        found[r] = (rest[r] - sum_of(a, a.begin[r], a.right[r], found.data())) * level.inverse[r];
    if (!coarsest) {
        const Interpolation& p = level.from_coarser;
        Level& coarse = levels_[at + 1];
        std::ranges::fill(coarse.rest, 0.0);
        for (std::size_t r = 0; r < n; ++r) {  // what is left now is what came in from the right since
            const double left = -sum_of(a, a.right[r], a.begin[r + 1], found.data());
            for_each_entry(p, r, [&](std::size_t k) {
                coarse.rest[static_cast<std::size_t>(p.column[k])] += p.value[k] * left;
            });
        }
        cycle(at + 1, coarse.rest, coarse.found);
        for (std::size_t r = 0; r < n; ++r)
            for_each_entry(p, r, [&](std::size_t k) {
                found[r] += p.value[k] * coarse.found[static_cast<std::size_t>(p.column[k])];
            });
    }
    for (std::size_t r = n; r-- > 0;)
        found[r] = (rest[r] - sum_of(a, a.begin[r], a.begin[r + 1], found.data())) * level.inverse[r];
}

}  // namespace kropla
