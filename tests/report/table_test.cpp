// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/table.hpp"

#include "text/number_text.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace trussmap::table_test {
using namespace text;
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

TEST(QuantityText, WhatRoundsToNothingHasNoSign) {
  EXPECT_EQ(quantity_text(-0.0004, 0.011).value, "0.000");
  EXPECT_EQ(quantity_text(-0.0104, 0.011).value, "-0.010");
  EXPECT_EQ(signed_fixed_text(-0.004, 2), "0.00");
  EXPECT_EQ(signed_fixed_text(0.004, 2), "0.00");
  EXPECT_EQ(signed_fixed_text(-0.006, 2), "-0.01");
  EXPECT_EQ(signed_fixed_text(1.5, 1), "+1.5");
  EXPECT_EQ(without_sign_of_nothing("-"), "-");
  EXPECT_EQ(without_sign_of_nothing("-."), "-.");
  TextTable table{{Align::right}, {{"-0.0"}, {"+0"}, {"-0.1"}}, false, 0};
  EXPECT_EQ(format_table(table), " 0.0\n   0\n-0.1\n");
}

TEST(TimesText, ShowsThatItIsNotOne) {
  EXPECT_EQ(times_text(2.66), "2.7");
  EXPECT_EQ(times_text(1.04), "1.04");
  EXPECT_EQ(times_text(1.004), "1.004");
  EXPECT_EQ(times_text(0.97), "0.97");
  EXPECT_EQ(times_text(1.0), "1.0000");
}

TEST(ProbabilityText, SmallOnesAreShownAsSmall) {
  EXPECT_EQ(probability_text(0.314), "0.31");
  EXPECT_EQ(probability_text(0.0042), "0.004");
  EXPECT_EQ(probability_text(3.2e-9), "3e-09");
  EXPECT_EQ(probability_text(std::nan("")), "-");
}

TEST(ShortenedWords, LeavesMessagesThatCanBeReadAsTheyAre) {
  for (const std::string text :
       {"", "a", "rec/drive.csv:2: column left is \"x\", expected a number", "two\nlines\n",
        "  blanks  stay ", "\" one quote", "a \"b\" \"c d\""}) {
    EXPECT_EQ(shortened_words(text), text);
  }
  const std::string path = "/" + std::string(290, 'd') + "/f:1: wrong";
  EXPECT_EQ(shortened_words(path), path);
}

TEST(ShortenedWords, ShowsTheEndsOfALongWordAndTheRestOfTheLine) {
  const std::string word = "begin" + std::string(10000, 'x') + "end";
  const std::string said = shortened_words("f:3: \"" + word + "\", expected a number");
  EXPECT_LT(said.size(), 200U);
  EXPECT_TRUE(said.starts_with("f:3: \"beginxxx")) << said;
  EXPECT_TRUE(said.ends_with("xxxend\", expected a number")) << said;
  EXPECT_NE(said.find("x...x"), std::string::npos) << said;
}

TEST(ShortenedWords, ShortensQuotedBlanksAndEndlessLists) {
  std::string blanks;
  for (int k = 0; k < 5000; ++k) blanks += "a ";
  EXPECT_LT(shortened_words("shape \"" + blanks + "\" is wrong").size(), 200U);
  EXPECT_LT(shortened_words(blanks).size(), 1100U);
  EXPECT_TRUE(shortened_words(blanks + "expected a").ends_with("expected a"));
}

TEST(ShortenedWords, CutsNoCharacterInTwo) {
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::string word(shift, 'a');
    for (int k = 0; k < 1000; ++k) word += "\u2713";
    const std::string said = shortened_words(word);
    EXPECT_EQ(escaped_controls(said), said);
    EXPECT_LT(said.size(), 120U);
  }
}

}  // namespace
}  // namespace trussmap::table_test
