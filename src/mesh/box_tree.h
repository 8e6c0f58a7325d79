#pragma once

#include <kropla/base/vec3.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace kropla {

/// A box along the axes, from corner to corner; empty as it begins.
struct Extent {
    Vec3 min = {infinite, infinite, infinite}, max = {-infinite, -infinite, -infinite};

    void take_in(const Vec3& x) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = std::min(min[axis], x[axis]);
            max[axis] = std::max(max[axis], x[axis]);
        }
    }
    [[nodiscard]] bool meets(const Extent& other) const {
        for (int axis = 0; axis < 3; ++axis)
            if (max[axis] < other.min[axis] || other.max[axis] < min[axis]) return false;
        return true;
    }
    /// From `x` to the nearest point of the box, squared; 0 inside.
    [[nodiscard]] double squared_distance(const Vec3& x) const {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double outside = std::max({min[axis] - x[axis], x[axis] - max[axis], 0.0});
            sum += outside * outside;
        }
        return sum;
    }
    [[nodiscard]] double squared_distance(const Extent& other) const {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double between = std::max({min[axis] - other.max[axis], other.min[axis] - max[axis], 0.0});
            sum += between * between;
        }
        return sum;
    }
    static constexpr double infinite = std::numeric_limits<double>::infinity();
};

/// Which of many boxes meet a given one, in time proportional to the logarithm of their number and to those found; and
/// which item is least in some sense that boxes bound from below, by branch and bound, nearest box first [Roussopoulos,
/// Kelley, Vincent 1995]. A tree of boxes, each split in the middle of its items along its longest axis.
class BoxTree {
public:
    explicit BoxTree(std::vector<Extent> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
        std::iota(items_.begin(), items_.end(), std::size_t{0});
        if (!items_.empty()) build(0, items_.size());
    }

    /// Calls `is_wanted` with the number of each box that meets `box`, until it returns true. Returns whether it did.
    template <class IsWanted>
    bool any(const Extent& box, const IsWanted& is_wanted) const {
        for (std::size_t n = 0; n < nodes_.size();) {
            const Node& node = nodes_[n];
            if (!node.box.meets(box)) {
                n = node.next;
                continue;
            }
            ++n;
            if (node.next != n) continue;  // it has parts
            for (std::size_t i = node.begin; i < node.end; ++i)
                if (boxes_[items_[i]].meets(box) && is_wanted(items_[i])) return true;
        }
        return false;
    }

    /// The least `value(item)` below `bound`; `bound` if none is. `at_least(box)` is not above the value of any item
    /// whose box lies within `box`; what cannot be less than what was found before is not asked for its value.
    template <class AtLeast, class Value>
    double least(const AtLeast& at_least, const Value& value, double bound = Extent::infinite) const {
        if (!nodes_.empty()) search(0, at_least, value, bound);
        return bound;
    }
    /// The same of pairs of an item here and one of `other`, by `at_least(box, other_box)` and `value(item, other_item)`.
    template <class AtLeast, class Value>
    double least_pair(const BoxTree& other, const AtLeast& at_least, const Value& value,
                      double bound = Extent::infinite) const {
        if (!nodes_.empty() && !other.nodes_.empty()) search_pair(0, other, 0, at_least, value, bound);
        return bound;
    }

private:
    struct Node {
        Extent box;
        std::size_t begin, end;  // of its items
        std::size_t next;        // node after it and all its parts, which follow it
    };

    [[nodiscard]] bool has_parts(std::size_t n) const { return nodes_[n].next != n + 1; }
    /// The two parts, the one that is bounded lower first.
    template <class AtLeast, class Look>
    void look_at_parts(std::size_t n, const AtLeast& at_least, const Look& look, const double& least) const {
        std::array<std::size_t, 2> part = {n + 1, nodes_[n + 1].next};
        std::array<double, 2> bound = {at_least(nodes_[part[0]].box), at_least(nodes_[part[1]].box)};
        if (bound[1] < bound[0]) {
            std::swap(part[0], part[1]);
            std::swap(bound[0], bound[1]);
        }
        for (std::size_t i = 0; i < 2; ++i)
            if (bound[i] < least) look(part[i]);
    }
    template <class AtLeast, class Value>
    void search(std::size_t n, const AtLeast& at_least, const Value& value, double& least) const {
        if (has_parts(n))
            return look_at_parts(n, at_least, [&](std::size_t part) { search(part, at_least, value, least); }, least);
        for (std::size_t i = nodes_[n].begin; i < nodes_[n].end; ++i)
            if (at_least(boxes_[items_[i]]) < least) least = std::min(least, value(items_[i]));
    }
    template <class AtLeast, class Value>
    void search_pair(std::size_t n, const BoxTree& other, std::size_t m, const AtLeast& at_least, const Value& value,
                     double& least) const {
        const Node &here = nodes_[n], &there = other.nodes_[m];
        const bool smaller = here.end - here.begin < there.end - there.begin;
        if (has_parts(n) && !(smaller && other.has_parts(m)))
            return look_at_parts(n, [&](const Extent& box) { return at_least(box, there.box); },
                [&](std::size_t part) { search_pair(part, other, m, at_least, value, least); }, least);
        if (other.has_parts(m))
            return other.look_at_parts(m, [&](const Extent& box) { return at_least(here.box, box); },
                [&](std::size_t part) { search_pair(n, other, part, at_least, value, least); }, least);
        for (std::size_t i = here.begin; i < here.end; ++i)
            for (std::size_t j = there.begin; j < there.end; ++j)
                if (at_least(boxes_[items_[i]], other.boxes_[other.items_[j]]) < least)
                    least = std::min(least, value(items_[i], other.items_[j]));
    }

    void build(std::size_t begin, std::size_t end) {
        constexpr std::size_t few = 8;
        const std::size_t number = nodes_.size();
        Node node{{}, begin, end, 0};
        for (std::size_t i = begin; i < end; ++i) {
            node.box.take_in(boxes_[items_[i]].min);
            node.box.take_in(boxes_[items_[i]].max);
        }
        nodes_.push_back(node);
        if (end - begin > few) {
            const std::size_t middle = begin + (end - begin) / 2;
            split(node.box, begin, middle, end);
            build(begin, middle);
            build(middle, end);
        }
        nodes_[number].next = nodes_.size();
    }
    void split(const Extent& box, std::size_t begin, std::size_t middle, std::size_t end) {
        const Vec3 size = box.max - box.min;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto place = [&](std::size_t item) { return boxes_[item].min[axis] + boxes_[item].max[axis]; };
        const auto nth = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(nth(begin), nth(middle), nth(end), [&](std::size_t a, std::size_t b) {
            return std::pair(place(a), a) < std::pair(place(b), b);
        });
    }

    std::vector<Extent> boxes_;
    std::vector<std::size_t> items_;
    std::vector<Node> nodes_;
};

}  // namespace kropla
