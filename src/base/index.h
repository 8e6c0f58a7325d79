#pragma once

#include <cassert>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace kropla {

/// A number of a corner, an axis, a slot as arrays of the standard library want it; it is not negative.
constexpr std::size_t as_size(std::int32_t i) { return static_cast<std::size_t>(i); }

/// A number that names one thing of one kind: `Index<struct VertexTag>` and `Index<struct TetTag>` do not
/// mix. The default names nothing; 32 bits, so that a mesh holds at most 2^31 - 1 things of a kind.
template <class Tag>
struct Index {
    std::int32_t value = -1;

    constexpr Index() = default;
    constexpr explicit Index(std::int32_t v) : value(v) {}
    constexpr explicit Index(std::size_t v) : value(static_cast<std::int32_t>(v)) {}

    [[nodiscard]] constexpr bool exists() const { return value >= 0; }
    auto operator<=>(const Index&) const = default;
};

/// The indices from `first` up to `last`, that one left out. (Not of std::views: clang 14 cannot read those of Debian 12.)
template <class I>
struct IndexRange {
    struct Iterator {
        using value_type = I;
        using difference_type = std::ptrdiff_t;
        I at;
        I operator*() const { return at; }
        Iterator& operator++() {
            ++at.value;
            return *this;
        }
        Iterator operator++(int) {
            Iterator before = *this;
            ++at.value;
            return before;
        }
        bool operator==(const Iterator&) const = default;
    };
    I first, last;
    [[nodiscard]] Iterator begin() const { return {first}; }
    [[nodiscard]] Iterator end() const { return {last}; }
};

/// A std::vector that is indexed by one kind of Index only; developer and debug builds check that it is there.
template <class I, class T>
class Array {
public:
    Array() = default;
    explicit Array(std::size_t size, const T& value = T{}) : items_(size, value) {}
    Array(std::initializer_list<T> items) : items_(items) {}

    T& operator[](I i) { return items_[at(i)]; }
    const T& operator[](I i) const { return items_[at(i)]; }

    [[nodiscard]] std::size_t size() const { return items_.size(); }
    [[nodiscard]] bool empty() const { return items_.empty(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    T* data() { return items_.data(); }

    /// Appends `item` and returns the index it got.
    I push_back(const T& item) {
        items_.push_back(item);
        return I(items_.size() - 1);
    }
    void resize(std::size_t size, const T& value = T{}) { items_.resize(size, value); }
    void reserve(std::size_t size) { items_.reserve(size); }

    /// All indices, in order: `for (Tet t : mesh.tets.indices())`.
    [[nodiscard]] IndexRange<I> indices() const { return {I(std::size_t{0}), I(items_.size())}; }

    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }
    auto begin() { return items_.begin(); }
    auto end() { return items_.end(); }

    bool operator==(const Array&) const = default;

private:
    [[nodiscard]] std::size_t at(I i) const {
        assert(i.exists() && as_size(i.value) < items_.size());
        return as_size(i.value);
    }

    std::vector<T> items_;
};

}  // namespace kropla
