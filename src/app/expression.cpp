// Formulas of the case file, compiled by muParser (https://beltoforion.de/en/muparser). Its messages are put
// into our own words: what is wrong, and at which character.
#include "app/expression.h"

#include <kropla/base/error.h>

#include <fmt/format.h>
#include <muParser.h>

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

const char* names_of(Variables variables) {
    switch (variables) {
        case Variables::time: return "t";
        case Variables::temperature: return "T";
        default: return "t, x, y, z";
    }
}

std::string fault(const mu::ParserError& error, std::size_t length, Variables variables) {
    const bool at_end = error.GetPos() < 0 || static_cast<std::size_t>(error.GetPos()) >= length;
    const std::string place = at_end ? "at the end" : fmt::format("at character {}", error.GetPos() + 1);
    switch (error.GetCode()) {
        case mu::ecUNASSIGNABLE_TOKEN:
            return fmt::format(
                "\"{}\" {} is not known; known are {}, pi and functions such as sin, exp, sqrt",
                error.GetToken(), place, names_of(variables));
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

}  // namespace

struct Expression::Compiled {
    std::string text;
    Variables variables;
    double t = 0;
    Vec3 place;
    mu::Parser parser;
    std::mutex asked;  // muParser reads t and the place from here, so that one question is answered at a time

    Compiled(const std::string& formula, Variables known) : text(formula), variables(known) {
        if (const std::size_t at = assignment(text); at > 0) {
            throw CaseError(fmt::format("\"{}\": \"=\" at character {} is out of place", text, at));
        }
        if (const std::size_t at = text.find("**"); at != std::string::npos) {
            throw CaseError(fmt::format("\"{}\": \"**\" at character {}: a power is written ^, as in t^2", text, at + 1));
        }
        try {
            compile();
        } catch (const mu::ParserError& error) {
            throw CaseError(fmt::format("\"{}\": {}", text, fault(error, text.size(), variables)));
        }
    }

    void compile() {
        parser.DefineConst("pi", std::numbers::pi);
        parser.DefineVar(variables == Variables::temperature ? "T" : "t", &t);
        if (variables == Variables::time_and_place) {
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

Expression::Expression(const std::string& text, Variables variables)
    : compiled_(std::make_unique<Compiled>(text, variables)) {}
Expression::Expression(const Expression& other)
    : compiled_(std::make_unique<Compiled>(other.compiled_->text, other.compiled_->variables)) {}
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
