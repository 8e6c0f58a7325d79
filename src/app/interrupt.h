#pragma once

#include "simulate/petsc.h"

namespace kropla {

/// While it lives, SIGINT and SIGTERM are noted instead of ending the program. One at a time.
class CatchInterrupts {
public:
    CatchInterrupts();
    ~CatchInterrupts();
    CatchInterrupts(const CatchInterrupts&) = delete;
    CatchInterrupts& operator=(const CatchInterrupts&) = delete;
};

/// Was a signal noted, on any rank? All ranks ask together and get the same answer.
[[nodiscard]] bool interrupted(const Ranks& ranks);

}  // namespace kropla
