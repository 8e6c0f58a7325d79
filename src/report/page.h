#pragma once

#include <kropla/base/watch.h>

#include <filesystem>

namespace kropla {

struct PageOptions {
    bool cuts = true;              // false: without what only the frames tell, for which they are to be read again
    const Watch* watch = nullptr;  // may end the work, which throws Interrupted then
};

/// Writes DIR/report.html, "the run on one page", from the files that a run leaves: case.toml, steps.csv,
/// frames.pvd and three of the frames; ended.toml and ended.vtu if it ended early, which it begins with then.
/// The page needs nothing but itself. It also shows a run that is not finished. Throws FileError, naming the file, if
/// one is missing or broken, or the page cannot be written; Interrupted if the watch says so: then the page is as it was.
void write_report(const std::filesystem::path& dir, const PageOptions& options = {});

}  // namespace kropla
