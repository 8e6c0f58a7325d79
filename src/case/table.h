#pragma once

#include "case/expression.h"
#include <kropla/base/vec3.h>

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// Lengths of a case [m]: the product of 17 of them is within the range of doubles.
inline constexpr double least_length = 1e-18, most_length = 1e15;
/// The surface size by the largest coordinate: doubles of 16 digits then place a vertex to 1e-7 of its cell.
inline constexpr double least_resolved = 1e-9;

/// A number or an expression of the case file, and how it stands there: `300`, or `"1e4*sin(t)"` with its
/// quotes.
struct Formula {
    Expression value;
    std::string written;
};

/// What the tables of a case file share while it is read.
struct CaseReading {
    std::string file;            // its name
    Constants parameters = {};   // that expressions may use
    std::set<std::string> used = {};                  // of these, what expressions have used so far
    std::map<std::string, std::string> written = {};  // by full key, as TOML: numbers that are expressions there
};

/// A table of the case file while it is read: it knows the file, its own name and line, and refuses what is
/// wrong with one line, "FILE: body[0].radius (line 12): must be positive, got -1"; what does not come from the file
/// with the name of its origin, "--set body[0].radius=-1: must be positive, got -1". Every question throws
/// CaseError like this if the key is missing or its value is not what is asked for. Any number may stand there as an
/// expression of parameters, in quotes.
class CaseTable {
public:
    /// `name` is the table's own, as in "body[0]"; empty for the file itself. `reading` and `table` outlive this object.
    CaseTable(CaseReading& reading, std::string name, const toml::table& table);

    /// Throws if there is a key that is not one of these, and suggests the one that was meant.
    void allow(std::initializer_list<std::string_view> keys) const;
    void allow(const std::vector<std::string>& keys) const;

    [[nodiscard]] bool has(std::string_view key) const;
    /// As they stand in the file.
    [[nodiscard]] std::vector<std::string> keys() const;

    /// A finite number.
    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] double positive(std::string_view key) const;
    /// [m], from `least_length` to `most_length`.
    [[nodiscard]] double length(std::string_view key) const;
    /// Three of them.
    [[nodiscard]] Vec3 lengths(std::string_view key) const;
    /// From `least` to `most`.
    [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] bool truth(std::string_view key) const;
    /// Three coordinates [m], up to `most_length` on either side of 0.
    [[nodiscard]] Vec3 place(std::string_view key) const;
    /// As many finite numbers; `meaning` names them in a refusal.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count,
                                              std::string_view meaning) const;
    /// Texts in brackets, as many as there are; `meaning` names them in a refusal.
    [[nodiscard]] std::vector<std::string> texts(std::string_view key, std::string_view meaning) const;
    /// As many as there are.
    [[nodiscard]] std::vector<double> all_numbers(std::string_view key, std::string_view meaning) const;
    /// Finite at t = 0 and `probe`; of the temperature, anything.
    [[nodiscard]] Formula formula(std::string_view key, Variables variables, const Vec3& probe = {}) const;

    /// An expression in quotes.
    [[nodiscard]] Expression expression(std::string_view key, Variables variables) const;

    /// As many of them in brackets; `meaning` names them in a refusal.
    [[nodiscard]] std::vector<Formula> formulas(std::string_view key, std::size_t count,
                                                std::string_view meaning, Variables variables) const;

    [[nodiscard]] CaseTable table(std::string_view key) const;
    /// The tables of [[key]], in order; none if the key is missing.
    [[nodiscard]] std::vector<CaseTable> tables(std::string_view key) const;
    /// If the value is a text or a table.
    [[nodiscard]] bool holds_text(std::string_view key) const;
    [[nodiscard]] bool holds_table(std::string_view key) const;

    /// The name of the file that the table is of.
    [[nodiscard]] const std::string& file() const;

    /// The line that `refuse` throws.
    [[nodiscard]] std::string refusal(std::string_view key, std::string_view what) const;
    /// Throws: what is wrong with the value of `key`, or with its being there or not.
    [[noreturn]] void refuse(std::string_view key, std::string_view what) const;
    /// Throws: what the value of `key` must be, and what was found: "must be positive, got -1" or "is
    /// missing; it must be positive".
    [[noreturn]] void refuse_value(std::string_view key, std::string_view must) const;

private:
    [[nodiscard]] const toml::node& node(std::string_view key, std::string_view must) const;
    [[nodiscard]] double number(std::string_view key, std::string_view must) const;
    [[nodiscard]] std::optional<double> number_in(std::string_view key, const toml::node& value,
                                                  std::string_view must) const;
    void remember(std::string_view key) const;
    [[nodiscard]] std::string full_name(std::string_view key) const;
    [[nodiscard]] Formula formula(std::string_view key, const toml::node& value, std::string_view must,
                                  Variables variables, const Vec3& probe) const;
    [[nodiscard]] Expression compiled(const std::string& text, Variables variables) const;

    CaseReading* reading_;
    std::string name_;
    const toml::table* table_;
};

/// The words that TOML reads as this number (to full precision), or this text.
[[nodiscard]] std::string toml_number(double value);
[[nodiscard]] std::string toml_text(std::string_view text);

/// How many letters must be changed, added or dropped to make one word of the other [Levenshtein 1966].
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);
/// `did you mean "radius"?` if one of the words is near; else `known here: centre, radius`.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace kropla
