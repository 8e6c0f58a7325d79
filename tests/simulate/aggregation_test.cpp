// Multigrid by smoothed aggregation, on the seven-point Laplacian of a cube of vertices.
#include "simulate/aggregation.h"

#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

struct Problem {
    SparseRows rows = {};
    std::vector<double> value = {};
};

/// Rows sum to zero. Along z vertices are bound `stretch` times as tightly.
Problem laplacian(int side, double stretch) {
    Problem problem;
    const auto inside = [&](int i) { return i >= 0 && i < side; };
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                constexpr std::array<std::array<int, 3>, 7> steps = {
                    {{0, 0, -1}, {0, -1, 0}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
                std::size_t own = 0;
                double sum = 0;
                for (const auto& [dx, dy, dz] : steps) {
                    if (!inside(x + dx) || !inside(y + dy) || !inside(z + dz)) continue;
                    const bool is_own = dx == 0 && dy == 0 && dz == 0;
                    if (is_own) own = problem.value.size();
                    const double bound = is_own ? 0 : dz != 0 ? stretch : 1;
                    sum += bound;
                    problem.rows.column.push_back(((z + dz) * side + y + dy) * side + x + dx);
                    problem.value.push_back(-bound);
                }
                problem.value[own] = sum;
                problem.rows.begin.push_back(static_cast<PetscInt>(problem.rows.column.size()));
            }
        }
    }
    return problem;
}

std::vector<double> times(const Problem& a, const std::vector<double>& x) {
    std::vector<double> product(x.size(), 0.0);
    for (std::size_t r = 0; r < x.size(); ++r)
        for (auto k = static_cast<std::size_t>(a.rows.begin[r]); k < static_cast<std::size_t>(a.rows.begin[r + 1]); ++k)
            product[r] += a.value[k] * x[static_cast<std::size_t>(a.rows.column[k])];
    return product;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Any vector whose entries sum to zero.
std::vector<double> any_vector(std::size_t count, double phase) {
    std::vector<double> x(count);
    for (std::size_t r = 0; r < count; ++r) x[r] = std::sin(phase + 1.7 * static_cast<double>(r));
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(count);
    for (double& value : x) value -= mean;
    return x;
}

TEST(Aggregation, IsSymmetricAndPositive) {
    const Problem a = laplacian(12, 1);
    Aggregation cycle(a.rows, a.value);
    EXPECT_GT(cycle.levels(), 1u);
    EXPECT_LT(cycle.complexity(), 2);
    const std::vector<double> x = any_vector(a.rows.count(), 0), y = any_vector(a.rows.count(), 1);
    std::vector<double> of_x(x.size()), of_y(y.size());
    cycle.correct(x, of_x);
    cycle.correct(y, of_y);
    EXPECT_NEAR(product(x, of_y), product(y, of_x), 1e-12 * std::abs(product(x, of_x)));
    EXPECT_GT(product(x, of_x), 0);
}

// Also where couplings differ by 10^4: a cycle alone, without conjugate gradients, takes a fixed share of the error.
TEST(Aggregation, LeavesLessWithEachCycle) {
    for (const double stretch : {1.0, 1e4}) {
        SCOPED_TRACE(stretch);
        const Problem a = laplacian(12, stretch);
        Aggregation cycle(a.rows, a.value);
        std::vector<double> rest = any_vector(a.rows.count(), 0), correction(rest.size());
        double energy = INFINITY, first = 0;
        for (int k = 0; k < 40; ++k) {
            cycle.correct(rest, correction);
            const double left = product(rest, correction);
            if (k > 3) {
                EXPECT_LT(left, 0.6 * energy);
            }
            energy = left;
            if (k == 0) first = left;
            if (energy < 1e-16 * first) break;  // eight digits of the error, well above rounding
            const std::vector<double> taken = times(a, correction);
            for (std::size_t r = 0; r < rest.size(); ++r) rest[r] -= taken[r];
        }
        EXPECT_LT(energy, 1e-16 * first);
    }
}

TEST(Aggregation, RefusesADiagonalThatIsNotPositive) {
    Problem a = laplacian(3, 1);
    a.value[0] = -1;
    EXPECT_THROW(Aggregation(a.rows, a.value), SolverError);
}

}  // namespace
}  // namespace kropla
