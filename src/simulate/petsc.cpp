#include "simulate/petsc.h"

#include "base/error.h"

namespace kropla {

void check(PetscErrorCode code) {
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw SolverError("PETSc: " + std::string(text ? text : "unknown error") + " (code " +
                      std::to_string(static_cast<int>(code)) + ")");
}

PetscSession::PetscSession(std::vector<std::string> options) : words_(std::move(options)) {
    words_.insert(words_.begin(), "kropla");
    for (std::string& word : words_) arguments_.push_back(word.data());
    arguments_.push_back(nullptr);
    int count = static_cast<int>(words_.size());
    char** first = arguments_.data();
    check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
    check(PetscInitialize(&count, &first, nullptr, nullptr));
    check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
}

PetscSession::~PetscSession() {
    PetscFinalize();
}

Ranks PetscSession::all_ranks() const {
    Ranks ranks{PETSC_COMM_WORLD, 0, 1};
    MPI_Comm_rank(ranks.communicator, &ranks.rank);
    MPI_Comm_size(ranks.communicator, &ranks.count);
    return ranks;
}

}  // namespace kropla
