#include <kropla/simulate/petsc.h>

#include <kropla/base/error.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>

namespace kropla {
namespace {

bool is_started_by_mpirun() {
    constexpr std::array names = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
    return std::ranges::any_of(names, [](const char* name) { return std::getenv(name) != nullptr; });
}

/// An empty folder for what Open MPI keeps of a process that is alone; none if there cannot be one. By itself it uses one
/// folder for all processes of a user, which one removes while another begins: beside others one start in a hundred fails.
std::filesystem::path folder_of_this_process() {
    std::error_code none;
    std::string name = (std::filesystem::temp_directory_path(none) / "kropla-mpi-XXXXXX").string();
    return none || mkdtemp(name.data()) == nullptr ? std::filesystem::path() : std::filesystem::path(name);
}

}  // namespace

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
    if (!is_started_by_mpirun()) folder_ = folder_of_this_process();
    if (!folder_.empty()) setenv("OMPI_MCA_orte_tmpdir_base", folder_.c_str(), 0);
    check(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
    check(PetscInitialize(&count, &first, nullptr, nullptr));
    check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
}

PetscSession::~PetscSession() {
    PetscFinalize();
    std::error_code ignored;  // it is in the folder for temporary files
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

Ranks PetscSession::all_ranks() const {
    Ranks ranks{PETSC_COMM_WORLD, 0, 1};
    MPI_Comm_rank(ranks.communicator, &ranks.rank);
    MPI_Comm_size(ranks.communicator, &ranks.count);
    return ranks;
}

}  // namespace kropla
