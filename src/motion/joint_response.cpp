#include "motion/joint_response.h"

#include "motion/facing.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// Rates of turning count by a length, so that both halves weigh alike.
double weight(const RigidStep& step, std::size_t component) { return component < 3 ? 1 : step.length(); }

/// The x of a x = b, rows of n numbers; as `solved`.
std::vector<double> solved_rows(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double share = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= share * a[k][j];
            b[i] -= share * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

}  // namespace

JointResponse::JointResponse(const Domain& domain, const FreeSteps& bodies) : near_(bodies.size()) {
    const auto shape = [&](std::size_t i) {
        return placed(domain.bodies[bodies[i].first].shape, bodies[i].second.begin().pose);
    };
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = 0; j < bodies.size(); ++j)
            if (i != j && least_gap_between(shape(i), shape(j)) < std::min(outer_radius(shape(i)), outer_radius(shape(j))))
                near_[i].push_back({.other = j});
    std::vector<bool> known(bodies.size(), false);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (known[i]) continue;
        std::vector<std::size_t> group = {i};
        known[i] = true;
        for (std::size_t k = 0; k < group.size(); ++k) {
            for (const Near& near : near_[group[k]]) {
                if (known[near.other]) continue;
                known[near.other] = true;
                group.push_back(near.other);
            }
        }
        groups_.push_back(std::move(group));
    }
}

SixMatrix JointResponse::block(const FreeSteps& bodies, std::size_t row, std::size_t column, bool of_flow) const {
    if (row == column) return bodies[row].second.resistance(of_flow);
    const auto near = std::ranges::find(near_[row], column, &Near::other);
    if (!of_flow || near == near_[row].end()) return {};
    SixMatrix found = near->response;
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            found[i][j] *= bodies[row].second.freedom()[i] * bodies[column].second.freedom()[j];
    return found;
}

std::vector<SixVector> JointResponse::taken(const FreeSteps& bodies, const std::vector<SixVector>& change, bool of_flow) const {
    std::vector<SixVector> found(bodies.size(), SixVector{});
    for (std::size_t row = 0; row < bodies.size(); ++row) {
        const auto add = [&](std::size_t column) {
            const SixMatrix part = block(bodies, row, column, of_flow);
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j) found[row][i] += part[i][j] * change[column][j];
        };
        add(row);
        for (const Near& near : near_[row]) add(near.other);
    }
    return found;
}

std::vector<SixVector> JointResponse::solved_for(const FreeSteps& bodies, const std::vector<SixVector>& wrenches,
                                                 bool of_flow) const {
    std::vector<SixVector> found(bodies.size(), SixVector{});
    for (const std::vector<std::size_t>& group : groups_) {
        if (std::ranges::all_of(group, [&](std::size_t body) { return wrenches[body] == SixVector{}; })) continue;
        const std::size_t n = 6 * group.size();
        std::vector<std::vector<double>> rows(n, std::vector<double>(n));
        std::vector<double> right(n);
        for (std::size_t k = 0; k < n; ++k) right[k] = wrenches[group[k / 6]][k % 6];
        for (std::size_t a = 0; a < group.size(); ++a) {
            for (std::size_t b = 0; b < group.size(); ++b) {
                const SixMatrix part = block(bodies, group[a], group[b], of_flow);
                for (std::size_t i = 0; i < 6; ++i)
                    for (std::size_t j = 0; j < 6; ++j) rows[6 * a + i][6 * b + j] = part[i][j];
            }
        }
        const std::vector<double> solution = solved_rows(std::move(rows), std::move(right));
        for (std::size_t k = 0; k < n; ++k) found[group[k / 6]][k % 6] = solution[k];
    }
    return found;
}

void JointResponse::learn(FreeSteps& bodies) {
    if (last_rates_.empty()) return;
    std::vector<SixVector> change(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t k = 0; k < 6; ++k) change[i][k] = bodies[i].second.rate()[k] - last_rates_[i][k];
    const std::vector<SixVector> expected = taken(bodies, change, true);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        bool tells = tells_[i];
        std::vector<std::size_t> columns = {i};
        for (const Near& near : near_[i]) {
            columns.push_back(near.other);
            tells = tells && tells_[near.other];
        }
        double square = 0;
        for (const std::size_t j : columns)
            for (std::size_t k = 0; k < 6; ++k) square += std::pow(weight(bodies[j].second, k) * change[j][k], 2);
        if (!tells || !(square > 0)) continue;
        RigidStep& step = bodies[i].second;
        const auto learnt = [&](SixMatrix response, std::size_t j) {
            for (std::size_t row = 0; row < 6; ++row) {
                const double seen = last_left_[i][row] - step.left()[row] - expected[i][row];
                for (std::size_t k = 0; k < 6; ++k)
                    response[row][k] += step.freedom()[row] * seen * std::pow(weight(bodies[j].second, k), 2) * change[j][k] / square;
            }
            return response;
        };
        step.know(learnt(step.begin().response, i));
        for (Near& near : near_[i]) near.response = learnt(near.response, near.other);
    }
}

void JointResponse::remember(const FreeSteps& bodies, const std::vector<SixVector>& rates, const std::vector<SixVector>& leaps) {
    constexpr double same = 1e-2;  // [-] of the change of the rate: what a change of the leap leaves to be learnt from
    last_rates_.clear();
    last_left_.clear();
    tells_.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const RigidStep& step = bodies[i].second;
        double rate_change = 0, leap_change = 0;
        for (std::size_t k = 0; k < 6; ++k) {
            rate_change = std::max(rate_change, weight(step, k) * std::abs(rates[i][k] - step.rate()[k]) * step.dt());
            leap_change = std::max(leap_change, weight(step, k) * std::abs(leaps[i][k] - step.leap()[k]));
        }
        last_rates_.push_back(step.rate());
        last_left_.push_back(step.left());
        tells_.push_back(leap_change <= same * rate_change);
    }
}

}  // namespace kropla
