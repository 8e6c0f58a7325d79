#pragma once

#include <kropla/base/watch.h>

namespace kropla {

/// While it lives, SIGINT and SIGTERM set the watch's `stop` instead of ending the program. A second one, of whoever
/// cannot wait, ends it at once with code 130. One at a time.
class CatchInterrupts {
public:
    explicit CatchInterrupts(Watch& watch);
    ~CatchInterrupts();
    CatchInterrupts(const CatchInterrupts&) = delete;
    CatchInterrupts& operator=(const CatchInterrupts&) = delete;
};

}  // namespace kropla
