// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Shapes and the variables they speak of.
#include "effects/shape.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using Values = std::vector<double>;

double value_of(const std::string& expression) {
  return evaluate_shape(expression, {{"x", {2.0}}, {"payload_kg", {3.0}}}).front();
}

std::string complaint(const std::string& expression) {
  try {
    (void)evaluate_shape(expression, {{"x", {1.0, 0.0}}, {"y", {4.0, 5.0}}});
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
  EXPECT_EQ(variables_of("payload_kg*sin(x)+x"), (std::vector<std::string>{"payload_kg", "x"}));
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
  for (const char* other : {"x=3", "x, y", "(x, y)", "x>1", "x>0.5 ? 1 : 0", "x\n+y", "x && y"}) {
    EXPECT_NE(complaint(other).find("has no meaning there, expected + - * /"), std::string::npos)
        << complaint(other);
  }
  EXPECT_EQ(complaint("min(x, max(y,2))"), "none");
  EXPECT_EQ(complaint("x x").rfind("shape \"x x\" cannot be read: ", 0), 0U);
}

/// 2 s at rest, 2 s spin left, 3 s ahead at 0.5 m/s, 3 s back; rows of 0.1 s.
Drive plain_drive() {
  Drive drive;
  const auto add = [&drive](int rows, double left, double right) {
    for (int k = 0; k < rows; ++k) {
      drive.t.push_back(10.0 + 0.1 * static_cast<double>(drive.rows() + 1));
      drive.left.push_back(left);
      drive.right.push_back(right);
    }
  };
  add(20, 0.0, 0.0);
  add(20, -0.02, 0.02);
  add(30, 0.05, 0.05);
  add(30, -0.05, -0.05);
  drive.covariates.push_back({"lights", Values(100, 1.0)});
  return drive;
}

RowVariables variables_of(const Drive& drive) {
  return row_variables(drive, 0.4, {}, std::vector<Pose>(drive.rows()), 2);
}

TEST(RowVariables, RatesAreThoseOfTheMotionAndStayWithinIt) {
  const RowVariables v = variables_of(plain_drive());
  EXPECT_NEAR(v.at("speed")[39], 0.0, 1e-12);  // the last of the spin
  EXPECT_NEAR(v.at("speed")[40], 0.5, 1e-12);  // the first of the drive
  EXPECT_NEAR(v.at("turn_rate")[20], 1.0, 1e-12);
  EXPECT_NEAR(v.at("turn_rate")[19], 0.0, 1e-12);
  EXPECT_NEAR(v.at("turn_rate")[40], 0.0, 1e-12);
  EXPECT_EQ(v.at("lights")[7], 1.0);
  EXPECT_EQ(v.at("session")[7], 2.0);
}

TEST(RowVariables, EventsComeOnce) {
  const RowVariables v = variables_of(plain_drive());
  const auto count = [&v](const char* name) {
    double sum = 0.0;
    for (const double value : v.at(name)) sum += value;
    return sum;
  };
  EXPECT_EQ(count("starts"), 1.0);
  EXPECT_EQ(v.at("starts")[40], 1.0);
  EXPECT_EQ(count("spins"), 1.0);
  EXPECT_EQ(v.at("spins")[20], 1.0);
  EXPECT_EQ(count("reverses_left"), 2.0);  // backwards, ahead, backwards
  EXPECT_EQ(v.at("reverses_left")[40], 1.0);
  EXPECT_EQ(v.at("reverses_right")[70], 1.0);
}

TEST(RowVariables, TimeAndDistanceAreAtTheRowsMiddle) {
  const RowVariables v = variables_of(plain_drive());
  EXPECT_NEAR(v.at("t")[0], 0.05, 1e-12);
  EXPECT_NEAR(v.at("t")[99], 9.95, 1e-12);
  EXPECT_NEAR(v.at("distance")[40], 0.025, 1e-12);
  EXPECT_NEAR(v.at("distance")[99], 3.0 - 0.025, 1e-12);
}

/// Encoder noise of single rows is averaged over ten of them.
TEST(RowVariables, RatesAreSmoothed) {
  Drive drive = plain_drive();
  for (std::size_t row = 40; row < 70; ++row) {
    drive.left[row] += row % 2 == 0 ? 0.01 : -0.01;
    drive.right[row] += row % 2 == 0 ? 0.01 : -0.01;
  }
  const RowVariables v = variables_of(drive);
  for (std::size_t row = 45; row < 65; ++row) {
    EXPECT_NEAR(v.at("speed")[row], 0.5, 0.1 / 11.0 + 1e-9) << row;  // a single row is off by 0.1
  }
}

}  // namespace
}  // namespace trussmap
