// Formulas of the case file, compiled by muParser (https://beltoforion.de/en/muparser). Its messages are put
// into our own words: what is wrong, and at which character.
#include "case/expression.h"

#include <kropla/base/error.h>

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <mutex>
#include <numbers>

namespace kropla {
namespace {

/// The number of the first '=' that would assign (no comparison), counted from 1; 0 for none.
std::size_t assignment(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') continue;
        const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
        const bool compares = i > 0 && std::string_view("<>!").find(text[i - 1]) != std::string_view::npos;
        if (!doubled && !compares) return i + 1;
        if (doubled) ++i;
    }
    return 0;
}

/// What a formula may speak of: "t, x, y, z, current, pi and functions such as sin, exp, sqrt".
std::string known_names(Variables variables, const Constants& constants) {
    std::string names;
    switch (variables) {
        case Variables::none: break;
        case Variables::time: names = "t, "; break;
        case Variables::place: names = "x, y, z, "; break;
        case Variables::time_and_place: names = "t, x, y, z, "; break;
        case Variables::temperature: names = "T, "; break;
    }
    for (const auto& [name, value] : constants) names += name + ", ";
    return names + "pi and functions such as sin, exp, sqrt";
}

std::string fault(const mu::ParserError& error, std::size_t length, Variables variables, const Constants& constants) {
    const bool at_end = error.GetPos() < 0 || static_cast<std::size_t>(error.GetPos()) >= length;
    const std::string place = at_end ? "at the end" : fmt::format("at character {}", error.GetPos() + 1);
    switch (error.GetCode()) {
        case mu::ecUNASSIGNABLE_TOKEN:
            return fmt::format("\"{}\" {} is not known; known are {}", error.GetToken(), place,
                               known_names(variables, constants));
        case mu::ecUNEXPECTED_EOF: return "something is missing at the end";
        case mu::ecEMPTY_EXPRESSION: return "an expression is missing";
        case mu::ecMISSING_PARENS: return fmt::format("\")\" is missing {}", place);
        case mu::ecTOO_MANY_PARAMS:
            return fmt::format("too many arguments for \"{}\" {}", error.GetToken(), place);
        case mu::ecTOO_FEW_PARAMS:
            return fmt::format("too few arguments for \"{}\" {}", error.GetToken(), place);
        default: return fmt::format("\"{}\" {} is out of place", error.GetToken(), place);
    }
}

bool is_letter(char c) { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c == '.' || std::isdigit(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::vector<std::string> names_in(std::string_view formula) {
    std::vector<std::string> names;
    for (auto at = formula.begin(); at != formula.end();) {
        const auto end = std::find_if_not(at, formula.end(), [](char c) { return is_letter(c) || is_digit(c); });
        if (std::string word(at, end); end != at && is_letter(*at) && std::ranges::find(names, word) == names.end())
            names.push_back(std::move(word));
        at = end == at ? at + 1 : end;  // a number is passed over with its exponent
    }
    return names;
}

bool is_variable(std::string_view name) {
    constexpr std::array<std::string_view, 5> variables = {"t", "x", "y", "z", "T"};
    return std::ranges::find(variables, name) != variables.end();
}

bool is_of_language(const std::string& name) {
    const mu::Parser parser;
    return name == "pi" || parser.GetConst().contains(name) || parser.GetFunDef().contains(name);
}

struct Expression::Compiled {
    std::string text;
    Variables variables;
    Constants constants;  // that the formula has
    double t = 0;
    Vec3 place;
    mu::Parser parser;
    std::mutex asked;  // muParser reads t and the place from here, so that one question is answered at a time

    Compiled(const std::string& formula, Variables known, const Constants& named) : text(formula), variables(known) {
        for (const std::string& name : names_in(text))
            if (const auto constant = named.find(name); constant != named.end()) constants.insert(*constant);
        if (const std::size_t at = assignment(text); at > 0) {
            throw CaseError(fmt::format("\"{}\": \"=\" at character {} is out of place", text, at));
        }
        if (const std::size_t at = text.find("**"); at != std::string::npos) {
            throw CaseError(fmt::format("\"{}\": \"**\" at character {}: a power is written ^, as in t^2", text, at + 1));
        }
        try {
            compile();
        } catch (const mu::ParserError& error) {
            throw CaseError(fmt::format("\"{}\": {}", text, fault(error, text.size(), variables, named)));
        }
    }

    void compile() {
        parser.DefineConst("pi", std::numbers::pi);
        for (const auto& [name, value] : constants) parser.DefineConst(name, value);
        const bool of_place = variables == Variables::place || variables == Variables::time_and_place;
        if (variables != Variables::none && variables != Variables::place)
            parser.DefineVar(variables == Variables::temperature ? "T" : "t", &t);
        if (of_place) {
            parser.DefineVar("x", &place.x);
            parser.DefineVar("y", &place.y);
            parser.DefineVar("z", &place.z);
        }
        parser.SetExpr(text);
        int results = 0;
        parser.Eval(results);  // muParser compiles when it is first asked
        if (results != 1) throw CaseError(fmt::format("\"{}\": must be one formula, not {}", text, results));
    }
};

Expression::Expression(const std::string& text, Variables variables, const Constants& constants)
    : compiled_(std::make_unique<Compiled>(text, variables, constants)) {}
Expression::Expression(const Expression& other)
    : compiled_(std::make_unique<Compiled>(other.compiled_->text, other.compiled_->variables,
                                           other.compiled_->constants)) {}
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(const Expression& other) { return *this = Expression(other); }
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(double t, const Vec3& place) const {
    const std::lock_guard lock(compiled_->asked);
    compiled_->t = t;
    compiled_->place = place;
    return compiled_->parser.Eval();
}

const std::string& Expression::text() const { return compiled_->text; }

}  // namespace kropla
