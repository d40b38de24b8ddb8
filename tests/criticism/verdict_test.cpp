// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// compare, diagnose and discover agree on the same fit.
#include "criticism/verdict.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "shared_data.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::verdict_test {
using namespace criticism;
namespace {

Trend trend(double p_adjusted) {
  Trend one;
  one.p_adjusted = p_adjusted;
  return one;
}

TEST(Verdict, EitherQuestionHasHalfTheLevel) {
  EXPECT_EQ(misfit_of(0.026, {trend(0.026)}, 0.05), Objection::none);
  EXPECT_EQ(misfit_of(0.024, {trend(1.0)}, 0.05), Objection::chi2);
  EXPECT_EQ(misfit_of(1.0, {trend(0.9), trend(0.024)}, 0.05), Objection::trend);
  EXPECT_EQ(misfit_of(1e-9, {trend(1e-9)}, 0.05), Objection::chi2);
  EXPECT_EQ(misfit_of(0.024, {}, 0.01), Objection::none);
}

void expect_agreement(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                      const std::string& what) {
  const Diagnosis diagnosed = diagnose(recordings, fit);
  // The same fit: under the noise that the diagnosis has estimated.
  const Comparison compared = compare(recordings, diagnosed.under->fit);
  EXPECT_EQ(compared.chi2, diagnosed.chi2) << what;
  EXPECT_EQ(compared.dof, diagnosed.dof) << what;
  EXPECT_EQ(compared.coefficients, diagnosed.coefficients) << what;
  EXPECT_EQ(compared.consistent(), diagnosed.verdict == Diagnosis::Verdict::nothing_missing)
      << what << ": " << static_cast<int>(compared.objection) << ", "
      << static_cast<int>(diagnosed.verdict);
  if (diagnosed.verdict == Diagnosis::Verdict::unexplained_misfit) {
    EXPECT_EQ(compared.objection, diagnosed.objection) << what;
  }
  if (compared.objection == Objection::effect) {
    EXPECT_EQ(compared.missing, diagnosed.missing);
  }
}

TEST(SlowVerdict, OnThePracticeRecordingsNoneContradictsAnother) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"}) {
    const std::filesystem::path folder = testing::shared("data/hidden") / name;
    const std::vector<DrivenRecording> recordings{testing::driven(read_recording(folder))};
    expect_agreement(recordings, fit_model(recordings, read_model(folder / "model.toml")), name);
  }
}

TEST(SlowVerdict, OnSimulatedRecordingsNoneContradictsAnother) {
  // Wrong by less and less, from what anybody sees to what nobody can.
  int seen = 0;
  int unseen = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    testing::SimulatedRecording one =
        testing::simulate_recording({true, true, seed % 2 == 0}, seed);
    const double wrong = 0.02 / static_cast<double>(seed * seed);
    for (double& left : one.recording.drive.pair.left) left *= 1.0 + wrong;
    testing::retake(one.recording.drive);
    const std::vector<DrivenRecording> recordings{one.recording};
    const ModelFit fit = fit_model(recordings, one.model);
    expect_agreement(recordings, fit, std::to_string(seed));
    (compare(recordings, fit).consistent() ? unseen : seen) += 1;
  }
  EXPECT_GT(seen, 0);
  EXPECT_GT(unseen, 0);
}

TEST(SlowVerdict, TheModelFoundIsJudgedAsDiagnoseAndCompareJudgeIt) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  for (const char* name : {"a", "d", "f", "h"}) {
    const std::filesystem::path folder = testing::shared("data/hidden") / name;
    const std::vector<DrivenRecording> recordings{testing::driven(read_recording(folder))};
    for (const std::size_t most : {1U, 6U}) {
      DiscoverOptions options;
      options.most_effects = most;
      const Discovery found = discover(recordings, read_model(folder / "model.toml"), options);
      expect_agreement(recordings, found.found, name);
      EXPECT_EQ(found.consistent, compare(recordings, found.found).consistent()) << name;
    }
  }
}

}  // namespace
}  // namespace trussmap::verdict_test
