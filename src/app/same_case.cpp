#include "app/same_case.h"

#include <kropla/base/error.h>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cctype>
#include <cmath>
#include <map>

namespace kropla {
namespace {

constexpr double same_length = 1e-9;  // [-] of a step: what decimal fractions of the end leave

/// A formula without its blanks; one that is a number only, as that number is written shortest.
std::string plain_formula(std::string text) {
    std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end ? fmt::format("{}", number) : text;
}

bool is_name(std::string_view key) { return key.ends_with(".name") || key.ends_with(".shape"); }

/// All values by their full keys.
void flatten(const toml::node& node, const std::string& key, std::map<std::string, std::string>& values) {
    const std::string dot = key.empty() ? "" : ".";
    if (const toml::table* table = node.as_table()) {
        for (const auto& [name, value] : *table) flatten(value, key + dot + std::string(name.str()), values);
    } else if (const toml::array* array = node.as_array()) {
        for (std::size_t i = 0; i < array->size(); ++i) flatten(*array->get(i), fmt::format("{}[{}]", key, i), values);
    } else if (const auto text = node.value_exact<std::string>()) {
        values[key] = is_name(key) ? *text : plain_formula(*text);
    } else if (const auto whole = node.value_exact<std::int64_t>()) {
        values[key] = fmt::format("{}", *whole);
    } else if (const auto number = node.value<double>()) {
        values[key] = fmt::format("{}", *number);
    }
}

std::map<std::string, std::string> values_of(std::string_view text) {
    std::map<std::string, std::string> values;
    flatten(toml::parse(text), "", values);
    return values;
}

TimePlan plan_of(std::string_view text) {
    const toml::table table = toml::parse(text);
    return {table["time"]["end"].value_or(0.0), table["time"]["steps"].value_or(0)};
}

/// The steps of the run's length until the end.
int steps_until(double end, double length) {
    return static_cast<int>(std::clamp(std::ceil(end / length * (1 - same_length)), 1.0, 1e9));
}

void go_on_to_end(Case& it, const RunSoFar& run, const std::string& file) {
    const TimePlan plan = plan_of(run.case_text);
    const double length = plan.end / plan.steps;
    if (it.time.end < run.time * (1 - same_length))
        throw CaseError(fmt::format("{}: time.end: {} is past already: the run has reached {}; a later one does", file,
                                    it.time.end, run.time));
    if (std::abs(it.time.end / it.time.steps - length) <= same_length * length) return;
    const int fitting = it.time.end == plan.end ? plan.steps : steps_until(it.time.end, length);
    if (it.time.steps != plan.steps && it.time.steps != run.steps_given)
        throw CaseError(fmt::format("{}: time.steps: {} make steps of {:.4g} s, those of the run so far are of {:.4g} s; {} "
                                    "does", file, it.time.steps, it.time.end / it.time.steps, length, fitting));
    it.time.steps = fitting;
}

}  // namespace

std::vector<CaseDifference> differences(std::string_view first, std::string_view second) {
    const auto a = values_of(first), b = values_of(second);
    const auto shown = [](const auto& values, const std::string& key) {
        const auto found = values.find(key);
        return found == values.end() ? "nothing" : found->second;
    };
    std::map<std::string, std::string> all = a;
    all.insert(b.begin(), b.end());
    std::vector<CaseDifference> found;
    for (const auto& [key, value] : all)
        if (shown(a, key) != shown(b, key)) found.push_back({key, shown(a, key), shown(b, key)});
    return found;
}

void go_on_with(Case& it, const RunSoFar& run, const std::string& file, const std::string& folder) {
    for (const auto& [key, had, given] : differences(run.case_text, to_toml(it))) {
        if (key == "output.every" || key == "time.end" || key == "time.steps") continue;
        throw CaseError(fmt::format("{}: {}: is {} here, but {} in the run that {} holds; only time.end and output.every "
                                    "may change", file, key, given, had, folder));
    }
    go_on_to_end(it, run, file);
}

}  // namespace kropla
