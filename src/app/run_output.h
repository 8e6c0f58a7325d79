#pragma once

#include "app/progress.h"
#include "app/run.h"
#include "app/step_row.h"

#include <kropla/io/checkpoint.h>
#include <kropla/io/pvd.h>
#include <kropla/mesh/quality.h>

#include <optional>
#include <vector>

namespace kropla {

/// Whether the run in the folder has written the frame of this step. Throws FileError.
[[nodiscard]] bool has_frame(const std::filesystem::path& folder, std::int64_t step);

/// What a run leaves in its folder and says on the way. On ranks that do not `speak`, nothing.
class RunOutput {
public:
    /// Starts the folder with the case, or continues it after `step`; later frames and rows, which a run that was
    /// ended left behind its checkpoint, are dropped. Throws FileError.
    RunOutput(const RunOptions& options, const Case& given, bool speak, std::int64_t step, const State& state,
              Progress& progress);

    void write_step(std::int64_t step, const StepReport& report, const State& state);
    /// Throws Interrupted if the watch says so: then there is no such frame.
    void write_frame(std::int64_t step, const State& state, const Watch* watch);
    void write_checkpoint(const Checkpoint& checkpoint);
    /// Why the run ends early, with the mesh as it was last (`report_end`).
    void write_end(const std::exception& why, const Mesh& mesh);
    void show_progress(std::int64_t step, const StepReport& report, double seconds_left);
    void say(const std::string& line) { progress_.say(line); }

private:
    void start(const State& state);
    void go_on(std::int64_t step, const State& state);

    bool overwrite_;
    std::filesystem::path folder_;
    const Case& given_;
    bool speak_;
    std::vector<SeriesEntry> series_;
    std::optional<StepsTable> table_;
    std::optional<QualitySummary> quality_;  // after the last step
    Progress& progress_;
};

}  // namespace kropla
