#pragma once

#include <cstdint>
#include <vector>

namespace kropla {

/// A map from the numbers of slots (vertices or tets) to numbers from 0 on, for what is known of a few slots
/// of a large mesh. Open addressing; the size is a power of two, at most half full.
class SlotMap {
public:
    explicit SlotMap(std::size_t expected = 16) {
        std::size_t size = 32;
        while (size < 2 * expected) size *= 2;
        entries_.assign(size, {});
    }

    /// -1 if the slot is not in the map.
    [[nodiscard]] std::int32_t find(std::int32_t slot) const { return entries_[place(slot)].number; }
    [[nodiscard]] bool contains(std::int32_t slot) const { return find(slot) >= 0; }

    /// Enters the slot if it is not there yet. Returns its number, the old one or the new one.
    std::int32_t insert(std::int32_t slot, std::int32_t number) {
        Entry& entry = entries_[place(slot)];
        if (entry.number >= 0) return entry.number;
        entry = {slot, number};
        if (2 * ++used_ > entries_.size()) grow();
        return number;
    }
    void assign(std::int32_t slot, std::int32_t number) {
        insert(slot, number);
        entries_[place(slot)].number = number;
    }
    [[nodiscard]] std::size_t size() const { return used_; }

private:
    struct Entry {
        std::int32_t slot = -1, number = -1;
    };

    [[nodiscard]] std::size_t place(std::int32_t slot) const {
        const std::uint64_t mixed = static_cast<std::uint32_t>(slot) * std::uint64_t{0x9E3779B97F4A7C15};
        std::size_t i = (mixed >> 32) & (entries_.size() - 1);
        while (entries_[i].number >= 0 && entries_[i].slot != slot) i = (i + 1) & (entries_.size() - 1);
        return i;
    }
    void grow() {
        std::vector<Entry> old(2 * entries_.size());
        old.swap(entries_);
        for (const Entry& entry : old)
            if (entry.number >= 0) entries_[place(entry.slot)] = entry;
    }

    std::vector<Entry> entries_;
    std::size_t used_ = 0;
};

}  // namespace kropla
