#pragma once

#include "case/case.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// A key that two cases have different values for, as each has it written; "nothing" where it is not given.
struct CaseDifference {
    std::string key, first, second;
};

/// Compares two cases, as to_toml writes them, key by key: numbers, and formulas of parameters alone, by value; other
/// formulas but for their blanks.
[[nodiscard]] std::vector<CaseDifference> differences(std::string_view first, std::string_view second);

/// Of each file that the case, as to_toml writes it, names, by the key that names it: a number that other contents hardly have.
using FileContents = std::map<std::string, double>;
/// Throws FileError if one cannot be read.
[[nodiscard]] FileContents contents_of_files(std::string_view case_text);

/// What a run remembers of the steps asked for: the case given when it was begun or last resumed, whose step length
/// it keeps.
struct RunSoFar {
    std::string case_text;  // as it ran, by to_toml
    int steps_given = 0;    // time.steps in the case file that was given; 0: as in the case
    double time = 0;        // [s] reached
    FileContents files = {};  // as they were when it was begun
};

/// Makes `it` a case with which the run can go on: everything that the steps taken so far have come from is as it
/// was. The end may be another one that is not yet past; steps keep their length, so that `time.steps` follows where
/// it is left as it was given. How often frames are written may change. Throws CaseError, naming the first key that
/// differs otherwise and both values, or whose file holds something else; FileError if that cannot be read. `file` names the
/// case file, `folder` the run's.
void go_on_with(Case& given, const RunSoFar& run, const std::string& file, const std::string& folder);

}  // namespace kropla
