// Settings of the command line, put into the tables of a case file before it is read.
#include "case/setting.h"

#include "case/table.h"
#include <kropla/base/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

namespace kropla {
namespace {

std::string source_of(const std::string& setting) { return "--set " + setting; }

[[noreturn]] void refuse(const std::string& setting, std::string_view what) {
    throw CaseError(fmt::format("{}: {}", source_of(setting), what));
}

std::vector<std::string> names_of(const toml::table& table) {
    std::vector<std::string> names;
    for (const auto& [key, value] : table) names.emplace_back(key.str());
    return names;
}

bool is_index(const toml::path_component& part) { return part.type() == toml::path_component_type::array_index; }

/// Empty for a number in brackets.
std::string name_of(const toml::path_component& part) {
    if (is_index(part)) return {};
    const std::string& name = part.key();
    const bool quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
    return quoted ? name.substr(1, name.size() - 2) : name;
}

/// What is set.
struct Change {
    const std::string& setting;  // all of it
    std::string value;
};

/// A table that holds, under dotted `names`, the value of these words alone; nothing if they are not TOML.
std::optional<toml::table> table_of(const std::vector<std::string>& names, const std::string& words, const Change& change) {
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back(toml_text(name));
    const std::string line = fmt::format("{} = {}", fmt::join(quoted, "."), words);
    if (line.find('\n') != std::string::npos) return {};  // there would be more than a value
    try {
        return toml::parse(std::string_view(line), source_of(change.setting));
    } catch (const toml::parse_error&) {
        return {};
    }
}

/// The same, of the value; where it is not TOML, it may be a text. Throws CaseError.
toml::table parsed(const std::vector<std::string>& names, const Change& change, bool may_be_text) {
    const std::string& value = change.value;
    if (auto table = table_of(names, value, change)) return std::move(*table);
    if (may_be_text)
        if (auto table = table_of(names, toml_text(value), change)) return std::move(*table);
    if (const auto values = values_of_list(value); values.size() > 1)
        refuse(change.setting,
               fmt::format("must be one value, not {}; kropla sweep runs a case for each", values.size()));
    refuse(change.setting,
           fmt::format("{} is no TOML value: a number, a text in quotes, a list in brackets, true or false", value));
}

/// Which of an array is meant: by its number, or, of tables, by the name that stands in it.
std::size_t place_in(const toml::array& array, const toml::path_component& part, const std::string& reached,
                     const Change& change) {
    if (is_index(part)) {
        if (part.index() < array.size()) return part.index();
        refuse(change.setting, fmt::format("{} has {}, counted from [0]", reached, array.size()));
    }
    std::vector<std::string> names;
    for (const toml::node& item : array)
        if (const toml::table* table = item.as_table()) names.push_back((*table)["name"].value_or(std::string()));
    const auto found = std::ranges::find(names, name_of(part));
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    refuse(change.setting, fmt::format("{} has none called {}; {}", reached, toml_text(name_of(part)),
                                       suggestion(name_of(part), names)));
}

using Parts = std::span<const toml::path_component>;

void put(toml::node& here, Parts rest, const std::string& reached, const Change& change);

void put_in_array(toml::array& array, Parts rest, const std::string& reached, const Change& change) {
    const std::size_t place = place_in(array, rest.front(), reached, change);
    if (rest.size() > 1)
        return put(*array.get(place), rest.subspan(1), fmt::format("{}[{}]", reached, place), change);
    for (auto&& [name, node] : parsed({"value"}, change, array.get(place)->is_string()))
        array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(place), std::move(node));
}

/// Puts the value where the `rest` of its key leads from `here`, which the key has `reached`.
void put(toml::node& here, Parts rest, const std::string& reached, const Change& change) {
    if (toml::array* array = here.as_array()) return put_in_array(*array, rest, reached, change);
    toml::table* table = here.as_table();
    if (table == nullptr) refuse(change.setting, fmt::format("{} holds one value, and nothing below it", reached));
    toml::node* held = is_index(rest.front()) ? nullptr : table->get(name_of(rest.front()));
    if (held == nullptr && std::ranges::any_of(rest, is_index))
        refuse(change.setting, "the case has nothing that is counted there");
    if (held != nullptr && rest.size() > 1)
        return put(*held, rest.subspan(1), (reached.empty() ? "" : reached + ".") + name_of(rest.front()), change);
    std::vector<std::string> names;
    std::ranges::transform(rest, std::back_inserter(names), name_of);
    for (auto&& [name, node] : parsed(names, change, held == nullptr || held->is_string()))
        table->insert_or_assign(name, std::move(node));
}

/// The full key: a parameter may go by its name alone. Throws if neither a parameter nor a table is meant.
toml::path path_of(const std::string& key, const toml::table& file, const std::string& setting) {
    const toml::path path(key);
    const auto is_nameless = [](const toml::path_component& part) { return !is_index(part) && name_of(part).empty(); };
    if (path.empty() || is_index(path[0]) || std::ranges::any_of(path, is_nameless))
        refuse(setting, "has no key; keys are such as size.surface and body[0].radius");
    if (path.str() != key)
        refuse(setting, fmt::format("is no key; {} might be meant, as keys are such as size.surface and body[0].radius",
                                    path.str()));
    const toml::table* given = file["parameters"].as_table();
    std::vector<std::string> known = given != nullptr ? names_of(*given) : std::vector<std::string>();
    const auto is_parameter = [&](const toml::path_component& part) {
        return !is_index(part) && std::ranges::find(known, name_of(part)) != known.end();
    };
    if (path.size() == 1 && is_parameter(path[0])) return toml::path("parameters") + path;
    if (path.size() > 1 && name_of(path[0]) == "parameters" && !is_parameter(path[1]))
        refuse(setting, fmt::format("the case has no such parameter; {}",
                                    known.empty() ? "it has none" : suggestion(key.substr(key.find('.') + 1), known)));
    if (path.size() > 1 || file.contains(name_of(path[0]))) return path;
    for (const std::string& table : names_of(file)) known.push_back(table);
    refuse(setting, fmt::format("the case has no such parameter or key; {}", suggestion(key, known)));
}

void apply(const std::string& setting, toml::table& file) {
    const auto [key, value] = parted_setting(setting);
    const toml::path path = path_of(key, file, setting);
    put(file, {path.begin(), path.end()}, "", {setting, value});
}

}  // namespace

Setting parted_setting(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) refuse(text, "must be KEY=VALUE, such as size.surface=1e-4");
    if (equals + 1 == text.size()) refuse(text, "has no value");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::string> values_of_list(std::string_view text) {
    std::vector<std::string> values(1);
    int depth = 0;
    bool quoted = false;
    for (const char c : text) {
        if (c == '"') quoted = !quoted;
        if (!quoted && (c == '[' || c == '{' || c == '(')) ++depth;
        if (!quoted && (c == ']' || c == '}' || c == ')')) --depth;
        if (c == ',' && depth == 0 && !quoted) values.emplace_back();
        else values.back() += c;
    }
    return values;
}

void apply_settings(std::span<const std::string> settings, toml::table& file) {
    std::set<std::string> keys;
    for (const std::string& setting : settings) {
        if (const std::string key = parted_setting(setting).key; !keys.insert(key).second)
            refuse(setting, fmt::format("{} is set twice", key));
        apply(setting, file);
    }
}

}  // namespace kropla
