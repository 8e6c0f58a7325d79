#pragma once

#include "temporary_folder.h"

#include <string>
#include <string_view>
#include <sys/wait.h>

namespace kropla {

/// What the built program did: exit code, and what it wrote.
struct Outcome {
    int code;
    std::string out, err;
};

/// `arguments` are the shell's; the program runs in `folder`, without a terminal.
inline Outcome kropla_program(const TemporaryFolder& folder, const std::string& arguments) {
    const std::string command = "cd '" + folder.path.string() + "' && '" KROPLA_PROGRAM "' " + arguments +
                                " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder.path / "out.txt"),
            contents(folder.path / "err.txt")};
}

}  // namespace kropla
