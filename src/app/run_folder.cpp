#include "app/run_folder.h"

#include <kropla/base/error.h>
#include "report/run_files.h"

#include <fmt/format.h>

#include <vector>

namespace kropla {

void check_run_folder(const RunOptions& options) {
    const std::filesystem::path& folder = options.out;
    if (folder.empty()) throw CaseError("--out: names no folder; \".\" is the one you are in");
    if (options.resume && options.force) throw CaseError("--resume goes on with a run and --force overwrites it: choose one");
    if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder)) {
        throw FileError(fmt::format("{}: is a file; --out must name a folder", folder.string()));
    }
    if (options.resume) {
        if (std::filesystem::exists(folder / checkpoint_name)) return;
        throw CaseError(fmt::format("{}: has no {} to resume from; leave --resume out to start the run",
                                    folder.string(), checkpoint_name));
    }
    if (options.force) return;
    if (std::filesystem::exists(folder / checkpoint_name)) {
        throw CaseError(
            fmt::format("{}: holds a run already; add --resume to go on with it or --force to overwrite it, or name "
                        "another folder with --out",
                        folder.string()));
    }
    for (const char* trace : {"case.toml", "steps.csv", "frames.pvd"}) {
        if (!std::filesystem::exists(folder / trace)) continue;
        throw CaseError(fmt::format("{}: holds {}, but no {} to go on from; add --force to overwrite it, or name another "
                                    "folder with --out",
                                    folder.string(), trace, checkpoint_name));
    }
}

void clear_run_folder(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::vector<fs::path> files;
    for (const char* name : {checkpoint_name, "case.toml", "steps.csv", "bodies.csv", "frames.pvd", "report.html",
                             ending_name, ending_mesh_name})
        files.push_back(folder / name);
    std::error_code none;
    for (const auto& frame : fs::directory_iterator(folder / "frames", none))
        if (frame.path().extension() == ".vtu") files.push_back(frame.path());
    for (const fs::path& file : files) {
        std::error_code trouble;
        fs::remove(file, trouble);
        if (trouble) throw FileError(fmt::format("{}: cannot be removed: {}", file.string(), trouble.message()));
    }
}

}  // namespace kropla
