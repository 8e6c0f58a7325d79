// Parameters, each evaluated after those that its expression speaks of: a depth-first search.
#include "case/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kropla {
namespace {

void check_name(const CaseTable& table, const std::string& name) {
    const auto is_part = [](unsigned char c) { return c == '_' || std::isalnum(c) != 0; };
    const bool is_name = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0;
    if (!is_name || !std::ranges::all_of(name, is_part))
        table.refuse(name, "is no name for a parameter: it has letters, digits and _, and does not begin with a digit");
    if (is_variable(name)) table.refuse(name, "is a variable of expressions; another name does");
    if (is_of_language(name)) table.refuse(name, "is a constant or function of expressions; another name does");
}

class Evaluation {
public:
    Evaluation(const CaseTable& table, CaseReading& reading)
        : table_(table), reading_(reading), names_(table.keys()) {}

    void evaluate_all() {
        for (const std::string& name : names_) check_name(table_, name);
        for (const std::string& name : names_) evaluate(name);
    }

private:
    void evaluate(const std::string& name) {
        if (reading_.parameters.contains(name)) return;
        const bool is_under_way = std::ranges::find(under_way_, name) != under_way_.end();
        under_way_.push_back(name);
        if (is_under_way) refuse_circle(name);
        if (table_.holds_text(name))
            for (const std::string& other : names_in(table_.text(name))) evaluate_for(name, other);
        under_way_.pop_back();
        reading_.parameters.emplace(name, table_.number(name));
    }

    void evaluate_for(const std::string& name, const std::string& other) {
        if (std::ranges::find(names_, other) != names_.end()) return evaluate(other);
        if (is_of_language(other)) return;
        const std::string text = toml_text(table_.text(name));
        if (is_variable(other))
            table_.refuse(name, fmt::format("{}: \"{}\" is a variable; a parameter is a number, or an expression of other "
                                            "parameters", text, other));
        table_.refuse(name, fmt::format("{}: \"{}\" is no parameter; {}", text, other, suggestion(other, names_)));
    }

    [[noreturn]] void refuse_circle(const std::string& name) const {
        const auto begin = std::ranges::find(under_way_, name);
        table_.refuse(name, fmt::format("depends on itself: {}", fmt::join(begin, under_way_.end(), " -> ")));
    }

    const CaseTable& table_;
    CaseReading& reading_;
    std::vector<std::string> names_;
    std::vector<std::string> under_way_;  // each used by the one before
};

}  // namespace

void read_parameters(const CaseTable& table, CaseReading& reading) { Evaluation(table, reading).evaluate_all(); }

}  // namespace kropla
