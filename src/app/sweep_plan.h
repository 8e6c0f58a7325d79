#pragma once

#include <span>
#include <string>
#include <vector>

namespace kropla {

/// One run of a sweep.
struct SweepRun {
    std::string name;                 // of its folder: "current=100", "current=100,d=2e-3"
    std::vector<std::string> values;  // one per key of the sweep

    bool operator==(const SweepRun&) const = default;
};

struct SweepPlan {
    std::vector<std::string> keys;  // as they are set
    std::vector<SweepRun> runs;     // all combinations; the last key changes first
};

/// The most runs that a sweep may have: one table and one page of them are still read.
inline constexpr std::size_t most_runs = 1000;

/// The runs that are meant by settings "key=value", of which some have a list of values, "key=100,150,200". Folders are
/// named by the keys with a list; what is hard to have in a name is written %XX. Throws CaseError if no setting has a
/// list, a list has a value twice or an empty one, a key is set twice, or there are too many combinations.
[[nodiscard]] SweepPlan plan_sweep(std::span<const std::string> settings);

/// "key=value" for each key of the plan, as the run is told.
[[nodiscard]] std::vector<std::string> settings_of(const SweepPlan& plan, const SweepRun& run);

}  // namespace kropla
