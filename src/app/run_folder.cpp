#include "app/run_folder.h"

#include "base/error.h"

#include <fmt/format.h>

#include <array>

namespace kropla {

void check_run_folder(const RunOptions& options) {
    const std::filesystem::path& folder = options.out;
    if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder)) {
        throw FileError(fmt::format("{}: is a file; --out must name a folder", folder.string()));
    }
    if (options.resume) {
        if (std::filesystem::exists(folder / checkpoint_name)) return;
        throw CaseError(fmt::format("{}: has no {} to resume from; leave --resume out to start the run",
                                    folder.string(), checkpoint_name));
    }
    if (std::filesystem::exists(folder / checkpoint_name)) {
        throw CaseError(
            fmt::format("{}: holds a run already; add --resume to go on with it, or name another folder "
                        "with --out",
                        folder.string()));
    }
    constexpr std::array<const char*, 3> traces = {"case.toml", "steps.csv", "frames.pvd"};
    for (const char* trace : traces) {
        if (!std::filesystem::exists(folder / trace)) continue;
        throw CaseError(fmt::format("{}: holds {}, but no {} to go on from; name another folder with --out",
                                    folder.string(), trace, checkpoint_name));
    }
}

}  // namespace kropla
