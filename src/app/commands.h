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
    interrupted = 130,  // with a checkpoint written
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
