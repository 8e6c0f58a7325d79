#include "case/same_case.h"

#include "case/parameters.h"
#include <kropla/base/error.h>
#include "io/file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cctype>
#include <cmath>
#include <cstdint>

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

bool names_file(std::string_view key) { return key == "domain.mesh" || (key.starts_with("body[") && key.ends_with("].file")); }

/// Is the value a name, rather than a formula?
bool is_name(std::string_view key) {
    return key.ends_with(".name") || key.ends_with(".shape") || key.ends_with(".region") || names_file(key);
}

/// [Fowler, Noll, Vo] FNV-1a; as many bits of it as a double holds.
double fingerprint(std::string_view bytes) {
    std::uint64_t hash = 14695981039346656037u;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
    return static_cast<double>(hash >> 11);
}

/// How a value is written, and which number that is: empty if it is none.
struct Value {
    std::string wording, number;
};

bool are_same(const Value& a, const Value& b) {
    return a.wording == b.wording || (!a.number.empty() && a.number == b.number);
}

Value formula_value(const std::string& text, const Constants& parameters) {
    try {
        return {plain_formula(text), fmt::format("{}", Expression(text, Variables::none, parameters)(0))};
    } catch (const CaseError&) {  // of variables as well, or none at all
        return {plain_formula(text), {}};
    }
}

/// All values by their full keys.
class Values {
public:
    explicit Values(std::string_view text) {
        const toml::table table = toml::parse(text);
        CaseReading reading;
        const CaseTable file(reading, "", table);
        if (file.has("parameters")) read_parameters(file.table("parameters"), reading);
        parameters_ = std::move(reading.parameters);
        flatten(table, "");
    }
    [[nodiscard]] const std::map<std::string, Value>& by_key() const { return values_; }
    [[nodiscard]] Value of(const std::string& key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? Value{"nothing", {}} : found->second;
    }

private:
    void flatten(const toml::node& node, const std::string& key) {
        const std::string dot = key.empty() ? "" : ".";
        if (const toml::table* table = node.as_table()) {
            for (const auto& [name, value] : *table) flatten(value, key + dot + std::string(name.str()));
        } else if (const toml::array* array = node.as_array()) {
            for (std::size_t i = 0; i < array->size(); ++i) flatten(*array->get(i), fmt::format("{}[{}]", key, i));
        } else if (const auto text = node.value_exact<std::string>()) {
            values_[key] = is_name(key) ? Value{*text, {}} : formula_value(*text, parameters_);
        } else if (const auto whole = node.value_exact<std::int64_t>()) {
            values_[key] = {fmt::format("{}", *whole), fmt::format("{}", *whole)};
        } else if (const auto number = node.value<double>()) {
            values_[key] = {fmt::format("{}", *number), fmt::format("{}", *number)};
        }
    }

    Constants parameters_;
    std::map<std::string, Value> values_;
};

TimePlan plan_of(std::string_view text) { return parse_case(text, "the case as run").time; }

/// The steps of the run's length until the end.
int steps_until(double end, double length) {
    return static_cast<int>(std::clamp(std::ceil(end / length * (1 - same_length)), 1.0, 1e9));
}

void go_on_to_end(Case& given, const RunSoFar& run, const std::string& file) {
    const TimePlan plan = plan_of(run.case_text);
    const double length = plan.end / plan.steps;
    if (given.time.end < run.time * (1 - same_length))
        throw CaseError(fmt::format("{}: time.end: {} is past already: the run has reached {}; a later one does", file,
                                    given.time.end, run.time));
    if (std::abs(given.time.end / given.time.steps - length) <= same_length * length) return;
    const int fitting = given.time.end == plan.end ? plan.steps : steps_until(given.time.end, length);
    if (given.time.steps != plan.steps && given.time.steps != run.steps_given)
        throw CaseError(fmt::format("{}: time.steps: {} make steps of {:.4g} s, those of the run so far are of {:.4g} s; {} "
                                    "does", file, given.time.steps, given.time.end / given.time.steps, length, fitting));
    given.time.steps = fitting;
    given.written_numbers.erase("time.steps");
}

}  // namespace

std::vector<CaseDifference> differences(std::string_view first, std::string_view second) {
    const Values a(first), b(second);
    std::map<std::string, Value> all = a.by_key();
    all.insert(b.by_key().begin(), b.by_key().end());
    std::vector<CaseDifference> found;
    for (const auto& [key, value] : all)
        if (!are_same(a.of(key), b.of(key))) found.push_back({key, a.of(key).wording, b.of(key).wording});
    return found;
}

FileContents contents_of_files(std::string_view case_text) {
    FileContents contents;
    const Values values(case_text);
    for (const auto& [key, value] : values.by_key())
        if (names_file(key)) contents[key] = fingerprint(read_file(value.wording));
    return contents;
}

void go_on_with(Case& given, const RunSoFar& run, const std::string& file, const std::string& folder) {
    const std::string text = to_toml(given);
    const Values had(run.case_text), has(text);
    for (const auto& [key, contents] : contents_of_files(text))
        if (const auto of_run = run.files.find(key);
            of_run != run.files.end() && of_run->second != contents && are_same(had.of(key), has.of(key)))
            throw CaseError(fmt::format("{}: {}: {} is not the file that the run in {} was begun with; with that it goes on, "
                                        "or begins anew with --force", file, key, has.of(key).wording, folder));
    for (const auto& [key, was, now] : differences(run.case_text, text)) {
        if (key == "output.every" || key == "time.end" || key == "time.steps") continue;
        throw CaseError(fmt::format("{}: {}: is {} here, but {} in the run that {} holds; only time.end and output.every "
                                    "may change", file, key, now, was, folder));
    }
    go_on_to_end(given, run, file);
}

}  // namespace kropla
