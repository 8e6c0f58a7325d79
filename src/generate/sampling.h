#pragma once

#include "base/random.h"
#include <kropla/base/watch.h>
#include <kropla/domain/domain.h>
#include "mesh/box_tree.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace kropla {

/// Points filed by place and by the spacing they stand at, to answer: is one of them within r of x? One hash
/// table for a pile of grids, each for the spacings of one power of two, so that neither the range of
/// spacings nor empty space costs anything.
class PointGrid {
public:
    void insert(const Vec3& x, double spacing);

    /// Is a point nearer to `x` than `radius`? Points filed with a spacing outside [least, greatest] are not
    /// seen.
    [[nodiscard]] bool any_within(const Vec3& x, double radius, double least, double greatest) const;
    /// All of them.
    void find_within(const Vec3& x, double radius, double least, double greatest, std::vector<Vec3>& found) const;

private:
    struct Entry {
        Vec3 place;
        int level;
        std::int32_t next;  // in the same slot, or -1
    };
    void file(std::int32_t entry);
    /// Until `visit(place)` says that it is enough; did it?
    template <class Visit>
    bool visit_within(const Vec3& x, double radius, double least, double greatest, const Visit& visit) const;
    /// The points of one level, and the box that just holds them.
    struct Level {
        int level;
        Extent held;
    };
    template <class Visit>
    bool visit_within_at(const Level& at, const Vec3& x, double radius, const Visit& visit) const;

    std::vector<Entry> entries_;
    std::vector<std::int32_t> slots_ = std::vector<std::int32_t>(64, -1);
    std::vector<Level> levels_;  // highest first
};

/// What a maximal sample obeys: a point x stands only where clearance(x) >= 0, and is refused if another
/// stands nearer than spacing(x). The slopes bound how fast both change.
struct SampleRule {
    std::function<double(const Vec3&)> spacing;    // r [m]
    double spacing_slope = 0;                      // [-]
    std::function<double(const Vec3&)> clearance;  // [m]
    double clearance_slope = 1;                    // [-]
};

/// Fills `room`, which may be flat, with random points until none can be added, but in gaps narrower than
/// 1e-4 spacings, or in those that are left after a thousand throws per cell of the size of the spacing. The new points
/// are filed in `taken`, whose points count as neighbours. Throws Interrupted if the watch says so.
[[nodiscard]] std::vector<Vec3> fill_room(const Box& room, const SampleRule& rule, PointGrid& taken,
                                          Random& random, const Watch* watch = nullptr);

}  // namespace kropla
