#include "app/solver_options.h"

#include "case/table.h"
#include <kropla/base/error.h>
#include "simulate/flow_solver.h"
#include "simulate/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace kropla {
namespace {

struct SolverOption {
    std::string name, value;  // "-ksp_rtol", "1e-8"; no value: empty
};

bool is_name(const std::string& word) {
    return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

std::vector<SolverOption> pairs(const std::vector<std::string>& words) {
    std::vector<SolverOption> options;
    for (const std::string& word : words) {
        if (is_name(word)) options.push_back({word, ""});
        else if (!options.empty()) options.back().value = word;
    }
    return options;
}

/// PETSc asks for these as it solves, and prints: not to be tried beforehand.
bool asked_on_the_way(const std::string& name) {
    constexpr std::array<std::string_view, 16> prints = {
        "ksp_converged_reason", "ksp_converged_rate", "ksp_view", "ksp_view_pre", "ksp_view_mat", "ksp_view_pmat",
        "ksp_view_rhs", "ksp_view_solution", "ksp_view_mat_explicit", "ksp_view_diagonal_scale",
        "ksp_view_final_residual", "ksp_view_eigenvalues", "ksp_view_singularvalues", "ksp_view_eigenvalues_explicit",
        "ksp_view_preconditioned_operator_explicit", "ksp_test_null_space"};
    return std::ranges::any_of(prints, [&](std::string_view end) { return name.ends_with(end); });
}

/// PETSc asks for these when it ends.
bool asked_at_the_end(const std::string& name) {
    constexpr std::array<std::string_view, 12> last = {
        "-options_left", "-options_view", "-malloc_dump",  "-malloc_view", "-malloc_test", "-memory_view",
        "-objects_dump", "-log_view",     "-log_all",     "-log",         "-log_trace",   "-log_view_memory"};
    return std::ranges::find(last, name) != last.end();
}

/// What is often wanted, to find what was meant; all may follow "potential_" and "flow_".
const std::vector<std::string>& well_known() {
    static const std::vector<std::string> names = {
        "ksp_type", "ksp_rtol", "ksp_atol", "ksp_divtol", "ksp_max_it", "ksp_monitor", "ksp_view",
        "ksp_converged_reason", "ksp_monitor_true_residual", "ksp_gmres_restart", "ksp_norm_type", "ksp_pc_side",
        "ksp_initial_guess_nonzero", "ksp_view_mat", "ksp_view_rhs", "pc_type", "pc_factor_levels",
        "pc_factor_mat_ordering_type", "pc_factor_mat_solver_type", "pc_factor_fill", "pc_factor_shift_type",
        "pc_gamg_type", "pc_gamg_threshold", "pc_gamg_agg_nsmooths", "pc_hypre_type",
        "pc_hypre_boomeramg_coarsen_type", "pc_hypre_boomeramg_interp_type", "pc_hypre_boomeramg_P_max",
        "pc_hypre_boomeramg_strong_threshold", "pc_hypre_boomeramg_agg_nl", "pc_hypre_boomeramg_max_iter",
        "pc_sor_omega", "pc_asm_overlap", "pc_bjacobi_blocks", "sub_pc_type", "sub_ksp_type",
        "sub_pc_factor_levels", "mg_levels_ksp_type", "mg_levels_pc_type", "mg_coarse_pc_type", "log_view",
        "options_left", "malloc_dump"};
    return names;
}

std::string meant(const std::string& name) {
    constexpr std::array<std::string_view, 2> prefixes = {"-potential_", "-flow_"};
    if (name.find("out") == 1 || name.find("res") == 1 || name.find("thr") == 1)
        return fmt::format("; did you mean \"-{}\"?", name);
    const auto* const known_prefix =
        std::ranges::find_if(prefixes, [&](std::string_view prefix) { return name.starts_with(prefix); });
    const std::string_view prefix = known_prefix == prefixes.end() ? "-" : *known_prefix;
    const std::string word = name.substr(prefix.size());
    const auto far = [&](const std::string& known) { return edit_distance(word, known); };
    const std::string& nearest = *std::ranges::min_element(well_known(), {}, far);
    if (far(nearest) > std::max(1, static_cast<int>(word.size()) / 3)) return "";
    return fmt::format("; did you mean \"{}{}\"?", prefix, nearest);
}

bool used(const SolverOption& option) {  // PETSc lists them without the dash
    PetscBool asked = PETSC_FALSE;
    check(PetscOptionsUsed(nullptr, option.name.c_str() + 1, &asked));
    return asked == PETSC_TRUE || asked_at_the_end(option.name);
}

/// As if nobody had asked yet.
void set_anew(const SolverOption& option) {
    check(PetscOptionsClearValue(nullptr, option.name.c_str()));
    check(PetscOptionsSetValue(nullptr, option.name.c_str(), option.value.empty() ? nullptr : option.value.c_str()));
}

void refuse_value(const std::vector<SolverOption>& options, const std::string& said) {
    for (const SolverOption& option : options)
        if (!option.value.empty() && said.find(option.value) != std::string::npos)
            throw CaseError(fmt::format("{} {}: this value is not taken ({})", option.name, option.value, said));
    throw CaseError(fmt::format("the solver's options are not taken ({})", said));
}

}  // namespace

void check_solver_options(const std::vector<std::string>& words) {
    const std::vector<SolverOption> options = pairs(words);
    if (options.empty()) return;
    try {
        rehearse({PETSC_COMM_SELF, 0, 1});
        rehearse_flow({PETSC_COMM_SELF, 0, 1});
    } catch (const SolverError& error) {
        refuse_value(options, error.what());
    }
    for (const SolverOption& option : options)
        if (!used(option) && !asked_on_the_way(option.name))
            throw CaseError(fmt::format("{} is no option of the solver's, or not one of the kinds that are chosen{}",
                                        option.name, meant(option.name)));
    for (const SolverOption& option : options)
        if (!asked_at_the_end(option.name)) set_anew(option);
}

std::vector<std::string> unused_solver_options(const std::vector<std::string>& words) {
    std::vector<std::string> unused;
    for (const SolverOption& option : pairs(words))
        if (!used(option)) unused.push_back(option.name);
    return unused;
}

}  // namespace kropla
