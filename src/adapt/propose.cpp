#include "adapt/propose.h"

#include "adapt/for_all.h"

namespace kropla {

std::vector<std::optional<Cavity>> propose_all(std::size_t count,
                                               const std::function<std::optional<Cavity>(std::size_t)>& propose) {
    std::vector<std::optional<Cavity>> proposals(count);
    for_all(count, [&](std::size_t i) { proposals[i] = propose(i); }, 64);
    return proposals;
}

}  // namespace kropla
