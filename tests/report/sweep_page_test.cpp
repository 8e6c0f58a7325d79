// The page of a sweep, from its table and the steps of its runs.
#include <kropla/base/error.h>
#include "io/file.h"
#include "report/sweep_file.h"
#include "report/sweep_page.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <regex>

namespace kropla {
namespace {

/// A sweep whose table has these lines, the run a=1,b=0 with three steps, and a=2,b=0 with two; its page.
std::string page_of(const std::string& table) {
    const auto dir = test_folder("sweep");
    for (const char* run : {"a=1,b=0", "a=2,b=0"}) std::filesystem::create_directories(dir / run);
    write_file(dir / "a=1,b=0/steps.csv", "step,time [s],drop [K]\n1,0.25,1\n2,0.5,2\n3,1,4\n");
    write_file(dir / "a=2,b=0/steps.csv", "step,time [s],drop [K]\n1,0.5,5\n2,1,7\n");
    write_file(dir / "a=2,b=0/report.html", "");
    write_file(dir / sweep_table_name, table);
    write_sweep_report(dir);
    std::string html = read_file(dir / sweep_page_name);
    std::filesystem::remove_all(dir);
    return html;
}

const std::string head = "run,a,b,exit_code,wall_seconds [s],step,time [s],drop [K],same\n";

std::size_t count(const std::string& html, const std::string& pattern) {
    const std::regex what(pattern);
    return static_cast<std::size_t>(std::distance(std::sregex_iterator(html.begin(), html.end(), what), {}));
}

TEST(SweepPage, ComparesWhatDiffers) {
    const std::string html = page_of(head + "\"a=1,b=0\",1,0,0,3.5,3,1,4,8\n\"a=2,b=0\",2,0,0,2.5,2,1,7,8\n");
    EXPECT_NE(html.find("All 2 runs are done"), std::string::npos);
    EXPECT_NE(html.find("<h2>Over a</h2>"), std::string::npos);
    EXPECT_EQ(count(html, "<figcaption>drop \\[K\\]"), 2u);  // over a and over time
    EXPECT_EQ(count(html, "<figcaption>step<"), 1u);          // not over time
    EXPECT_EQ(html.find("same"), std::string::npos);
    EXPECT_EQ(html.find("time [s]</figcaption>"), std::string::npos);
    EXPECT_NE(html.find("a: 2\ndrop: 7 K"), std::string::npos);  // what is seen when pointing at it
    EXPECT_NE(html.find("time [s]: 0.25\na=1,b=0: 1 K\na=2,b=0: nan K"), std::string::npos);
    EXPECT_NE(html.find("<a href=\"a=2,b=0/report.html\">"), std::string::npos);
    EXPECT_EQ(html.find("<a href=\"a=1,b=0"), std::string::npos);  // has no page
    EXPECT_EQ(html.find("http"), std::string::npos);
}

TEST(SweepPage, LeavesFailedRunsOutOfTheChartsOverTheKey) {
    const std::string html = page_of(head + "\"a=1,b=0\",1,0,0,3.5,3,1,4,8\n\"a=2,b=0\",2,0,3,2.5,2,1,7,8\n"
                                            "\"a=3,b=0\",3,0,2,0.1,,,,\n");
    EXPECT_NE(html.find("1 of 3 runs are done, 2 failed"), std::string::npos);
    EXPECT_NE(html.find("<td>failed, exit code 3</td>"), std::string::npos);
    EXPECT_NE(html.find("a: 2\ndrop: nan K"), std::string::npos);
    EXPECT_NE(html.find("<circle"), std::string::npos);  // the one point that is left
}

TEST(SweepPage, CountsValuesThatAreNoNumbers) {
    const std::string html = page_of(head + "\"a=1,b=0\",slow,0,0,3.5,3,1,4,8\n\"a=2,b=0\",fast,0,0,2.5,2,1,7,8\n");
    EXPECT_NE(html.find("a: 1 slow, 2 fast"), std::string::npos);
}

TEST(SweepPage, RefusesWhatIsNoTableOfASweep) {
    EXPECT_THROW(page_of("step,time [s]\n1,2\n"), FileError);
    EXPECT_THROW(page_of("run,a,exit_code\nx,1,0\n"), FileError);
    EXPECT_THROW(page_of(head + "x,1,0,zero,3.5,3,1,4,8\n"), FileError);
}

}  // namespace
}  // namespace kropla
