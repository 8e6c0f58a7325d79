#include "simulate/stop.h"

namespace kropla {
namespace {

constexpr PetscInt iterations_at_once = 8;  // between two meetings: one more reduction to some twenty of GMRES

struct Listener {
    PetscErrorCode (*test)(KSP, PetscInt, PetscReal, KSPConvergedReason*, void*);
    void* context;
    PetscErrorCode (*destroy)(void*);
    Ranks ranks;
};

// PETSc calls it: no exception may pass through its frames.
PetscErrorCode test_and_listen(KSP solver, PetscInt iteration, PetscReal norm, KSPConvergedReason* reason,
                               void* context) {
    const auto& listener = *static_cast<const Listener*>(context);
    const PetscErrorCode code = listener.test(solver, iteration, norm, reason, listener.context);
    if (code == 0 && *reason == KSP_CONVERGED_ITERATING && iteration % iterations_at_once == 0 &&
        stop_anywhere(listener.ranks))
        *reason = KSP_DIVERGED_BREAKDOWN;
    return code;
}

PetscErrorCode destroy_listener(void* context) {
    const std::unique_ptr<Listener> listener(static_cast<Listener*>(context));
    return listener->destroy != nullptr ? listener->destroy(listener->context) : PetscErrorCode{};
}

/// Is it true of any rank?
bool any_of(const Ranks& ranks, bool here) {
    int mine = here ? 1 : 0, all = mine;
    if (ranks.count > 1) MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, ranks.communicator);
    return all != 0;
}

}  // namespace

bool stop_anywhere(const Ranks& ranks) {
    if (ranks.watch == nullptr || !any_of(ranks, ranks.watch->stop)) return false;
    ranks.watch->stop = true;
    return true;
}

void leave(const Ranks& ranks) {
    if (ranks.watch != nullptr) static_cast<void>(any_of(ranks, true));
}

void heed(const Ranks& ranks) {
    if (stop_anywhere(ranks)) throw AllInterrupted("interrupted");
}

void listen_on_the_way(KSP solver, const Ranks& ranks) {
    auto listener = std::make_unique<Listener>(nullptr, nullptr, nullptr, ranks);
    check(KSPGetAndClearConvergenceTest(solver, &listener->test, &listener->context, &listener->destroy));
    check(KSPSetConvergenceTest(solver, test_and_listen, listener.release(), destroy_listener));
}

}  // namespace kropla
