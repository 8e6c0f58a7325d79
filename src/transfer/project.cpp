// Projection of nodal fields.
//   [Farrell, Maddison 2011] Conservative interpolation between volume meshes by local Galerkin projection.
//   CMAME 200.
//   [Alauzet, Mehrenberger 2010] P1-conservative solution interpolation on unstructured triangular meshes.
//   IJNME 84:
//     bounds of the old cells that overlap.
// Changed: it is local to what changed; values at the rim stay, and the integral is kept by a multiplier
// instead. Values are taken relative to one of the block's own, so that a constant field stays to the bit.

#include "transfer/kept.h"
#include "transfer/limit.h"
#include "transfer/geometry.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr int most_rings = 12;         // by which a cluster grows for the sake of its bounds
constexpr double range_slack = 1e-13;  // [-] of the range of the values: beyond the bounds by rounding
constexpr double value_slack = 1e-15;  // [-] of the values themselves

/// The old field; and the values that held vertices have on the new mesh.
class OldField {
public:
    OldField(const TransferPlan& plan, NodalData values) : plan_(plan), values_(values) {}
    double operator[](Vertex v) const { return values_[v]; }
    [[nodiscard]] double held(Vertex v) const {
        if (plan_.geometry->given.empty()) return values_[v];
        const auto given = std::ranges::lower_bound(plan_.geometry->given, v, {}, &GivenVertex::vertex);
        return given != plan_.geometry->given.end() && given->vertex == v ? interpolated(*given) : values_[v];
    }
    [[nodiscard]] double interpolated(const GivenVertex& given) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += given.weights[i] * values_[given.from[i]];
        return sum;
    }

private:
    const TransferPlan& plan_;
    NodalData values_;
};

struct BlockSolution {
    double origin = 0;          // the values are relative to it
    std::vector<double> value;  // per free vertex
    double limited = 0, beyond = 0;
    bool bounded = true;
};

/// M u = right, with the integral of what the free vertices add given.
struct BlockSystem {
    std::vector<double> right;
    double integral = 0;
    ValueBounds bounds;
    double largest = 0, least = 0;  // old values
};

/// The old field's integrals over a cell with the cell's shape functions, and its bounds there.
struct OldOverCell {
    std::array<double, 4> integral{};
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    void see(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

OldOverCell old_over_cell(const TransferPlan& plan, const MassCell& cell, const OldField& old,
                          double origin) {
    OldOverCell over;
    if (cell.come >= 0) {
        for (const NodalShare& share : plan.geometry->overlaps.nodal(as_size(cell.come))) {
            const double value = old[share.from] - origin;
            over.see(value);
            for (std::size_t k = 0; k < 4; ++k) over.integral[k] += share.weight[k] * value;
        }
        return over;
    }
    std::array<double, 4> value;
    for (std::size_t k = 0; k < 4; ++k) over.see(value[k] = old[plan.after->tets[cell.tet][k]] - origin);
    const double sum = (value[0] + value[1]) + (value[2] + value[3]);
    for (std::size_t k = 0; k < 4; ++k) over.integral[k] = cell.volume / 20 * (sum + value[k]);
    return over;
}

double old_integral(const MassBlock& block, const OldField& old, double origin) {
    double sum = 0;
    for (const OldMass& cell : block.gone) {
        double values = 0;
        for (Vertex v : cell.vertices) values += old[v] - origin;
        sum += cell.volume / 4 * values;
    }
    return sum;
}

BlockSystem block_system(const TransferPlan& plan, const MassBlock& block, const OldField& old,
                         double origin) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BlockSystem system;
    system.right.assign(block.free.size(), 0);
    system.bounds.least.assign(block.free.size(), infinity);
    system.bounds.most.assign(block.free.size(), -infinity);
    system.integral = old_integral(block, old, origin);
    for (const MassCell& cell : block.cells) {
        const OldOverCell over = old_over_cell(plan, cell, old, origin);
        system.largest = std::max(system.largest, over.most);
        system.least = std::min(system.least, over.least);
        double held = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (cell.unknown[k] < 0) held += old.held(plan.after->tets[cell.tet][k]) - origin;
        system.integral -= cell.volume / 4 * held;
        for (std::size_t k = 0; k < 4; ++k) {
            if (cell.unknown[k] < 0) continue;
            const std::size_t i = as_size(cell.unknown[k]);
            system.right[i] += over.integral[k] - cell.volume / 20 * held;
            system.bounds.least[i] = std::min(system.bounds.least[i], over.least);
            system.bounds.most[i] = std::max(system.bounds.most[i], over.most);
        }
    }
    return system;
}

double integral(const MassBlock& block, const std::vector<double>& x) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += block.mass[i] * x[i];
    return sum;
}

/// Adds what the integral lacks where it changes the field least.
void reach_integral(const MassBlock& block, double wanted, std::vector<double>& x) {
    const double step = (wanted - integral(block, x)) / block.shape_mass;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * block.shape[i];
}

double excess(const ValueBounds& bounds, const std::vector<double>& x) {
    double most = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        most = std::max({most, bounds.least[i] - x[i], x[i] - bounds.most[i]});
    return most;
}

/// Into the bounds; into those of the whole block where the integral cannot be had otherwise, or beyond.
void bring_into_bounds(const MassBlock& block, const BlockSystem& system, double slack,
                       BlockSolution& solution) {
    const std::vector<double> unlimited = solution.value;
    Limited limited = limit(block, system.bounds, solution.value);
    const double mass = integral(block, std::vector<double>(solution.value.size(), 1));
    if (std::abs(limited.left) > slack * mass) {
        solution.bounded = false;
        const std::size_t n = solution.value.size();
        const ValueBounds wide{std::vector<double>(n, system.least), std::vector<double>(n, system.largest)};
        solution.value = unlimited;
        limited = limit(block, wide, solution.value);
    }
    solution.limited = limited.moved;
    reach_integral(block, system.integral, solution.value);
    solution.beyond = excess(system.bounds, solution.value);
}

BlockSolution solve_block(const TransferPlan& plan, const MassBlock& block, const OldField& old,
                          bool limited) {
    BlockSolution solution;
    if (block.free.empty() || block.gone.empty()) return solution;
    solution.origin = old[block.gone.front().vertices[0]];
    const BlockSystem system = block_system(plan, block, old, solution.origin);
    solution.value.assign(block.free.size(), 0);
    solve_mass(block, system.right, solution.value);
    reach_integral(block, system.integral, solution.value);
    const double slack =
        range_slack * (system.largest - system.least) + value_slack * std::abs(solution.origin);
    if (limited && excess(system.bounds, solution.value) > slack)
        bring_into_bounds(block, system, slack, solution);
    return solution;
}

/// Blocks with their solutions, in the order of clusters; those that cannot keep their bounds are made to
/// grow.
class Projection {
public:
    Projection(const TransferPlan& plan, NodalData values, const ProjectOptions& options)
        : plan_(plan),
          values_(values),
          old_(plan, values),
          options_(options),
          solutions_(plan.geometry->blocks.size()),
          grown_(plan.geometry->blocks.size()) {}

    /// Finds the new values; the old ones stay until `write`.
    TransferReport solve() {
        check_data();
        tbb::parallel_for(std::size_t{0}, solutions_.size(), [&](std::size_t c) {
            heed(options_.watch);
            if (!takes_part(plan_.geometry->blocks[c])) return;
            solutions_[c] = solve_block(plan_, plan_.geometry->blocks[c], old_, options_.limit);
        });
        if (std::ranges::any_of(solutions_, [](const BlockSolution& s) { return !s.bounded; })) grow();
        RegionSums sums(plan_);
        for (std::size_t c = 0; c < solutions_.size(); ++c) add(c, sums);
        sums.check();
        sums.report(report_, options_.weight);
        return report_;
    }
    void write() {
        std::vector<double> given;
        for (const GivenVertex& vertex : plan_.geometry->given) given.push_back(old_.interpolated(vertex));
        for (std::size_t i = 0; i < given.size(); ++i) values_[plan_.geometry->given[i].vertex] = given[i];
        for (std::size_t c = 0; c < solutions_.size(); ++c) {
            if (gone(c)) continue;
            const BlockSolution& s = solutions_[c];
            for (std::size_t i = 0; i < s.value.size(); ++i)
                values_[block(c).free[i]] = s.origin + s.value[i];
        }
    }

private:
    [[nodiscard]] bool takes_part(const MassBlock& block) const {
        return !options_.only.exists() || block.cells.empty() ||
               plan_.after->region[block.cells.front().tet] == options_.only;
    }
    [[nodiscard]] const MassBlock& block(std::size_t c) const {
        return grown_[c].cells.empty() ? plan_.geometry->blocks[c] : grown_[c];
    }

    void grow() {
        clusters_ = plan_.geometry->clusters;
        const SlotMap come = places_of(plan_.geometry->changed.come);
        for (std::size_t c = 0; c < solutions_.size(); ++c) {
            if (solutions_[c].bounded) continue;
            ++report_.grown;
            std::size_t now = clusters_.now(c);
            for (int ring = 0; ring < most_rings && !solutions_[now].bounded; ++ring) {
                heed(options_.watch);
                if (!clusters_.grow(*plan_.after, now)) break;
                now = clusters_.now(now);
                grown_[now] = mass_block(*plan_.before, *plan_.after, plan_.geometry->changed, come, clusters_, now);
                solutions_[now] = solve_block(plan_, grown_[now], old_, true);
            }
        }
        gone_.resize(solutions_.size());
        for (std::size_t c = 0; c < solutions_.size(); ++c) gone_[c] = clusters_.now(c) != c;
    }
    [[nodiscard]] bool gone(std::size_t c) const { return !gone_.empty() && gone_[c]; }

    void check_data() const {
        check_weights(*plan_.after, plan_.geometry->changed, options_.weight);
        const auto check = [&](Vertex v) { check_value(values_[v], "vertex", v.value); };
        for (const MassBlock& block : plan_.geometry->blocks)
            if (takes_part(block))
                for (const OldMass& cell : block.gone) std::ranges::for_each(cell.vertices, check);
        for (const GivenVertex& vertex : plan_.geometry->given) std::ranges::for_each(vertex.from, check);
    }

    void add(std::size_t c, RegionSums& sums) {
        const MassBlock& of = block(c);
        if (gone(c) || of.cells.empty() || !takes_part(of)) return;
        const BlockSolution& s = solutions_[c];
        const Region region = plan_.after->region[of.cells.front().tet];
        for (const OldMass& cell : of.gone) {
            double sum = 0, size = 0;
            for (Vertex v : cell.vertices) {
                sum += values_[v];
                size += std::abs(values_[v]);
            }
            sums.add_old(region, cell.volume / 4 * sum, cell.volume / 4 * size);
        }
        for (const MassCell& cell : of.cells) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k)
                sum += cell.unknown[k] >= 0 && !s.value.empty() ? s.origin + s.value[as_size(cell.unknown[k])]
                                                                : old_.held(plan_.after->tets[cell.tet][k]);
            sums.add_new(cell.tet, cell.volume / 4 * sum);
        }
        report_.limited = std::max(report_.limited, s.limited);
        report_.beyond = std::max(report_.beyond, s.beyond);
    }

    const TransferPlan& plan_;
    NodalData values_;
    OldField old_;
    const ProjectOptions& options_;
    std::vector<BlockSolution> solutions_;
    Clusters clusters_;             // with those that have grown; empty if none has
    std::vector<MassBlock> grown_;  // of those
    std::vector<bool> gone_;        // taken in by another
    TransferReport report_;
};

}  // namespace

TransferReport& TransferReport::operator+=(const TransferReport& other) {
    before += other.before;
    after += other.after;
    size += other.size;
    limited = std::max(limited, other.limited);
    beyond = std::max(beyond, other.beyond);
    grown += other.grown;
    return *this;
}

TransferReport project(const TransferPlan& plan, NodalData values, const ProjectOptions& options) {
    Projection projection(plan, values, options);
    const TransferReport report = projection.solve();
    projection.write();
    return report;
}

TransferReport project(const TransferPlan& plan, Array<Vertex, double>& values,
                       const ProjectOptions& options) {
    return with_all_slots(values, plan.after->position.size(),
                          [&] { return project(plan, NodalData{values.data()}, options); });
}

TransferReport project(const TransferPlan& plan, Array<Vertex, Vec3>& values, const ProjectOptions& options) {
    return with_all_slots(values, plan.after->position.size(), [&] {
        TransferReport report;
        std::vector<Projection> axes;
        for (double* first : {&values.data()->x, &values.data()->y, &values.data()->z})
            report += axes.emplace_back(plan, NodalData{first, 3}, options).solve();
        for (Projection& axis : axes) axis.write();  // all or nothing
        return report;
    });
}

}  // namespace kropla
