// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which gross misfits need no gross cause, in drawn worlds.
#include "criticism/small_causes.hpp"

#include "criticism/fewest_constants.hpp"
#include "criticism/gross_constants.hpp"
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulated_recording.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace trussmap::small_causes_test {
using namespace criticism;
namespace {

struct Misfit {
  std::vector<DrivenRecording> recordings;
  ModelFit given;
};

Misfit misfit_by(const std::vector<Effect>& effects) {
  SimulationSettings settings;
  settings.mesh = "4x4";
  settings.tours = 3;
  settings.seed = 8;
  const SimulatedRecording one = simulate(settings, effects);
  Misfit result{{testing::driven(one.drive.recording)},
                fit_model({one.drive.recording}, one.model)};
  EXPECT_GT(result.given.chi2, kGrossMisfit * result.given.dof);
  return result;
}

TEST(SmallCauses, ExplainWhatSmallErrorsDo) {
  const Misfit hard_iron = misfit_by({catalogue_effect("hard iron", {0.03, -0.02})});
  EXPECT_EQ(explained_by(hard_iron.recordings, hard_iron.given), ExplainedBy::small_ones);
  EXPECT_FALSE(gross_constants(hard_iron.recordings, hard_iron.given, LegOptions{}));
  const Misfit two = misfit_by({catalogue_effect("hard iron", {0.03, -0.02}),
                                catalogue_effect("wheel diameter ratio", {0.02})});
  EXPECT_EQ(explained_by(two.recordings, two.given), ExplainedBy::small_ones);
}

TEST(SmallCauses, DoNotExplainAGrossConstant) {
  for (const Effect& constant :
       {catalogue_effect("wheelbase", {-0.15}), catalogue_effect("wheel diameter ratio", {-0.15}),
        wheel_of_other_size(Channel::right, -0.15)}) {
    const Misfit gross = misfit_by({constant});
    EXPECT_EQ(explained_by(gross.recordings, gross.given), ExplainedBy::nothing_small)
        << constant.name;
  }
}

TEST(SmallCauses, DoNotExplainALargeErrorOfTheDrive) {
  const Misfit scrub = misfit_by({catalogue_effect("turn scrub", {-0.3})});
  EXPECT_NE(explained_by(scrub.recordings, scrub.given), ExplainedBy::small_ones);
}

}  // namespace
}  // namespace trussmap::small_causes_test
