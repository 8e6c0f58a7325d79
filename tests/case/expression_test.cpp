#include "case/expression.h"
#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

namespace kropla {
namespace {

std::string fault(const std::string& text, Variables variables = Variables::time) {
    try {
        const Expression it(text, variables);
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(Expression, HasItsValue) {
    EXPECT_EQ(Expression("2*t + 1")(3), 7);
    EXPECT_EQ(Expression("0.0003*sin(4*pi*t/0.01)")(0.002),
              0.0003 * std::sin(4 * std::numbers::pi * 0.002 / 0.01));
    EXPECT_EQ(Expression("2^3^2")(0), 512);
    EXPECT_EQ(Expression("exp(t) + sqrt(t) + ln(t)")(2), std::exp(2.0) + std::sqrt(2.0) + std::log(2.0));
    EXPECT_EQ(Expression("t > 1 ? 5 : t >= 0.5 ? 6 : 7")(0.5), 6);
    EXPECT_EQ(Expression("x + 10*y + 100*z + 1000*t", Variables::time_and_place)(4, {1, 2, 3}), 4321);
    EXPECT_TRUE(std::isnan(Expression("sqrt(-1-t)")(0)));
    EXPECT_TRUE(std::isinf(Expression("1/t")(0)));
}

TEST(Expression, CopiesShareNothing) {
    Expression first("t*t");
    const Expression second = first;
    first = Expression("t + 1");
    EXPECT_EQ(second(3), 9);
    EXPECT_EQ(first(3), 4);
    EXPECT_EQ(second.text(), "t*t");
    const Expression moved = std::move(first);
    EXPECT_EQ(moved(5), 6);
}

TEST(Expression, KnowsConstantsByName) {
    const Constants constants = {{"current", 150}, {"d_0", 2}, {"e5", 7}};
    EXPECT_EQ(Expression("current*t + d_0", Variables::time, constants)(2), 302);
    EXPECT_EQ(Expression("current/d_0 + 1e5 + e5", Variables::none, constants)(0), 100082);
    const Expression first("current*t", Variables::time, constants);
    const Expression copy = first;
    EXPECT_EQ(copy(3), 450);
    EXPECT_THROW(Expression("current*t", Variables::none, constants), CaseError);
}

TEST(Expression, NamesWhatItSpeaksOf) {
    EXPECT_EQ(names_in("2*current + sin(pi*t) - current^1e5 + 1.5e-3*e5"),
              (std::vector<std::string>{"current", "sin", "pi", "t", "e5"}));
    EXPECT_TRUE(names_in("").empty());
    EXPECT_TRUE(is_variable("T"));
    EXPECT_FALSE(is_variable("pi"));
    for (const char* name : {"pi", "_pi", "_e", "sin", "min", "sqrt"}) EXPECT_TRUE(is_of_language(name)) << name;
    EXPECT_FALSE(is_of_language("current"));
}

TEST(Expression, AnswersSeveralThreads) {
    const Expression square("x*x + t", Variables::time_and_place);
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < wrong.size(); ++k) {
        threads.emplace_back([&, k] {
            for (int i = 0; i < 20000; ++i) {
                const double x = static_cast<double>(k) * 1000 + i;
                wrong[k] += square(1, {x, 0, 0}) == x * x + 1 ? 0 : 1;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(Expression, SaysWhereItIsWrong) {
    EXPECT_EQ(fault("t +"), "\"t +\": something is missing at the end");
    EXPECT_EQ(fault("sin(t"), "\"sin(t\": \")\" is missing at the end");
    EXPECT_EQ(fault("1)"), "\"1)\": \")\" at character 2 is out of place");
    EXPECT_EQ(fault("2t"), "\"2t\": \"t\" at character 2 is out of place");
    EXPECT_EQ(fault("sin()"), "\"sin()\": too few arguments for \"sin\" at character 5");
    EXPECT_EQ(fault("1 + y"),
              "\"1 + y\": \"y\" at character 5 is not known; known are t, pi and functions such as "
              "sin, exp, sqrt");
    EXPECT_EQ(fault("1,2"), "\"1,2\": must be one formula, not 2");
    EXPECT_EQ(fault("t = 5"), "\"t = 5\": \"=\" at character 3 is out of place");
    EXPECT_EQ(fault("2*t**3"), "\"2*t**3\": \"**\" at character 4: a power is written ^, as in t^2");
    EXPECT_EQ(fault("t == 5 ? 1 : t != 2"), "");
    EXPECT_EQ(fault("1 + y", Variables::time_and_place), "");
}

}  // namespace
}  // namespace kropla
