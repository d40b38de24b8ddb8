// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps that their survey contradicts, and paths that their truth does: neither is called good.
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::measured_doubts_test {
namespace {

SimulatedRecording toured(double travel = 0.0) {
  SimulationSettings settings;
  settings.mesh = "5x5";
  settings.tours = 2;
  settings.seed = 4;
  if (travel == 0.0) return simulate(settings, {});
  return simulate(settings, {catalogue_effect("travel scale", {travel})});
}

/// The map of a sound drive whose survey somebody wrote down otherwise.
template <typename Change>
BuiltMap surveyed(const Change& change) {
  SimulatedRecording one = toured();
  for (SurveyPoint& point : one.drive.recording.survey) change(point);
  return build_map({one.drive.recording}, one.model);
}

bool says(const BuiltMap& built, const std::string& words) {
  return verdict_in_words(built).find(words) != std::string::npos;
}

TEST(MeasuredDoubts, NoneOfASurveyThatTheMapFits) {
  const BuiltMap built = surveyed([](SurveyPoint&) {});
  EXPECT_TRUE(built.good()) << verdict_in_words(built);
  EXPECT_TRUE(built.on_survey->comparison.has_scale());
}

TEST(MeasuredDoubts, ASurveyInAnotherUnit) {
  for (const double unit : {100.0, 3.28084, 1e-3}) {
    const BuiltMap built = surveyed([unit](SurveyPoint& point) {
      point.x *= unit;
      point.y *= unit;
    });
    EXPECT_FALSE(built.good());
    EXPECT_TRUE(says(built, unit > 1.0 ? "times as large" : "times as small"))
        << verdict_in_words(built);
    EXPECT_TRUE(built.on_survey->comparison.has_scale());
  }
}

TEST(MeasuredDoubts, AMirroredSurvey) {
  const BuiltMap mirrored = surveyed([](SurveyPoint& point) { point.x = -point.x; });
  EXPECT_TRUE(says(mirrored, "the mirrored survey:")) << verdict_in_words(mirrored);
  EXPECT_FALSE(mirrored.on_survey->comparison.has_scale());
  const BuiltMap exchanged = surveyed([](SurveyPoint& point) { std::swap(point.x, point.y); });
  EXPECT_TRUE(says(exchanged, "the mirrored survey:")) << verdict_in_words(exchanged);
  const BuiltMap both = surveyed([](SurveyPoint& point) {
    point.x *= -100.0;
    point.y *= 100.0;
  });
  EXPECT_TRUE(says(both, "the mirrored survey in another unit")) << verdict_in_words(both);
}

TEST(MeasuredDoubts, ASurveyOfAnotherPlace) {
  int k = 0;
  const BuiltMap built = surveyed([&k](SurveyPoint& point) {
    point.x = 5.0 * std::cos(1.7 * k);
    point.y = 5.0 * std::sin(2.9 * k++);
  });
  EXPECT_FALSE(built.good());
}

// With a compass all directions are right, and the map is half as large.
TEST(MeasuredDoubts, TravelThatIsHalfAsLong) {
  const SimulatedRecording one = toured(1.0);
  const BuiltMap built = build_map({one.drive.recording}, one.model);
  EXPECT_TRUE(says(built, "it fits a map 2 times as large")) << verdict_in_words(built);
}

// A map of landmarks without a survey, and a tracker's truth of its robot, as written down
// otherwise.
TEST(MeasuredDoubts, ATruthThatContradictsAMapOfLandmarks) {
  const auto built_with = [](double x, double y) {
    SimulatedRecording one = toured();
    Recording& recording = one.drive.recording;
    recording.survey.clear();
    const auto& rows = one.drive.motion.rows;
    for (std::size_t row = 1; row < rows.size(); row += 2) {
      const Pose& pose = rows[row].pose;
      recording.truth.push_back({recording.drive.t[row], x * pose.x, y * pose.y, pose.heading});
    }
    return build_map({recording}, one.model);
  };
  const BuiltMap right = built_with(1.0, 1.0);
  EXPECT_TRUE(right.good()) << verdict_in_words(right);
  const BuiltMap mirrored = built_with(-1.0, 1.0);
  EXPECT_TRUE(says(mirrored, "the mirrored truth:")) << verdict_in_words(mirrored);
  const BuiltMap large = built_with(100.0, 100.0);
  EXPECT_TRUE(says(large, "times as large: is the truth in another unit"))
      << verdict_in_words(large);
}

// The path of a drive by fixes and its truth in centimetres.
TEST(MeasuredDoubts, ATruthInAnotherUnit) {
  SimulationSettings settings;
  settings.mesh = "4x4";
  settings.tours = 1;
  settings.seed = 4;
  settings.fix_rate = 2.0;
  SimulatedRecording one = simulate(settings, {});
  Recording& recording = one.drive.recording;
  recording.sightings.clear();
  recording.survey.clear();
  const auto& rows = one.drive.motion.rows;
  for (std::size_t row = 9; row < rows.size(); row += 10) {
    const Pose& pose = rows[row].pose;
    recording.truth.push_back({recording.drive.t[row], pose.x, pose.y, pose.heading});
  }
  EXPECT_TRUE(build_map({recording}, one.model).good());
  for (TruthRow& row : recording.truth) {
    row.x *= 100.0;
    row.y *= 100.0;
  }
  const BuiltMap built = build_map({recording}, one.model);
  EXPECT_TRUE(says(built, "the truth contradicts the path")) << verdict_in_words(built);
}

}  // namespace
}  // namespace trussmap::measured_doubts_test
