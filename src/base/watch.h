#pragma once

#include <kropla/base/error.h>

#include <atomic>
#include <functional>
#include <string_view>

namespace kropla {

/// Whoever follows a long computation from outside: may end it, and is told how far it is.
struct Watch {
    std::atomic<bool> stop = false;  // set from any thread or signal handler
    std::function<void(std::string_view stage, double share)> progress = {};  // share done, 0 ... 1; empty: not told
};

/// Throws Interrupted if the watch, where there is one, says stop. Asked at least every tenth of a second of work, and
/// only where what is dropped by it is a value of the caller's own: never in the middle of writing.
inline void heed(const Watch* watch) {
    if (watch != nullptr && watch->stop.load(std::memory_order_relaxed)) throw Interrupted("interrupted");
}
/// The same, and tells how far it is.
inline void heed(const Watch* watch, std::string_view stage, double share) {
    heed(watch);
    if (watch != nullptr && watch->progress) watch->progress(stage, share);
}

}  // namespace kropla
