// Maximal random samples with a spacing that varies.
//
// After [Ebeida, Mitchell, Patney, Davidson, Owens 2012, "A simple algorithm for maximal Poisson-disk
// sampling in high dimensions"]: cells that are not yet covered are thrown at, then those left are split,
// until none is left. Changed: the spacing varies in space, so the first cells are the leaves of an octree as
// fine as the spacing asks, and a cell counts as covered with what the slope of the spacing takes away. A
// room may be flat: its cells split within it.

#include "generate/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace kropla {

namespace {

std::uint64_t slot_hash(int level, std::int64_t i, std::int64_t j, std::int64_t k) {
    const auto mixed = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL ^
                       static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL ^
                       static_cast<std::uint64_t>(k) * 0x165667B19E3779F9ULL ^
                       static_cast<std::uint64_t>(level) * 0xD6E8FEB86659FD93ULL;
    return mixed ^ (mixed >> 29);
}

/// Points whose spacing is in [2^level, 2^(level + 1)) are filed in cells of the upper bound's width.
double cell_width(int level) { return std::ldexp(1.0, level + 1); }

std::int64_t cell_number(double x, double width) { return static_cast<std::int64_t>(std::floor(x / width)); }

}  // namespace

void PointGrid::insert(const Vec3& x, double spacing) {
    const int level = std::ilogb(spacing);
    auto at = std::ranges::find_if(levels_, [&](const Level& l) { return l.level <= level; });
    if (at == levels_.end() || at->level != level) at = levels_.insert(at, {level, {}});
    at->held.take_in(x);
    entries_.push_back({x, level, -1});
    if (entries_.size() <= slots_.size()) return file(static_cast<std::int32_t>(entries_.size() - 1));
    slots_.assign(2 * slots_.size(), -1);
    for (std::size_t i = 0; i < entries_.size(); ++i) file(static_cast<std::int32_t>(i));
}

void PointGrid::file(std::int32_t entry) {
    Entry& e = entries_[static_cast<std::size_t>(entry)];
    const double width = cell_width(e.level);
    const std::uint64_t hash = slot_hash(e.level, cell_number(e.place.x, width),
                                         cell_number(e.place.y, width), cell_number(e.place.z, width));
    std::int32_t& slot = slots_[hash & (slots_.size() - 1)];
    e.next = std::exchange(slot, entry);
}

template <class Visit>
bool PointGrid::visit_within(const Vec3& x, double radius, double least, double greatest, const Visit& visit) const {
    if (!(radius > 0)) return false;
    const int lowest = least > 0 ? std::ilogb(least) : std::numeric_limits<int>::min(), highest = std::ilogb(greatest);
    return std::ranges::any_of(levels_, [&](const Level& at) {
        return at.level >= lowest && at.level <= highest && visit_within_at(at, x, radius, visit);
    });
}

template <class Visit>
bool PointGrid::visit_within_at(const Level& at, const Vec3& x, double radius, const Visit& visit) const {
    const int level = at.level;
    const double width = cell_width(level), squared = radius * radius;
    std::array<std::int64_t, 3> first = {}, last = {};
    for (int axis = 0; axis < 3; ++axis) {
        first[static_cast<std::size_t>(axis)] = cell_number(std::max(x[axis] - radius, at.held.min[axis]), width);
        last[static_cast<std::size_t>(axis)] = cell_number(std::min(x[axis] + radius, at.held.max[axis]), width);
    }
    const auto squared_gap = [&](int axis, std::int64_t cell) {
        constexpr double rounding = 1e-9;  // [-] of the width
        const double begin = static_cast<double>(cell) * width - x[axis];
        const double gap = std::max({begin, -begin - width, 0.0}) - rounding * width;
        return gap > 0 ? gap * gap : 0;
    };
    for (std::int64_t i = first[0]; i <= last[0]; ++i) {
        const double gap_i = squared_gap(0, i);
        for (std::int64_t j = first[1]; j <= last[1]; ++j) {
            const double gap_ij = gap_i + squared_gap(1, j);
            if (gap_ij > squared) continue;
            for (std::int64_t k = first[2]; k <= last[2]; ++k) {
                if (gap_ij + squared_gap(2, k) > squared) continue;
                for (std::int32_t e = slots_[slot_hash(level, i, j, k) & (slots_.size() - 1)]; e >= 0;) {
                    const Entry& entry = entries_[static_cast<std::size_t>(e)];
                    if (entry.level == level && squared_norm(entry.place - x) < squared && visit(entry.place)) return true;
                    e = entry.next;
                }
            }
        }
    }
    return false;
}

bool PointGrid::any_within(const Vec3& x, double radius, double least, double greatest) const {
    return visit_within(x, radius, least, greatest, [](const Vec3&) { return true; });
}

void PointGrid::find_within(const Vec3& x, double radius, double least, double greatest, std::vector<Vec3>& found) const {
    found.clear();
    visit_within(x, radius, least, greatest, [&](const Vec3& place) {
        found.push_back(place);
        return false;
    });
}

namespace {

constexpr std::size_t cells_at_once = 4096;  // between two looks at the watch: some milliseconds

struct Cell {
    Vec3 centre, half;   // half its widths; 0 where the room is flat [m]
    double spacing = 0;  // as it was asked last, of the cell or of one that it is a part of [m]; 0: never
    Vec3 asked_at = {};
};

/// What the spacing at `x` is at least, without asking [m]: a question may cost a search among many triangles.
double least_spacing(const SampleRule& rule, const Cell& cell, const Vec3& x) {
    constexpr double rounding = 1e-12;
    return cell.spacing * (1 - rounding) - rule.spacing_slope * distance(x, cell.asked_at);
}

/// The two to eight cells that a cell splits into, only across its long axes so that they tend to cubes.
void split_cell(const Cell& cell, std::vector<Cell>& into) {
    const double longest = std::max({cell.half.x, cell.half.y, cell.half.z});
    std::array<Cell, 8> parts = {cell};
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (cell.half[axis] <= 0.5 * longest) continue;
        for (std::size_t i = 0; i < count; ++i) {
            parts[i].half[axis] *= 0.5;
            parts[count + i] = parts[i];
            parts[i].centre[axis] -= parts[i].half[axis];
            parts[count + i].centre[axis] += parts[i].half[axis];
        }
        count *= 2;
    }
    into.insert(into.end(), parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count));
}

bool is_crowded(const SampleRule& rule, const PointGrid& taken, const Vec3& x, double spacing) {
    const double change = rule.spacing_slope * spacing;
    return taken.any_within(x, spacing, spacing - change, spacing + change);
}

/// No point of the cell could be accepted: for want of clearance, or since one neighbour is too near to all
/// of it. Says yes only where that is sure. `near(radius, spacing)`: is one nearer to the centre than that, among points
/// that stand at such a spacing?
template <class Near>
bool is_covered(const SampleRule& rule, Cell& cell, const Near& near) {
    const double reach = norm(cell.half), at_least = least_spacing(rule, cell, cell.centre);
    const auto crowded = [&](double spacing) { return near(spacing - (1 + rule.spacing_slope) * reach, spacing); };
    if (at_least > 0 && crowded(at_least)) return true;
    if (rule.clearance(cell.centre) + rule.clearance_slope * reach < 0) return true;
    cell.spacing = rule.spacing(cell.centre);
    cell.asked_at = cell.centre;
    return crowded(cell.spacing);
}

bool is_covered(const SampleRule& rule, const PointGrid& taken, Cell& cell) {
    return is_covered(rule, cell, [&](double radius, double spacing) {
        const double change = rule.spacing_slope * radius;
        return taken.any_within(cell.centre, radius, spacing - change, spacing + change);
    });
}

/// The points that stand around a place: what cells beside each other are asked by.
struct Around {
    Vec3 centre;
    double radius = 0;
    std::vector<Vec3> places;
};

/// Has all in it that could cover the cell, or one of its parts.
void look_around(const SampleRule& rule, const PointGrid& taken, const Cell& cell, Around& around) {
    constexpr double for_others = 4;  // of the half diagonal of a cell: those beside it
    const double reach = norm(cell.half);
    const double most = cell.spacing + rule.spacing_slope * (distance(cell.centre, cell.asked_at) + reach);
    if (distance(cell.centre, around.centre) + most <= around.radius) return;
    around.centre = cell.centre;
    around.radius = most + for_others * reach;
    const double change = rule.spacing_slope * (around.radius + distance(cell.centre, cell.asked_at));
    taken.find_within(cell.centre, around.radius, cell.spacing - change, cell.spacing + change, around.places);
}

/// The point that covers a cell is the first to be looked at for the next.
bool is_covered(const SampleRule& rule, Around& around, Cell& cell) {
    return is_covered(rule, cell, [&](double radius, double) {
        if (!(radius > 0)) return false;
        const auto found = std::ranges::find_if(
            around.places, [&](const Vec3& place) { return squared_norm(place - cell.centre) < radius * radius; });
        if (found == around.places.end()) return false;
        std::iter_swap(around.places.begin(), found);
        return true;
    });
}

/// The cells in which to begin: no larger than the spacing there, and not covered.
std::vector<Cell> first_cells(const Box& room, const SampleRule& rule, const PointGrid& taken,
                              const Watch* watch) {
    std::vector<Cell> open = {{0.5 * (room.min + room.max), 0.5 * (room.max - room.min)}}, fine;
    for (std::size_t i = 0; !open.empty(); ++i) {
        if (i % cells_at_once == 0) heed(watch);
        Cell cell = open.back();
        open.pop_back();
        if (is_covered(rule, taken, cell)) continue;
        if (norm(cell.half) > 0.75 * cell.spacing) split_cell(cell, open);
        else fine.push_back(cell);
    }
    return fine;
}

/// Cells that are open still, beside each other where they are so in space, and the order in which they are thrown at.
struct OpenCells {
    std::vector<Cell> cells;
    std::vector<std::uint32_t> order;
};

void shuffle(std::vector<std::uint32_t>& order, Random& random) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
}

/// A random point of the cell, kept within the room against rounding.
Vec3 random_point(const Cell& cell, const Box& room, Random& random) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = cell.centre[axis] + cell.half[axis] * random.uniform(-1, 1);
        x[axis] = std::clamp(at, room.min[axis], room.max[axis]);
    }
    return x;
}

/// The parts of the cells that are open still and wide enough to matter, in their order. All cells were asked about before.
OpenCells open_parts(OpenCells& open, const SampleRule& rule, const PointGrid& taken, const Watch* watch) {
    constexpr double narrowest_gap = 1e-4;  // of the spacing
    OpenCells left;
    std::vector<Cell> parts;
    Around around;
    std::vector<std::uint32_t> first(open.cells.size() + 1, 0);  // of the parts of each
    for (std::size_t i = 0; i < open.cells.size(); ++i) {
        if (i % cells_at_once == 0) heed(watch);
        Cell& cell = open.cells[i];
        look_around(rule, taken, cell, around);
        if (!is_covered(rule, around, cell)) {
            parts.clear();
            split_cell(cell, parts);
            for (Cell& part : parts)
                if (!is_covered(rule, around, part) && norm(part.half) > narrowest_gap * part.spacing)
                    left.cells.push_back(part);
        }
        first[i + 1] = static_cast<std::uint32_t>(left.cells.size());
    }
    left.order.reserve(left.cells.size());
    for (const std::uint32_t i : open.order)
        for (std::uint32_t part = first[i]; part < first[i + 1]; ++part) left.order.push_back(part);
    return left;
}

}  // namespace

std::vector<Vec3> fill_room(const Box& room, const SampleRule& rule, PointGrid& taken, Random& random,
                            const Watch* watch) {
    constexpr std::size_t most_throws = 1000;  // per cell to begin with; a few dozen do
    std::vector<Vec3> found;
    OpenCells open{first_cells(room, rule, taken, watch), {}};
    open.order.resize(open.cells.size());
    std::iota(open.order.begin(), open.order.end(), 0u);
    for (std::size_t left = most_throws * open.cells.size(); !open.cells.empty() && open.cells.size() <= left;) {
        left -= open.cells.size();
        shuffle(open.order, random);
        for (std::size_t i = 0; i < open.order.size(); ++i) {
            if (i % cells_at_once == 0) heed(watch);
            const Cell& cell = open.cells[open.order[i]];
            __builtin_prefetch(&open.cells[open.order[std::min(i + 8, open.order.size() - 1)]]);  // by chance, far apart
            const Vec3 x = random_point(cell, room, random);
            const double at_least = least_spacing(rule, cell, x);
            if (at_least > 0 && is_crowded(rule, taken, x, at_least)) continue;
            const double spacing = rule.spacing(x);
            if (rule.clearance(x) < 0 || is_crowded(rule, taken, x, spacing)) continue;
            taken.insert(x, spacing);
            found.push_back(x);
        }
        open = open_parts(open, rule, taken, watch);
    }
    return found;
}

}  // namespace kropla
