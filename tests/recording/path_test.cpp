// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/umbmark.hpp"

#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::path_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ParsePath, ReadsStraightsTurnsAndArcs) {
  const TestPath path = parse_path("10,-10, a90 ,a-45,3@60,-2.5@-30");
  const TestPath expected = {{10.0, 0.0},     {-10.0, 0.0},   {0.0, kPi / 2},
                             {0.0, -kPi / 4}, {3.0, kPi / 3}, {-2.5, -kPi / 6}};
  ASSERT_EQ(path.size(), expected.size());
  for (std::size_t k = 0; k < path.size(); ++k) {
    EXPECT_DOUBLE_EQ(path[k].distance, expected[k].distance) << k;
    EXPECT_DOUBLE_EQ(path[k].turn, expected[k].turn) << k;
  }
  EXPECT_DOUBLE_EQ(path_length(path), 25.5);
  const TestPath eight = parse_path("1, eight@0.5");
  ASSERT_EQ(eight.size(), 3U);
  EXPECT_DOUBLE_EQ(path_length(eight), 1.0 + 2.0 * kPi);
  EXPECT_DOUBLE_EQ(eight[1].turn, 2.0 * kPi);
  EXPECT_DOUBLE_EQ(eight[2].turn, -2.0 * kPi);
}

TEST(ParsePath, RefusesTheRestAndNamesTheSegment) {
  for (const char* text : {"",   ",",    "10,",   "10,,3", "ten",    "10m",     "a",
                           "3@", "@3",   "3@4@5", "nan",   "inf",    "1e999",   "0",
                           "a0", "0,a0", "A90",   "eight", "eight@", "eight@0", "eight@-1"}) {
    EXPECT_THROW((void)parse_path(text), std::invalid_argument) << text;
  }
  try {
    (void)parse_path("10,b7");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"b7\""), std::string::npos);
  }
}

TEST(SquarePath, ClosesAndTurnsOnce) {
  for (const Direction direction : {Direction::cw, Direction::ccw}) {
    const TestPath path = square_path(4.0, direction);
    EXPECT_DOUBLE_EQ(path_length(path), 16.0);
    double turned = 0.0;
    for (const PathSegment& segment : path) turned += segment.turn;
    EXPECT_NEAR(turned, direction == Direction::ccw ? 2 * kPi : -2 * kPi, 1e-12);
  }
}

TEST(GeometryErrors, FactorsHaveMeanOneAndMultiply) {
  const GeometryErrors first{1.01, 0.98};
  const GeometryErrors second{0.995, 1.001};
  EXPECT_DOUBLE_EQ(first.left_factor() + first.right_factor(), 2.0);
  const GeometryErrors both = combined(first, second);
  EXPECT_DOUBLE_EQ(both.right_factor() / both.left_factor(), 1.01 * 0.995);
  EXPECT_NEAR(both.left_factor() + both.right_factor(), 2.0, 1e-15);
  EXPECT_DOUBLE_EQ(both.wheelbase_ratio, 0.98 * 1.001);
}

TEST(GeometryErrors, GoIntoAModelAndComeBack) {
  Model model;
  model.effects = {{"wheelbase", Channel::turn, {"1"}, {0.5}, false},
                   {"mine", Channel::turn, {"x"}, {1.0}, false}};
  set_geometry_errors(model, {1.002, 0.99});
  ASSERT_EQ(model.effects.size(), 3U);  // the wheelbase replaced, the ratio added
  EXPECT_DOUBLE_EQ(model.effects[0].coefficients[0], 1.0 / 0.99 - 1.0);
  EXPECT_EQ(model.effects[2].channel, Channel::difference);
  EXPECT_DOUBLE_EQ(model.effects[2].coefficients[0], 2.0 * 0.002 / 2.002);
  const GeometryErrors back = geometry_errors(model);
  EXPECT_NEAR(back.diameter_ratio, 1.002, 1e-15);
  EXPECT_NEAR(back.wheelbase_ratio, 0.99, 1e-15);

  model.effects[0].channel = Channel::rotate;
  EXPECT_THROW((void)geometry_errors(model), std::invalid_argument);
  model.effects = {catalogue_effect("wheelbase")};  // not fitted yet
  EXPECT_EQ(geometry_errors(model).wheelbase_ratio, 1.0);
}

}  // namespace
}  // namespace trussmap::path_test
