#include "app/interrupt.h"

#include <csignal>

namespace kropla {
namespace {

volatile std::sig_atomic_t signal_noted = 0;  // a signal handler can reach nothing but this

extern "C" void note_signal(int) { signal_noted = 1; }

}  // namespace

CatchInterrupts::CatchInterrupts() {
    signal_noted = 0;
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

CatchInterrupts::~CatchInterrupts() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool interrupted(const Ranks& ranks) {
    int here = signal_noted, anywhere = 0;
    MPI_Allreduce(&here, &anywhere, 1, MPI_INT, MPI_MAX, ranks.communicator);
    return anywhere != 0;
}

}  // namespace kropla
