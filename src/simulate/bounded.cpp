#include "simulate/bounded.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

template <std::size_t n>
void add_couplings(std::size_t row, const CellsAtRows<n>& at, const std::vector<CellSystem<n>>& systems,
                   std::vector<double>& to_me, std::vector<double>& from_me) {
    for (const CellAtRow<n>& cell : at.of(row)) {
        for (std::size_t j = 0; j < n; ++j) {
            to_me[cell.place[j]] += systems[cell.cell].matrix[cell.corner][j];
            from_me[cell.place[j]] += systems[cell.cell].matrix[j][cell.corner];
        }
    }
}

struct Range {
    double least = INFINITY, most = -INFINITY;
    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

std::span<const PetscInt> columns_of(const SparseRows& rows, std::size_t row) {
    const auto begin = static_cast<std::size_t>(rows.begin[row]), end = static_cast<std::size_t>(rows.begin[row + 1]);
    return std::span(rows.column).subspan(begin, end - begin);
}

/// Calls `visit(row, column, place)`, by number, for the couplings of the rank's rows, but of none with itself.
template <class Visit>
void for_each_owned(const SparseRows& rows, const Visit& visit) {
    for (std::size_t row = 0; row < rows.count(); ++row) {
        const auto own = static_cast<std::size_t>(rows.first_row) + row;
        for (auto k = static_cast<std::size_t>(rows.begin[row]); k < static_cast<std::size_t>(rows.begin[row + 1]); ++k)
            if (const auto c = static_cast<std::size_t>(rows.column[k]); c != own) visit(own, c, k);
    }
}

/// Those that are coupled to one that is chosen are chosen, too.
void spread(const SparseRows& rows, std::vector<char>& chosen) {
    const std::vector<char> before = chosen;
    for_each_owned(rows, [&](std::size_t own, std::size_t c, std::size_t) { chosen[own] |= before[c]; });
}

}  // namespace

std::vector<double> add_diffusion(const Pattern& pattern, const CellSystems& systems, const std::vector<char>& marked,
                                  LinearSystem& system) {
    const SparseRows& rows = pattern.rows;
    std::vector<double> diffusion(rows.column.size(), 0.0);
    for_all(rows.count(), [&](std::size_t row) {
        const auto begin = static_cast<std::size_t>(rows.begin[row]), end = static_cast<std::size_t>(rows.begin[row + 1]);
        const int own = rows.first_row + static_cast<int>(row);
        const auto concerned = [&](std::size_t k) {
            return rows.column[k] != own && (marked[static_cast<std::size_t>(own)] != 0 ||
                                             marked[static_cast<std::size_t>(rows.column[k])] != 0);
        };
        bool any = false;
        for (std::size_t k = begin; k < end; ++k) any = any || concerned(k);
        if (!any) return;
        std::vector<double> to_me(end - begin, 0.0), from_me(end - begin, 0.0);
        add_couplings(row, pattern.tets, systems.tets, to_me, from_me);
        add_couplings(row, pattern.prisms, systems.prisms, to_me, from_me);
        for (std::size_t k = begin; k < end; ++k) {
            if (!concerned(k)) continue;
            diffusion[k] = std::max({0.0, to_me[k - begin], from_me[k - begin]});
            system.value[k] -= diffusion[k];
        }
    });
    return diffusion;
}

bool mark_extrema(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& before,
                  const std::vector<double>& after, const Allowance& allowance, double negligible,
                  std::vector<char>& marked) {
    const SparseRows& rows = pattern.rows;
    std::vector<char> next(marked.size(), 0);
    for (std::size_t row = 0; row < rows.count(); ++row) {
        if (allowance.fixed[row] != 0) continue;
        const auto own = static_cast<std::size_t>(rows.first_row) + row;
        Range around;
        around.add(before[own]);
        around.least = std::min(around.least, allowance.least[row]);
        around.most = std::max(around.most, allowance.most[row]);
        for (PetscInt column : columns_of(rows, row)) {
            const auto c = static_cast<std::size_t>(column);
            around.add(before[c]);
            if (c != own) around.add(after[c]);
        }
        if (after[own] < around.least - allowance.below[row] - negligible ||
            after[own] > around.most + allowance.above[row] + negligible)
            next[own] = 1;
    }
    return mark_with_those_near(ranks, pattern, std::move(next), marked);
}

bool mark_with_those_near(const Ranks& ranks, const Pattern& pattern, std::vector<char> rows, std::vector<char>& marked) {
    const auto of_all_ranks = [&] {
        MPI_Allreduce(MPI_IN_PLACE, rows.data(), static_cast<int>(rows.size()), MPI_CHAR, MPI_MAX, ranks.communicator);
    };
    for (int ring = 0; ring < 2; ++ring) {
        of_all_ranks();
        spread(pattern.rows, rows);
    }
    of_all_ranks();
    bool any = false;
    for (std::size_t r = 0; r < marked.size(); ++r) {
        any = any || (rows[r] != 0 && marked[r] == 0);
        marked[r] = marked[r] != 0 || rows[r] != 0;
    }
    return any;
}

Repair repair(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& capacity, double bound, double side,
              std::vector<double>& values) {
    const SparseRows& rows = pattern.rows;
    const std::size_t all = values.size();
    Repair done{std::vector<double>(rows.column.size(), 0.0), 0};
    std::vector<double> room(all);  // what a row holds beyond the bound; what it lacks if negative
    double lacking = 0;
    for (std::size_t r = 0; r < all; ++r) {
        room[r] = side * (values[r] - bound) * capacity[r];
        lacking += std::min(room[r], 0.0);
    }
    if (lacking == 0) return done;

    std::vector<double> beside(all, 0.0);  // what the neighbours of a row that lacks something have
    std::vector<double> asked(all, 0.0);   // of a row that has, by its neighbours
    for_each_owned(rows, [&](std::size_t own, std::size_t c, std::size_t) {
        if (room[own] < 0) beside[own] += std::max(room[c], 0.0);
    });
    MPI_Allreduce(MPI_IN_PLACE, beside.data(), static_cast<int>(all), MPI_DOUBLE, MPI_SUM, ranks.communicator);
    const auto wish = [&](std::size_t lacks, std::size_t has) {  // what one asks of the other
        return room[lacks] < 0 && room[has] > 0 ? std::min(-room[lacks] / beside[lacks], 1.0) * room[has] : 0.0;
    };
    for_each_owned(rows, [&](std::size_t own, std::size_t c, std::size_t) { asked[own] += wish(c, own); });
    MPI_Allreduce(MPI_IN_PLACE, asked.data(), static_cast<int>(all), MPI_DOUBLE, MPI_SUM, ranks.communicator);
    const auto given = [&](std::size_t lacks, std::size_t has) {
        const double wanted = wish(lacks, has);
        return wanted > 0 ? wanted * std::min(1.0, room[has] / asked[has]) : 0.0;
    };
    std::vector<double> got(all, 0.0);
    for_each_owned(rows, [&](std::size_t own, std::size_t c, std::size_t place) {
        const double gain = given(own, c) - given(c, own);
        got[own] += gain;
        done.gained[place] = side * gain;
    });
    MPI_Allreduce(MPI_IN_PLACE, got.data(), static_cast<int>(all), MPI_DOUBLE, MPI_SUM, ranks.communicator);

    double left = 0, had = 0;  // what is lacking still, and what there is to take it from
    for (std::size_t r = 0; r < all; ++r) {
        room[r] += got[r];
        (room[r] < 0 ? left : had) += std::abs(room[r]);
    }
    done.spread = had > 0 ? std::min(1.0, left / had) : 0;
    for (std::size_t r = 0; r < all; ++r)
        if (capacity[r] > 0) values[r] = bound + side * std::max(room[r], 0.0) * (1 - done.spread) / capacity[r];
    return done;
}

}  // namespace kropla
