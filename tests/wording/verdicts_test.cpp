// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Verdicts in words.
#include "trussmap/compare.hpp"
#include "trussmap/wording.hpp"

#include <gtest/gtest.h>

namespace trussmap {
namespace {

/// A model that nothing could contradict is not said to explain anything.
TEST(Verdicts, NothingLeftOverIsNoProof) {
  Comparison result;
  result.dof = 0;
  EXPECT_EQ(verdict_in_words(result),
            "consistent, but hardly tested: 0 degrees of freedom say nothing for a model; drive "
            "routes again, or survey landmarks");
  result.dof = 100;
  EXPECT_EQ(verdict_in_words(result),
            "consistent: the model explains these measurements to within its noise");
}

}  // namespace
}  // namespace trussmap
