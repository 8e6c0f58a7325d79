#pragma once

#include <cstddef>

namespace kropla::heap {

// What operator new hands out in the programs that are linked with heap.cpp; one thread at a time.

[[nodiscard]] std::size_t bytes();       ///< now
[[nodiscard]] std::size_t peak_bytes();  ///< the most since reset_peak()
void reset_peak();

}  // namespace kropla::heap
