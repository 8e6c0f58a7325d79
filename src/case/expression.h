#pragma once

#include <kropla/base/vec3.h>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// What an expression may speak of beside constants: nothing, the time `t` [s] alone, the place `x`, `y`, `z` [m] alone, or
/// both; or the temperature `T` [K] alone, which then stands for the time in every question.
enum class Variables { none, time, place, time_and_place, temperature };

/// Constants that the user has given names: parameters.
using Constants = std::map<std::string, double, std::less<>>;

/// The names in a formula, of variables, constants and functions, each once, as they come.
[[nodiscard]] std::vector<std::string> names_in(std::string_view formula);
/// Whether a name is one that expressions have a meaning for: a variable (any of t, x, y, z and T), or a constant or
/// function of the language.
[[nodiscard]] bool is_variable(std::string_view name);
[[nodiscard]] bool is_of_language(const std::string& name);

/// A formula that the user wrote, such as "0.0003*sin(4*pi*t/0.01)": compiled once, evaluated often.
/// Operators and functions are muParser's (+ - * / ^, comparisons, a ? b : c, sin, cos, exp, ln, sqrt, min,
/// max, abs, ...), pi, and the constants given. A copy is compiled anew and shares nothing with the original; one
/// object may be asked by several threads.
class Expression {
public:
    /// Throws CaseError, quoting the text and naming the character, if it is not a formula in these
    /// variables.
    explicit Expression(const std::string& text, Variables variables = Variables::time, const Constants& constants = {});
    Expression(const Expression& other);
    Expression(Expression&&) noexcept;
    Expression& operator=(const Expression& other);
    Expression& operator=(Expression&&) noexcept;
    ~Expression();

    /// Its value at time t [s] and place [m]: NaN or infinite where the formula has none.
    [[nodiscard]] double operator()(double t, const Vec3& place = {}) const;
    [[nodiscard]] const std::string& text() const;

private:
    struct Compiled;
    std::unique_ptr<Compiled> compiled_;
};

}  // namespace kropla
