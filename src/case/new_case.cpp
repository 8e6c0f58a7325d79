#include "case/new_case.h"

#include <kropla/base/error.h>
#include "io/file.h"

#include <fmt/format.h>

namespace kropla {

std::filesystem::path write_new_case(const std::string& name) {
    std::filesystem::path path = name;
    if (path.extension() != ".toml") path += ".toml";
    if (std::filesystem::exists(path)) {
        throw CaseError(fmt::format("{}: is there already; choose another name", path.string()));
    }
    write_file(path, starting_case());
    return path;
}

}  // namespace kropla
