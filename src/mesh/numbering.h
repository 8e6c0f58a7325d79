#pragma once

#include "base/index.h"

#include <cstdint>

namespace kropla {

/// Consecutive numbers for some of the indices of a kind. Emptying it costs nothing, so that one that is kept
/// serves for small parts of a large mesh again and again.
template <class I>
class Numbering {
public:
    /// The number of `i`, or -1.
    [[nodiscard]] int operator()(I i) const {
        const auto slot = static_cast<std::size_t>(i.value);
        return slot < known_.size() && known_[i].round == round_ ? known_[i].number : -1;
    }
    /// Gives `i` the next number; it has none yet.
    int add(I i) {
        const auto slot = static_cast<std::size_t>(i.value);
        if (slot >= known_.size()) known_.resize(slot + slot / 4 + 16, {});
        known_[i] = {round_, count_};
        return count_++;
    }
    void clear() {
        ++round_;
        count_ = 0;
    }

private:
    struct Known {
        std::uint32_t round = 0;  // 0: never
        std::int32_t number = -1;
    };
    Array<I, Known> known_;
    std::uint32_t round_ = 1;
    std::int32_t count_ = 0;
};

}  // namespace kropla
