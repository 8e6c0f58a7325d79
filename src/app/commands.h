#pragma once

#include <string>
#include <vector>

namespace kropla {

/// What the program's exit codes mean.
enum ExitCode : int {
    done = 0,
    bad_case = 2,  // arguments or case
    floors_unreachable = 3,
    solver_failed = 4,
    file_trouble = 5,
    resources_used_up = 6,  // memory, threads
    internal_error = 70,    // our own mistake
    interrupted = 130,      // with a checkpoint written, if there was a first mesh
};

/// Does what the arguments (without the program's name) ask for. Results go to stdout; what went wrong goes
/// to stderr as one line, "kropla: ...". Returns the exit code.
[[nodiscard]] int execute(std::vector<std::string> arguments);

/// The arguments parted: PETSc's options, such as -ksp_type, each with the value that follows it; and the
/// rest.
struct PartedArguments {
    std::vector<std::string> solver, others;
};
[[nodiscard]] PartedArguments part_arguments(const std::vector<std::string>& arguments);

}  // namespace kropla
