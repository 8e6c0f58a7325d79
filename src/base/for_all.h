#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace kropla {

/// Calls `deed` for 0 ... count - 1 from several threads at once: deeds that do not touch each other's
/// results.
template <class Deed>
void for_all(std::size_t count, Deed deed, std::size_t at_once = 512) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, at_once), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) deed(i);
    });
}

}  // namespace kropla
