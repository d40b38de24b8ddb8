// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/table.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

TEST(TextTable, AlignsByCharactersAndEndsLinesCleanly) {
  TextTable table{{Align::left, Align::right, Align::left}, {}, true, 1};
  table.rows = {{"name", "value", ""}, {"a", "1.5", "\u00b1 2"}, {"longer", "\u22122", "m"}, {"b"}};
  EXPECT_EQ(format_table(table),
            " name    value\n"
            " ------  -----  ---\n"
            " a         1.5  \u00b1 2\n"
            " longer     \u22122  m\n"
            " b\n");
}

TEST(Shortened, CountsCharacters) {
  EXPECT_EQ(shortened("four", 4), "four");
  EXPECT_EQ(shortened("fives", 4), "f...");
  EXPECT_EQ(shortened("\u00e4\u00e4\u00e4\u00e4", 4), "\u00e4\u00e4\u00e4\u00e4");
  EXPECT_EQ(shortened("\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4", 5), "\u00e4\u00e4...");
}

TEST(QuantityText, ValueAndErrorShareTheirLastDigit) {
  const auto both = [](double value, double error) {
    const QuantityText text = quantity_text(value, error);
    return text.value + "|" + text.error;
  };
  EXPECT_EQ(both(0.336172, 0.000152), "0.33617|0.00015");
  EXPECT_EQ(both(-12.3456, 0.0996), "-12.35|0.10");
  EXPECT_EQ(both(1234.56, 78.9), "1235|79");
  EXPECT_EQ(both(0.5, 0.0), "0.5|");
  EXPECT_EQ(both(0.5, std::numeric_limits<double>::quiet_NaN()), "0.5|");
  EXPECT_EQ(both(1.0, 3.2e-13), "1|3.2e-13");
  EXPECT_EQ(both(std::nan(""), 1.0), "-|");
}

TEST(ProbabilityText, SmallOnesAreShownAsSmall) {
  EXPECT_EQ(probability_text(0.314), "0.31");
  EXPECT_EQ(probability_text(0.0042), "0.004");
  EXPECT_EQ(probability_text(3.2e-9), "3e-09");
  EXPECT_EQ(probability_text(std::nan("")), "-");
}

}  // namespace
}  // namespace trussmap
