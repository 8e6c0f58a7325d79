#include "adapt/propose.h"

#include "adapt/for_all.h"

namespace kropla {

std::vector<Proposal> propose_all(std::size_t count,
                                  const std::function<std::optional<Cavity>(std::size_t)>& propose) {
    constexpr std::size_t at_once = 64;
    std::vector<std::vector<Proposal>> parts((count + at_once - 1) / at_once);
    for_all(parts.size(), [&](std::size_t part) {
        for (std::size_t i = at_once * part; i < std::min(count, at_once * (part + 1)); ++i)
            if (auto cavity = propose(i)) parts[part].push_back({i, std::move(*cavity)});
    }, 1);
    std::vector<Proposal> all;
    for (auto& part : parts) std::ranges::move(part, std::back_inserter(all));
    return all;
}

}  // namespace kropla
