#pragma once

#include <kropla/base/vec3.h>

#include <memory>
#include <string>

namespace kropla {

/// What an expression may speak of: the time `t` [s] alone, or the place `x`, `y`, `z` [m] as well; or the temperature
/// `T` [K] alone, which then stands for the time in every question.
enum class Variables { time, time_and_place, temperature };

/// A formula that the user wrote, such as "0.0003*sin(4*pi*t/0.01)": compiled once, evaluated often.
/// Operators and functions are muParser's (+ - * / ^, comparisons, a ? b : c, sin, cos, exp, ln, sqrt, min,
/// max, abs, ...), and pi. A copy is compiled anew and shares nothing with the original; one object may be
/// asked by several threads.
class Expression {
public:
    /// Throws CaseError, quoting the text and naming the character, if it is not a formula in these
    /// variables.
    explicit Expression(const std::string& text, Variables variables = Variables::time);
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
