// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/shape.hpp"

#include "effects/compiled_shape.hpp"
#include "effects/simple_shapes.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace trussmap::shape_test {
using namespace effects;
namespace {

using Values = std::vector<double>;

double value_of(const std::string& expression) {
  return Shape(expression).values({{"x", {2.0}}, {"payload_kg", {3.0}}}).front();
}

std::string complaint(const std::string& expression) {
  try {
    (void)Shape(expression).values({{"x", {1.0, 0.0}}, {"y", {4.0, 5.0}}});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(Shape, KnowsItsFunctions) {
  EXPECT_EQ(value_of("1"), 1.0);
  EXPECT_EQ(value_of("x^2*payload_kg - 1/(x+2)"), 11.75);
  EXPECT_NEAR(value_of("log(exp(x))"), 2.0, 1e-15);  // natural
  EXPECT_EQ(value_of("max(0, x-5) + min(x, 7, -1) + abs(-x)"), 1.0);
  EXPECT_EQ(value_of("sign(-x) + sign(0) + sqrt(4)"), 1.0);
  EXPECT_NEAR(value_of("sin(x)^2 + cos(x)^2 + tan(0)"), 1.0, 1e-15);
  EXPECT_EQ(value_of("-2^2"), -4.0);
  EXPECT_EQ(value_of("(x>1)*5 + (x<1) + (x>=2) + (x <= 1.5)"), 6.0);  // x = 2
}

TEST(Shape, SaysWhatIsWrong) {
  EXPECT_EQ(complaint("z + x"),
            "shape \"z + x\" names \"z\", which is unknown, expected one of x, y");
  EXPECT_EQ(
      complaint("y / x"),
      "shape \"y / x\" has no finite value in row 2 of the drive (x = 0, y = 5), expected one "
      "in every row");
  EXPECT_EQ(complaint("sin(x").rfind("shape \"sin(x\" cannot be read: ", 0), 0U)
      << complaint("sin(x");
  EXPECT_EQ(complaint("rint(x)").rfind("shape \"rint(x)\" cannot be read: ", 0), 0U);
  EXPECT_EQ(complaint("").rfind("shape \"\" cannot be read: ", 0), 0U);
  for (const char* other :
       {"x=3", "x, y", "(x, y)", "x==1", "x=>1", "x>0.5 ? 1 : 0", "x\n+y", "x && y"}) {
    EXPECT_NE(complaint(other).find("has no meaning there, expected + - * /"), std::string::npos)
        << complaint(other);
  }
  EXPECT_EQ(complaint("min(x, max(y,2))"), "none");
  EXPECT_EQ(complaint("x x").rfind("shape \"x x\" cannot be read: ", 0), 0U);
}

TEST(Shape, WhatCannotBeReadIsRefusedAtOnce) {
  for (const char* text : {"", "sin(", "x +", "x x", "{x}", "rint(x)", "max()", "x^"}) {
    EXPECT_THROW((void)Shape(text), std::invalid_argument) << text;
  }
}

TEST(Shape, KnowsItsVariablesAndWhetherItIsAFunctionOfSomething) {
  const Shape shape = "payload_kg*sin(x)+x";
  EXPECT_EQ(shape.variables(), (std::vector<std::string>{"payload_kg", "x"}));
  EXPECT_TRUE(shape.speaks_of("x"));
  EXPECT_FALSE(shape.speaks_of("sin"));
  EXPECT_EQ(shape.argument_of("sin"), std::nullopt);
  EXPECT_EQ(Shape("sin(2*heading)").argument_of("sin"), "2*heading");
  EXPECT_EQ(Shape("sin(2*heading)").argument_of("cos"), std::nullopt);
  EXPECT_EQ(Shape("sin(x)*cos(x)").argument_of("sin"), std::nullopt);
  EXPECT_EQ(Shape("(x)").argument_of(""), std::nullopt);
  EXPECT_EQ(Shape("x"), Shape(std::string("x")));
  EXPECT_FALSE(Shape("x") == Shape("x+0"));
}

TEST(Shape, ItsParametersAreThePlacesThresholdsTimesAndRadii) {
  struct Case {
    const char* text;
    std::vector<ShapeParameter> parameters;
  };
  const Case cases[] = {
      {"exp(-((x-12.5)^2+(y-(-9))^2)/(2*3.25^2))", {{"x", 12.5}, {"y", -9.0}, {"r", 3.25}}},
      {"(1+sign(3^2-(x-12.5)^2-(y+9)^2))/2", {{"x", 12.5}, {"y", -9.0}, {"r", 3.0}}},
      {"(1+sign(36-(x-12)^2-(y-1e-3)^2))/2", {{"x", 12.0}, {"y", 1e-3}}},
      {"max(0, speed-0.4)", {{"speed", 0.4}}},
      {"(1+sign(t-600))/2", {{"t", 600.0}}},
      {"speed>0.4", {{"speed", 0.4}}},
      {"(t<=-600)*speed", {{"t", -600.0}}},
      {"speed>2*x", {}},
      {"(temperature_C-20.5)*sin(heading)", {{"temperature_C", 20.5}}},
      {"(sign(turn_rate-0.2)+sign(turn_rate+0.2))/2", {{"turn_rate", 0.2}, {"turn_rate", -0.2}}},
      {"x-3*y", {}},
      {"2*x-3", {}},
      {"speed^2", {}},
      {"sin(2*heading)", {}},
      {"1", {}}};
  for (const Case& one : cases) {
    EXPECT_EQ(Shape(one.text).parameters(), one.parameters) << one.text;
  }
  EXPECT_EQ(Shape("(1+sign(t-600))/2").parameter("t"), 600.0);
  EXPECT_EQ(Shape("(1+sign(t-600))/2").parameter("x"), std::nullopt);
}

/// Finite doubles of all sizes, seed 1: bits as they come.
std::vector<double> any_numbers() {
  std::mt19937_64 random(1);
  std::vector<double> numbers{0.1, 1.0 / 3.0, 1e-5, 123456.7890123, 5e5 + 1e-4, 1e22, 5e-324};
  while (numbers.size() < 500) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) numbers.push_back(value);
  }
  return numbers;
}

TEST(Shape, ParametersGoThroughTextWithoutLoss) {
  for (const double number : any_numbers()) {
    const Shape made("(x-{x})", {{"x", number}});
    const Shape read(made.text());
    EXPECT_EQ(made, read);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.parameter("x").value()),
              std::bit_cast<std::uint64_t>(number))
        << made.text();
    // The parser has the same bits: nothing is left where x is the number.
    EXPECT_EQ(read.values({{"x", {number}}}), Values{0.0}) << made.text();
  }
}

TEST(Shape, IsReadOnceHoweverOftenItIsCopiedAndEvaluated) {
  const std::size_t before = shapes_read();
  const Shape shape = "exp(-((x-77.125)^2+y^2)/8)";
  EXPECT_EQ(shapes_read(), before + 1);
  std::vector<Shape> copies(20, shape);
  copies.emplace_back(shape.text());  // of a text that is in use
  for (int k = 0; k < 100; ++k) {
    for (const Shape& copy : copies) {
      EXPECT_EQ(copy.values({{"x", {77.125, 0.0}}, {"y", {0.0, 0.0}}}).front(), 1.0);
    }
  }
  EXPECT_EQ(shapes_read(), before + 1);
}

TEST(Shape, ManyThreadsMayAskTheSame) {
  const Shape shape = "x*x + 2*y";
  std::vector<Values> results(4);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < results.size(); ++n) {
    threads.emplace_back([&, n] {
      RowVariables variables;
      for (int row = 0; row < 2000; ++row) {
        variables["x"].push_back(static_cast<double>(n) + row);
        variables["y"].push_back(row);
      }
      results[n] = shape.values(variables);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < results.size(); ++n) {
    for (int row = 0; row < 2000; ++row) {
      const double x = static_cast<double>(n) + row;
      ASSERT_EQ(results[n][static_cast<std::size_t>(row)], x * x + 2.0 * row);
    }
  }
}

TEST(Shape, PatternsAreFilled) {
  EXPECT_EQ(filled("max(0, speed-{v0})", {{"v0", 0.4}}), "max(0, speed-0.4)");
  EXPECT_EQ(filled("(y-{y})^2+{r}^2/{r}", {{"y", -0.1}, {"r", 1e-9}}),
            "(y-(-0.1))^2+1e-09^2/1e-09");
  EXPECT_EQ(texts_of({"1", "x"}), (std::vector<std::string>{"1", "x"}));
}

/// Shapes made without a parser are those that the parser makes.
TEST(Shape, TheSimplestAreTheSameWithoutAParser) {
  const RowVariables rows{{"heading", {-2.0, 0.1, 3.0}}, {"speed", {1.0, 2.0, 3.0}}};
  const std::pair<Shape, Shape> pairs[] = {{constant_shape(), Shape("1")},
                                           {sine_of("heading"), Shape("sin(heading)")},
                                           {cosine_of("heading"), Shape("cos(heading)")}};
  for (const auto& [simple, read] : pairs) {
    EXPECT_EQ(simple, read);
    EXPECT_EQ(simple.variables(), read.variables());
    EXPECT_EQ(simple.parameters(), read.parameters());
    EXPECT_EQ(simple.argument_of("sin"), read.argument_of("sin"));
    EXPECT_EQ(simple.values(rows), read.values(rows));
  }
}

}  // namespace
}  // namespace trussmap::shape_test
