#pragma once

#include "base/index.h"

#include <bit>
#include <cstdint>

namespace kropla {

/// A set of indices of one kind, a bit for each: asked and filled in any order, visited in ascending order.
template <class I>
class IndexSet {
public:
    [[nodiscard]] bool contains(I i) const {
        const std::size_t word = word_of(i);
        return word < words_.size() && (words_[word] & bit_of(i)) != 0;
    }
    /// Whether `i` was not there before.
    bool insert(I i) {
        const std::size_t word = word_of(i);
        if (word >= words_.size()) words_.resize(word + word / 4 + 16, 0);
        if ((words_[word] & bit_of(i)) != 0) return false;
        words_[word] |= bit_of(i);
        ++size_;
        return true;
    }
    void erase(I i) {
        if (!contains(i)) return;
        words_[word_of(i)] &= ~bit_of(i);
        --size_;
    }
    [[nodiscard]] std::size_t size() const { return size_; }
    void clear() {
        words_.assign(words_.size(), 0);
        size_ = 0;
    }
    template <class Visit>
    void for_each(Visit visit) const {
        for (std::size_t word = 0; word < words_.size(); ++word)
            for (std::uint64_t left = words_[word]; left != 0; left &= left - 1)
                visit(I(64 * word + static_cast<std::size_t>(std::countr_zero(left))));
    }

private:
    static std::size_t word_of(I i) { return static_cast<std::size_t>(i.value) / 64; }
    static std::uint64_t bit_of(I i) { return std::uint64_t{1} << (static_cast<unsigned>(i.value) % 64); }

    std::vector<std::uint64_t> words_;
    std::size_t size_ = 0;
};

}  // namespace kropla
