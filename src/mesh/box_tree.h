#pragma once

#include "base/vec3.h"

#include <algorithm>
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
    static constexpr double infinite = std::numeric_limits<double>::infinity();
};

/// Which of many boxes meet a given one, in time proportional to the logarithm of their number and to those found: a
/// tree of boxes, each split in the middle of its items along its longest axis.
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

private:
    struct Node {
        Extent box;
        std::size_t begin, end;  // of its items
        std::size_t next;        // node after it and all its parts, which follow it
    };

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
        const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
            return std::pair(place(a), a) < std::pair(place(b), b);
        });
    }

    std::vector<Extent> boxes_;
    std::vector<std::size_t> items_;
    std::vector<Node> nodes_;
};

}  // namespace kropla
