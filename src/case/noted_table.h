#pragma once

#include "case/case.h"
#include "case/expression.h"
#include "case/property.h"
#include "case/table.h"
#include <kropla/simulate/flow.h>

#include <string>
#include <string_view>
#include <utility>

namespace kropla {

/// A place in the box that is special to no formula: expressions are tried there.
[[nodiscard]] Vec3 probe_of(const Box& box);

/// A table of a case while it is read, which notes how what was read is written.
class NotedTable {
public:
    /// All outlive this object.
    NotedTable(const CaseTable& table, const Vec3& probe, WrittenKeys& written)
        : table_(table), probe_(probe), written_(written) {}

    [[nodiscard]] bool has(std::string_view key) const { return table_.has(key); }
    [[nodiscard]] const CaseTable& table() const { return table_; }

    /// A number or an expression of these; empty if the key is not there.
    Quantity quantity(std::string_view key, Variables of = Variables::time_and_place);
    double number(std::string_view key);
    /// Three of them; empty if the key is not there. `meaning` names them in a refusal.
    VectorQuantity vector(std::string_view key, std::string_view meaning, Variables of = Variables::time_and_place);
    Property property(std::string_view key, double usual_temperature);
    void note(std::string_view key, std::string written) { written_.emplace_back(key, std::move(written)); }

    [[nodiscard]] double at_probe(const Quantity& quantity) const { return quantity(probe_, 0); }

private:
    const CaseTable& table_;
    Vec3 probe_;
    WrittenKeys& written_;
};

/// `{ value = 300, power = 2 }`
[[nodiscard]] std::string inline_table(const WrittenKeys& keys);

}  // namespace kropla
