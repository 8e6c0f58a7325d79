#pragma once

#include <kropla/base/index.h>

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

namespace kropla {

/// A set of indices of one kind, a bit for each: asked and filled in any order, visited in ascending order. Bits come
/// in pages that are there where something is held, so that a small part of a large mesh costs little to make, to
/// visit and to forget.
template <class I>
class IndexSet {
public:
    [[nodiscard]] bool contains(I i) const { return (page(i)[word_of(i)] & bit_of(i)) != 0; }
    /// Whether `i` was not there before.
    bool insert(I i) {
        std::uint64_t& word = page_to_fill(i)[word_of(i)];
        if ((word & bit_of(i)) != 0) return false;
        word |= bit_of(i);
        ++size_;
        return true;
    }
    void erase(I i) {
        if (!contains(i)) return;
        page_to_fill(i)[word_of(i)] &= ~bit_of(i);
        --size_;
    }
    [[nodiscard]] std::size_t size() const { return size_; }
    void clear() {
        page_at_.clear();
        pages_.resize(1);
        size_ = 0;
    }
    /// In ascending order. The index that is visited may be erased meanwhile.
    template <class Visit>
    void for_each(Visit visit) const {
        for (std::size_t page = 0; page < page_at_.size(); ++page) {
            if (page_at_[page] == 0) continue;
            for (std::size_t word = 0; word < words; ++word)
                for (std::uint64_t left = pages_[page_at_[page]][word]; left != 0; left &= left - 1)
                    visit(I(64 * (words * page + word) + as_size(std::countr_zero(left))));
        }
    }

    [[nodiscard]] std::vector<I> list() const {
        std::vector<I> all;
        all.reserve(size_);
        for_each([&](I i) { all.push_back(i); });
        return all;
    }

private:
    static constexpr std::size_t words = 64;  // of a page
    using Page = std::array<std::uint64_t, words>;

    static std::size_t page_of(I i) { return as_size(i.value) / (64 * words); }
    static std::size_t word_of(I i) { return as_size(i.value) / 64 % words; }
    static std::uint64_t bit_of(I i) { return std::uint64_t{1} << (static_cast<unsigned>(i.value) % 64); }

    [[nodiscard]] const Page& page(I i) const {
        assert(i.exists());
        return pages_[page_of(i) < page_at_.size() ? page_at_[page_of(i)] : 0];
    }
    Page& page_to_fill(I i) {
        assert(i.exists());
        if (page_of(i) >= page_at_.size()) page_at_.resize(page_of(i) + 1, 0);
        std::uint32_t& at = page_at_[page_of(i)];
        if (at == 0) {
            at = static_cast<std::uint32_t>(pages_.size());
            pages_.emplace_back();
        }
        return pages_[at];
    }

    std::vector<std::uint32_t> page_at_;  // per page of indices: where in `pages_` it is; 0: nowhere, the empty one
    std::vector<Page> pages_ = std::vector<Page>(1);
    std::size_t size_ = 0;
};

}  // namespace kropla
