#include <kropla/simulate/petsc.h>

#include <kropla/base/error.h>

#include <cstdlib>
#include <new>

namespace kropla {

void check(PetscErrorCode code) {
    if (code == 0) return;
    if (code == PETSC_ERR_MEM) throw std::bad_alloc();
    const char* kind = nullptr;
    char* said = nullptr;
    PetscErrorMessage(code, &kind, &said);
    std::string text = said != nullptr && *said != 0 ? said : kind != nullptr ? kind : "unknown error";
    text = text.substr(0, text.find('\n'));
    throw SolverError("PETSc: " + text);
}

PetscSession::PetscSession(std::vector<std::string> options) : words_(std::move(options)) {
    words_.insert(words_.begin(), "kropla");
    for (std::string& word : words_) arguments_.push_back(word.data());
    arguments_.push_back(nullptr);
    int count = static_cast<int>(words_.size());
    char** first = arguments_.data();
    // Started without mpirun, this process is alone and needs no daemon, for which Open MPI would look for ssh.
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
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
