#include <kropla/base/error.h>
#include "report/table.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

/// What the FileError says that `deed` throws; empty if it throws none.
template <class Deed>
std::string refusal(Deed deed) {
    try {
        deed();
    } catch (const FileError& error) {
        return error.what();
    }
    return {};
}

TEST(Table, TakesNamesAndUnitsApart) {
    const Table table = parse_table("step,time [s],note\n1,0.5,first\n2, 1e-3 ,\n", "a.csv");
    ASSERT_EQ(table.columns.size(), 3U);
    EXPECT_EQ(table.rows, 2U);
    EXPECT_EQ(table.columns[1].name, "time");
    EXPECT_EQ(table.columns[1].unit, "s");
    EXPECT_EQ(numbers(table, "time"), (std::vector<double>{0.5, 1e-3}));
    EXPECT_TRUE(has_column(table, "note"));
    EXPECT_FALSE(has_column(table, "time [s]"));
}

TEST(Table, LeavesOutARowThatIsStillBeingWritten) {
    EXPECT_EQ(parse_table("a,b\n1,2\n3,4", "a.csv").rows, 1U);
    EXPECT_EQ(parse_table("a,b\n1,2\n3", "a.csv").rows, 1U);
    EXPECT_EQ(parse_table("a,b\r\n1,2\r\n", "a.csv").rows, 1U);
    EXPECT_EQ(parse_table("a,b\n", "a.csv").rows, 0U);
}

TEST(Table, RefusesWhatIsBrokenAndSaysWhere) {
    EXPECT_EQ(refusal([] { (void)parse_table("", "a.csv"); }), "a.csv: has no line of column names");
    EXPECT_EQ(refusal([] { (void)parse_table("a,b\n1,2\n3\n", "a.csv"); }),
              "a.csv: row 2 has 1 cells, not 2");
    EXPECT_EQ(refusal([] { (void)parse_table("a,b\n1,2,3\n", "a.csv"); }), "a.csv: row 1 has 3 cells, not 2");
    const Table table = parse_table("a,b\n1,2\n3,x4\n", "a.csv");
    EXPECT_EQ(refusal([&] { (void)numbers(table, "b"); }), "a.csv: row 2, b: not a number: 'x4'");
    EXPECT_EQ(refusal([&] { (void)numbers(table, "c"); }), "a.csv: has no column c");
    EXPECT_NE(refusal([] { (void)read_table("/nowhere/steps.csv"); }).find("/nowhere/steps.csv"),
              std::string::npos);
}

TEST(Table, ReadsWhatCellsWereMadeOf) {
    for (const std::string text : {"plain", "a,b", "say \"no\"", "\","})
        EXPECT_EQ(parse_table("x,y\n" + csv_cell(text) + ",2\n", "a.csv").columns[0].cells[0], text);
}

TEST(Table, KnowsCellsInQuotes) {
    const Table table = parse_table("run,body[0].radius,\"a,b\"\n\"r=1,d=2\",3,\"say \"\"no\"\", twice\"\nx,,\"\"\n", "a.csv");
    ASSERT_EQ(table.columns.size(), 3u);
    EXPECT_EQ(table.columns[1].name, "body[0].radius");
    EXPECT_EQ(table.columns[2].name, "a,b");
    EXPECT_EQ(table.columns[0].cells, (std::vector<std::string>{"r=1,d=2", "x"}));
    EXPECT_EQ(table.columns[2].cells, (std::vector<std::string>{"say \"no\", twice", ""}));
}

}  // namespace
}  // namespace kropla
