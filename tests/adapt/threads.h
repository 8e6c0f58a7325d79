#pragma once

#include <oneapi/tbb/global_control.h>

#include <cstddef>

namespace kropla {

/// What `deed` returns, called with this many threads allowed.
template <class Deed>
auto with_threads(std::size_t count, Deed deed) {
    using oneapi::tbb::global_control;
    const global_control allowed(global_control::max_allowed_parallelism, count);
    return deed();
}

}  // namespace kropla
