#pragma once

#include "adapt/adapt.h"
#include "mesh/index_set.h"

#include <algorithm>
#include <functional>

namespace kropla {

struct Proposal {
    std::size_t asked;  // for which it was made
    Cavity cavity;
};

/// What `propose` says for 0 ... count - 1, in this order, where it says something; asked by several threads at
/// once on a mesh that nothing changes meanwhile: the same for any number of threads.
[[nodiscard]] std::vector<Proposal> propose_all(std::size_t count,
                                                const std::function<std::optional<Cavity>(std::size_t)>& propose);

/// Cells that have been replaced since proposals were made: a proposal that would replace one of them is out
/// of date, all others are as good as they were.
class Replaced {
public:
    void add(const Cavity& cavity) {
        for (Tet t : cavity.removed) cells_.insert(t);
    }
    [[nodiscard]] bool outdates(const Cavity& cavity) const {
        return std::ranges::any_of(cavity.removed, [&](Tet t) { return cells_.contains(t); });
    }

private:
    IndexSet<Tet> cells_;
};

}  // namespace kropla
