#include "app/interrupt.h"

#include <csignal>
#include <cstdint>
#include <ctime>
#include <unistd.h>

namespace kropla {
namespace {

constexpr std::int64_t same_signal = 250'000'000;  // [ns] timeout(1) and some shells send theirs twice in a row
constexpr int interrupted_code = 130;

// A signal handler can reach nothing but these.
std::atomic<std::atomic<bool>*> stop_of_watch = nullptr;
std::atomic<std::int64_t> first_signal = 0;  // [ns] when; 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
              std::atomic<std::atomic<bool>*>::is_always_lock_free);

std::int64_t now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

extern "C" void note_signal(int) {
    std::int64_t first = 0;
    const std::int64_t here = now();
    if (!first_signal.compare_exchange_strong(first, here) && here - first > same_signal) _exit(interrupted_code);
    if (std::atomic<bool>* stop = stop_of_watch) *stop = true;
}

}  // namespace

CatchInterrupts::CatchInterrupts(Watch& watch) {
    first_signal = 0;
    stop_of_watch = &watch.stop;
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

CatchInterrupts::~CatchInterrupts() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    stop_of_watch = nullptr;
}

}  // namespace kropla
