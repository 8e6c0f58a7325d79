// Reading the tables of a case file, and the one-line refusals of what is wrong in them.
#include "case/table.h"

#include <kropla/base/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace kropla {
namespace {

bool is_length(double value) { return value >= least_length && value <= most_length; }

/// A value as a refusal shows it.
std::string shown(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return toml_text(*text);
    if (const auto whole = node.value_exact<std::int64_t>()) return fmt::format("{}", *whole);
    if (const auto number = node.value<double>(); number && node.is_number())
        return fmt::format("{}", *number);
    if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
    if (node.is_table()) return "a table";
    if (const toml::array* array = node.as_array()) {
        std::vector<std::string> items;
        for (const toml::node& item : *array) items.push_back(shown(item));
        return fmt::format("[{}]", fmt::join(items, ", "));
    }
    return "a date or time";
}

bool comes_from_file(const CaseReading& reading, const toml::source_region& at) {
    return !at.path || *at.path == reading.file;
}

/// Where something stands: "FILE: body[0].radius (line 12)", or what it comes from if that is not the file.
std::string origin(const CaseReading& reading, const toml::source_region& at, const std::string& name) {
    return comes_from_file(reading, at) ? fmt::format("{}: {} (line {})", reading.file, name, at.begin.line) : *at.path;
}

std::optional<double> finite_number(const toml::node& node) {
    if (!node.is_number()) return {};
    if (const auto whole = node.value_exact<std::int64_t>()) return static_cast<double>(*whole);  // however large
    const auto number = node.value<double>();
    return number && std::isfinite(*number) ? number : std::nullopt;
}

}  // namespace

CaseTable::CaseTable(CaseReading& reading, std::string name, const toml::table& table)
    : reading_(&reading), name_(std::move(name)), table_(&table) {}

void CaseTable::allow(std::initializer_list<std::string_view> keys) const {
    allow(std::vector<std::string>(keys.begin(), keys.end()));
}

void CaseTable::allow(const std::vector<std::string>& keys) const {
    const toml::key* first = nullptr;  // in the file
    for (const auto& [key, value] : *table_) {
        if (std::ranges::find(keys, key.str()) != keys.end()) continue;
        if (first == nullptr || key.source().begin < first->source().begin) first = &key;
    }
    if (first == nullptr) return;
    throw CaseError(fmt::format("{}: unknown key; {}", origin(*reading_, first->source(), full_name(first->str())),
                                suggestion(first->str(), keys)));
}

std::vector<std::string> CaseTable::keys() const {
    std::vector<toml::key> keys;
    for (const auto& [key, value] : *table_) keys.push_back(key);
    std::ranges::stable_sort(keys, {}, [](const toml::key& key) {
        return std::pair(key.source().begin.line, key.source().begin.column);
    });
    std::vector<std::string> names;
    for (const toml::key& key : keys) names.emplace_back(key.str());
    return names;
}

bool CaseTable::has(std::string_view key) const { return table_->contains(key); }
bool CaseTable::holds_text(std::string_view key) const { return has(key) && table_->get(key)->is_string(); }
bool CaseTable::holds_table(std::string_view key) const { return has(key) && table_->get(key)->is_table(); }

double CaseTable::number(std::string_view key, std::string_view must) const {
    constexpr std::string_view finite = "must be a finite number";
    const auto value = number_in(key, node(key, must), finite);
    if (!value) refuse_value(key, finite);
    remember(key);
    return *value;
}

/// A number that stands there, or the value of an expression of parameters.
std::optional<double> CaseTable::number_in(std::string_view key, const toml::node& value, std::string_view must) const {
    const auto text = value.value_exact<std::string>();
    if (!text) return finite_number(value);
    try {
        const double number = compiled(*text, Variables::none)(0);
        if (!std::isfinite(number))
            throw CaseError(
                fmt::format("{}, which is {}", toml_text(*text), std::isnan(number) ? "not a number" : "infinite"));
        return number;
    } catch (const CaseError& error) {
        refuse(key, fmt::format("{}, got {}", must, error.what()));
    }
}

/// Keeps how the numbers of a key are written, where they are expressions.
void CaseTable::remember(std::string_view key) const {
    const toml::node& value = *table_->get(key);
    const toml::array* array = value.as_array();
    if (value.is_string() ||
        (array != nullptr && std::ranges::any_of(*array, [](const toml::node& item) { return item.is_string(); })))
        reading_->written[full_name(key)] = shown(value);
}

double CaseTable::number(std::string_view key) const { return number(key, "must be a finite number"); }

double CaseTable::positive(std::string_view key) const {
    const double value = number(key, "must be positive");
    if (!(value > 0)) refuse_value(key, "must be positive");
    return value;
}

std::int64_t CaseTable::integer(std::string_view key, std::int64_t least, std::int64_t most) const {
    const std::string must = fmt::format("must be a whole number from {} to {}", least, most);
    const toml::node& given = node(key, must);
    auto value = given.value_exact<std::int64_t>();
    if (given.is_string()) {
        const double number = *number_in(key, given, must);
        constexpr double exact = 9007199254740992;  // up to here, all whole numbers are doubles
        if (number != std::floor(number) || std::abs(number) > exact)
            refuse(key, fmt::format("{}, got {} = {}", must, shown(given), number));
        value = static_cast<std::int64_t>(number);
        remember(key);
    } else if (const auto number = finite_number(given); number && !value && *number == std::floor(*number))
        refuse(key, fmt::format("{}, got {:.1f}, which has a fraction to TOML; write {:.0f}", must, *number, *number));
    if (!value || *value < least || *value > most) refuse_value(key, must);
    return *value;
}

std::string CaseTable::text(std::string_view key) const {
    const auto value = node(key, "must be a text in quotes").value_exact<std::string>();
    if (!value) refuse_value(key, "must be a text in quotes");
    return *value;
}

bool CaseTable::truth(std::string_view key) const {
    const auto value = node(key, "must be true or false").value_exact<bool>();
    if (!value) refuse_value(key, "must be true or false");
    return *value;
}

std::vector<std::string> CaseTable::texts(std::string_view key, std::string_view meaning) const {
    const std::string must = fmt::format("must be texts in brackets, {}", meaning);
    const toml::array* array = node(key, must).as_array();
    if (array == nullptr) refuse_value(key, must);
    std::vector<std::string> all;
    for (const toml::node& item : *array) {
        const auto text = item.value_exact<std::string>();
        if (!text) refuse_value(key, must);
        all.push_back(*text);
    }
    return all;
}

std::vector<double> CaseTable::numbers(std::string_view key, std::size_t count,
                                       std::string_view meaning) const {
    const std::string must = fmt::format("must be {} finite numbers {}", count, meaning);
    std::vector<double> values;
    const toml::array* array = node(key, must).as_array();
    for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
        if (const auto value = number_in(key, *array->get(i), must)) values.push_back(*value);
    }
    if (array == nullptr || values.size() != count || array->size() != count) refuse_value(key, must);
    remember(key);
    return values;
}

std::vector<double> CaseTable::all_numbers(std::string_view key, std::string_view meaning) const {
    const std::string must = fmt::format("must be finite numbers in brackets: {}", meaning);
    const toml::array* array = node(key, must).as_array();
    if (array == nullptr) refuse_value(key, must);
    return numbers(key, array->size(), meaning);
}

double CaseTable::length(std::string_view key) const {
    const double value = positive(key);
    if (!is_length(value)) refuse_value(key, fmt::format("must be from {:g} to {:g} m", least_length, most_length));
    return value;
}

Vec3 CaseTable::lengths(std::string_view key) const {
    const std::vector<double> v = numbers(key, 3, "[x, y, z]");
    if (!std::ranges::all_of(v, [](double x) { return x > 0; })) refuse_value(key, "must all be positive");
    if (!std::ranges::all_of(v, is_length))
        refuse_value(key, fmt::format("must all be from {:g} to {:g} m", least_length, most_length));
    return {v[0], v[1], v[2]};
}

Vec3 CaseTable::place(std::string_view key) const {
    const std::vector<double> v = numbers(key, 3, "[x, y, z]");
    if (!std::ranges::all_of(v, [](double x) { return std::abs(x) <= most_length; }))
        refuse_value(key, fmt::format("must be within {:g} m of the origin", most_length));
    return {v[0], v[1], v[2]};
}

Formula CaseTable::formula(std::string_view key, Variables variables, const Vec3& probe) const {
    constexpr std::string_view must = "must be a finite number or an expression in quotes";
    return formula(key, node(key, must), must, variables, probe);
}

Formula CaseTable::formula(std::string_view key, const toml::node& value, std::string_view must,
                           Variables variables, const Vec3& probe) const {
    if (const auto constant = finite_number(value)) {
        const std::string written = toml_number(*constant);
        return {Expression(written, variables), written};
    }
    const auto text = value.value_exact<std::string>();
    if (!text) refuse_value(key, must);
    Expression expression = [&] {
        try {
            return compiled(*text, variables);
        } catch (const CaseError& error) {
            refuse(key, error.what());
        }
    }();
    const double at_start = expression(0, probe);
    if (variables != Variables::temperature && !std::isfinite(at_start)) {
        refuse(key, fmt::format("must be finite, but {} is {} at t = 0", toml_text(*text),
                                std::isnan(at_start) ? "not a number" : "infinite"));
    }
    return {std::move(expression), toml_text(*text)};
}

Expression CaseTable::expression(std::string_view key, Variables variables) const {
    try {
        Expression found = compiled(text(key), variables);
        remember(key);
        return found;
    } catch (const CaseError& error) {
        refuse(key, error.what());
    }
}

std::vector<Formula> CaseTable::formulas(std::string_view key, std::size_t count, std::string_view meaning,
                                         Variables variables) const {
    const std::string must = fmt::format("must be {} finite numbers or expressions in quotes {}", count, meaning);
    const toml::array* array = node(key, must).as_array();
    if (array == nullptr || array->size() != count) refuse_value(key, must);
    std::vector<Formula> all;
    for (const toml::node& item : *array) all.push_back(formula(key, item, must, variables, {}));
    return all;
}

Expression CaseTable::compiled(const std::string& text, Variables variables) const {
    Expression expression(text, variables, reading_->parameters);
    for (const std::string& name : names_in(text))
        if (reading_->parameters.contains(name)) reading_->used.insert(name);
    return expression;
}

CaseTable CaseTable::table(std::string_view key) const {
    const std::string must = fmt::format("must be a table [{}]", full_name(key));
    const toml::table* table = node(key, must).as_table();
    if (table == nullptr) refuse_value(key, must);
    return {*reading_, full_name(key), *table};
}

std::vector<CaseTable> CaseTable::tables(std::string_view key) const {
    std::vector<CaseTable> found;
    if (!has(key)) return found;
    const toml::array* array = table_->get(key)->as_array();
    if (array == nullptr || (!array->empty() && !array->is_homogeneous(toml::node_type::table))) {
        refuse_value(key, fmt::format("must be tables, each under [[{}]]", full_name(key)));
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
        found.emplace_back(*reading_, fmt::format("{}[{}]", full_name(key), i), *array->get(i)->as_table());
    }
    return found;
}

std::string CaseTable::refusal(std::string_view key, std::string_view what) const {
    if (const toml::node* value = table_->get(key))
        return fmt::format("{}: {}", origin(*reading_, value->source(), full_name(key)), what);
    if (name_.empty()) return fmt::format("{}: {}: {}", reading_->file, key, what);
    const toml::source_region& at = table_->source();
    const std::string name = comes_from_file(*reading_, at) ? "" : ": " + full_name(key);
    return fmt::format("{}{}: {}", origin(*reading_, at, full_name(key)), name, what);
}

void CaseTable::refuse(std::string_view key, std::string_view what) const { throw CaseError(refusal(key, what)); }

const std::string& CaseTable::file() const { return reading_->file; }

void CaseTable::refuse_value(std::string_view key, std::string_view must) const {
    const toml::node& value = node(key, must);
    const bool is_expression = value.is_string() && reading_->written.contains(full_name(key)) &&
                               std::ranges::none_of(names_in(text(key)), is_variable);
    refuse(key, fmt::format("{}, got {}{}", must, shown(value),
                            is_expression ? fmt::format(" = {}", *number_in(key, value, must)) : ""));
}

const toml::node& CaseTable::node(std::string_view key, std::string_view must) const {
    const toml::node* value = table_->get(key);
    if (value == nullptr) refuse(key, fmt::format("is missing; it {}", must));
    return *value;
}

std::string CaseTable::full_name(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
}

std::string toml_number(double value) { return fmt::format("{}", value); }

std::string toml_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') quoted += {'\\', c};
        else if (code < 0x20 || code == 0x7f) quoted += fmt::format("\\u{:04x}", code);
        else quoted += c;
    }
    return quoted + '"';
}

int edit_distance(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);  // from the letters of `a` so far to each beginning of `b`
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
    const auto far = [&](const std::string& key) { return edit_distance(word, key); };
    const auto nearest = std::ranges::min_element(known, {}, far);
    const int reach = std::max(1, static_cast<int>(word.size()) / 3);  // a slip or two, not another word
    if (nearest != known.end() && far(*nearest) <= reach)
        return fmt::format("did you mean \"{}\"?", *nearest);
    return fmt::format("known here: {}", fmt::join(known, ", "));
}

}  // namespace kropla
