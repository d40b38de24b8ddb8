// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Verdicts in words.
#include "trussmap/compare.hpp"
#include "trussmap/wording.hpp"

#include <gtest/gtest.h>

namespace trussmap::verdicts_test {
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

/// One of a hundred sound recordings looks like that: no reason to drop a model.
TEST(Verdicts, ASlightMisfitIsCalledSo) {
  Diagnosis result;
  result.verdict = Diagnosis::Verdict::unexplained_misfit;
  result.objection = Objection::chi2;
  result.tried = 1500;
  result.p_value = 0.01;
  EXPECT_TRUE(is_slight_misfit(result));
  EXPECT_EQ(verdict_in_words(result),
            "unexplained misfit, a slight one: noise alone makes such errors in one of 100 "
            "recordings, and none of 1500 effects tried explains them");
  result.p_value = 1e-6;
  EXPECT_FALSE(is_slight_misfit(result));
  EXPECT_EQ(verdict_in_words(result).find("slight"), std::string::npos);
  result.p_value = 0.01;
  result.verdict = Diagnosis::Verdict::nothing_missing;
  EXPECT_FALSE(is_slight_misfit(result));
}

}  // namespace
}  // namespace trussmap::verdicts_test
