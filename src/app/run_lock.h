#pragma once

#include <filesystem>
#include <vector>

namespace kropla {

/// A run's hold on its folder, from construction to destruction or the end of the process, however it ends: a lock of
/// the system on the file run.lock in it, which is gone afterwards. The folder is made where it is missing, and goes
/// again if nothing has come into it.
class RunLock {
public:
    /// Throws CaseError, naming process and machine, if another process holds the folder; FileError if it cannot be
    /// made or locked.
    explicit RunLock(std::filesystem::path folder);
    ~RunLock();
    RunLock(const RunLock&) = delete;
    RunLock& operator=(const RunLock&) = delete;

private:
    std::filesystem::path file_;
    std::vector<std::filesystem::path> made_;  // folders, the outermost first
    int descriptor_ = -1;
};

}  // namespace kropla
