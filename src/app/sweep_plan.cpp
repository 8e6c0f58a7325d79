// Which runs a sweep has, and how their folders are called.
#include "app/sweep_plan.h"

#include "case/setting.h"
#include <kropla/base/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kropla {
namespace {

struct Swept {
    std::string key;
    std::vector<std::string> values;
};

[[noreturn]] void refuse(const std::string& setting, std::string_view what) {
    throw CaseError(fmt::format("--set {}: {}", setting, what));
}

/// A part of a folder's name: without blanks and quotes, of which the meaning is clear; %XX for what a path or a
/// shell has another meaning for, so that different values have different names.
std::string in_name(std::string_view text) {
    std::string name;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == ' ') continue;
        const bool is_plain = std::isalnum(code) != 0 || std::string_view("._+-=,[]").find(c) != std::string_view::npos;
        name += is_plain || code >= 0x80 ? std::string(1, c) : fmt::format("%{:02X}", code);
    }
    return name;
}

Swept swept_by(const std::string& setting) {
    const auto [key, value] = parted_setting(setting);
    Swept swept{key, values_of_list(value)};
    std::vector<std::string> seen;
    for (const std::string& each : swept.values) {
        if (in_name(each).empty()) refuse(setting, "a value of the list is empty");
        if (std::ranges::find(seen, in_name(each)) != seen.end())
            refuse(setting, fmt::format("{} stands there twice", each));
        seen.push_back(in_name(each));
    }
    return swept;
}

void check(const std::vector<Swept>& all) {
    std::size_t count = 1;
    std::vector<std::string> lists;
    for (const Swept& swept : all) {
        if (std::ranges::count(all, swept.key, &Swept::key) > 1)
            throw CaseError(fmt::format("--set {}: is set twice", swept.key));
        if (swept.values.size() == 1) continue;
        count = std::min(count, most_runs) * swept.values.size();  // beyond, it need not be exact
        lists.push_back(fmt::format("{} of {}", swept.values.size(), swept.key));
    }
    if (lists.empty())
        throw CaseError("--set: a sweep needs a list of values, such as --set size.surface=1e-4,2e-4; kropla run takes "
                        "one");
    if (count > most_runs)
        throw CaseError(fmt::format("--set: {} values are too many combinations; at most {} runs are made",
                                    fmt::join(lists, " by "), most_runs));
}

std::string name_of(const std::vector<Swept>& all, const std::vector<std::string>& values) {
    std::string name;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k].values.size() > 1)
            name += (name.empty() ? "" : ",") + in_name(all[k].key) + "=" + in_name(values[k]);
    return name;
}

}  // namespace

SweepPlan plan_sweep(std::span<const std::string> settings) {
    std::vector<Swept> all;
    std::ranges::transform(settings, std::back_inserter(all), swept_by);
    check(all);
    std::vector<std::vector<std::string>> combinations(1);
    SweepPlan plan;
    for (const Swept& swept : all) {
        plan.keys.push_back(swept.key);
        std::vector<std::vector<std::string>> longer;
        for (const auto& combination : combinations)
            for (const std::string& value : swept.values) {
                longer.push_back(combination);
                longer.back().push_back(value);
            }
        combinations = std::move(longer);
    }
    for (auto& values : combinations) plan.runs.push_back({name_of(all, values), values});
    return plan;
}

std::vector<std::string> settings_of(const SweepPlan& plan, const SweepRun& run) {
    std::vector<std::string> settings;
    for (std::size_t k = 0; k < plan.keys.size(); ++k) settings.push_back(plan.keys[k] + "=" + run.values[k]);
    return settings;
}

}  // namespace kropla
