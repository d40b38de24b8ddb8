// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps of real robots (UTIAS MRCLAM sets 6, 1 and 4, five robots each) against the survey.
#include "build_map/recording_map.hpp"
#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_start.hpp"
#include "shared_data.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

struct Result {
  std::string robot;
  SurveyComparison survey;
  double rms_dead_reckoning = 0.0;
};

MrclamRecording robot(int set, int number) {
  return read_mrclam(testing::shared("data/mrclam/MRCLAM_Dataset" + std::to_string(set) + "/Robot" +
                                     std::to_string(number)));
}

std::vector<Result> map_all_robots() {
  std::vector<Result> results;
  for (const int set : {6, 1, 4}) {
    for (int number = 1; number <= 5; ++number) {
      const MrclamRecording read = robot(set, number);
      const RecordingMap built = map_recordings({read.recording}, read.model);
      Result result;
      result.robot = std::to_string(set) + "/" + std::to_string(number);
      result.survey = compare_with_survey(positions_of(built.map), read.recording.survey);
      result.rms_dead_reckoning =
          survey_rms(built.dead_reckoned, read.recording.survey, result.survey.contradicting);
      results.push_back(result);
    }
  }
  return results;
}

TEST(SlowMrclam, TheElasticMapBeatsDeadReckoningForEveryRobot) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  std::vector<double> ratios;
  for (const Result& result : map_all_robots()) {
    const double ratio = result.rms_dead_reckoning / result.survey.rigid.rms;
    EXPECT_LE(result.survey.rigid.rms, 0.45) << result.robot;
    EXPECT_GE(ratio, 2.0) << result.robot;
    ratios.push_back(ratio);
    // The survey of set 1 has two labels exchanged, those of the others none.
    const bool exchanged = result.robot.front() == '1';
    EXPECT_EQ(result.survey.contradicting,
              exchanged ? (std::vector<std::string>{"11", "17"}) : std::vector<std::string>{})
        << result.robot;
    EXPECT_EQ(result.survey.exchanged.size(), exchanged ? 1U : 0U) << result.robot;
  }
  std::sort(ratios.begin(), ratios.end());
  EXPECT_GE(ratios[ratios.size() / 2], 5.0);
}

/// What build's method adjustment does: gate of 4 standard deviations, survey and truth not used.
SurveyComparison adjusted_against_survey(const std::vector<Recording>& recordings,
                                         const Model& model) {
  ProblemOptions measured;
  measured.survey = measured.truth = false;
  const RecordingProblem problem = make_problem(recordings, model, measured);
  RecordingAdjustmentOptions robust;
  robust.gate = 16.0;
  const RecordingAdjustment fit = adjust(problem, {}, robust);
  EXPECT_TRUE(fit.converged);
  EXPECT_LE(fit.left_out.size(), 31U);  // misread labels, of some thousand sightings
  LandmarkPositions positions;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    positions[problem.landmarks[k]] = fit.state.landmarks[k];
  }
  return compare_with_survey(positions, recordings.front().survey);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(SlowMrclam, TheAdjustedMapIsRightForEveryRobot) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  std::vector<double> rigid;
  std::vector<double> similarity;
  for (const int set : {6, 1, 4}) {
    for (int number = 1; number <= 5; ++number) {
      const MrclamRecording read = robot(set, number);
      const SurveyComparison survey = adjusted_against_survey({read.recording}, read.model);
      const RecordingProblem problem = make_problem({read.recording}, read.model, {false, false});
      LandmarkPositions reckoned;
      const RecordingState dead = dead_reckoned(problem);
      for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
        reckoned[problem.landmarks[k]] = dead.landmarks[k];
      }
      const double rms = survey_rms(reckoned, read.recording.survey, survey.contradicting);
      const std::string name = std::to_string(set) + "/" + std::to_string(number);
      EXPECT_LE(survey.rigid.rms, 0.16) << name;
      EXPECT_LE(survey.similarity.rms, 0.12) << name;
      EXPECT_GE(rms, 5.0 * survey.rigid.rms) << name;
      EXPECT_EQ(survey.contradicting.size(), set == 1 ? 2U : 0U) << name;
      rigid.push_back(survey.rigid.rms);
      similarity.push_back(survey.similarity.rms);
    }
  }
  EXPECT_LE(median(rigid), 0.11);
  EXPECT_LE(median(similarity), 0.045);
}

/// Each robot starts at a place and in a direction of its own, without a compass.
TEST(SlowMrclam, FiveRobotsMakeOneMap) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  for (const int set : {6, 1, 4}) {
    std::vector<Recording> recordings;
    Model model;
    for (int number = 1; number <= 5; ++number) {
      MrclamRecording read = robot(set, number);
      recordings.push_back(std::move(read.recording));
      model = read.model;
    }
    const RecordingMap built = map_recordings(recordings, model);
    const SurveyComparison survey =
        compare_with_survey(positions_of(built.map), recordings.front().survey);
    EXPECT_LE(survey.rigid.rms, 0.3) << set;
    EXPECT_EQ(survey.contradicting.size(), set == 1 ? 2U : 0U) << set;
    EXPECT_LE(adjusted_against_survey(recordings, model).rigid.rms, 0.11) << set;
  }
}

/// Counted with a line-by-line script of its own, once.
TEST(Mrclam, ConvertsAndCountsWhatItLeavesOut) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  const MrclamRecording read = robot(6, 1);
  EXPECT_EQ(read.recording.survey.size(), 15U);
  EXPECT_EQ(static_cast<int>(read.recording.sightings.size()) + read.robots_seen +
                read.unknown_barcodes + read.outside_drive,
            1942);  // rows of the measurement file
  EXPECT_EQ(static_cast<int>(read.recording.drive.rows()) + read.merged_times + 1, 61785);
  EXPECT_EQ(read.epoch, 1248444187.0);
  const Drive& drive = read.recording.drive;
  // The first velocity, 0.086 m/s and -0.398 rad/s, holds from 187.156 to 187.186 s.
  EXPECT_NEAR(drive.t[0], 0.186, 1e-9);
  EXPECT_NEAR(0.5 * (drive.left[0] + drive.right[0]), 0.086 * 0.030, 1e-9);
  EXPECT_NEAR((drive.right[0] - drive.left[0]) / 0.258, -0.398 * 0.030, 1e-9);
}

TEST(Mrclam, WithoutTheGateMisreadLabelsSpoilAMap) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  const MrclamRecording read = robot(4, 5);
  RecordingMapOptions open;
  open.gate = 1e9;
  open.confirmations = 1;
  const auto rms = [&](const RecordingMapOptions& options) {
    return survey_rms(positions_of(map_recordings({read.recording}, read.model, options).map),
                      read.recording.survey, {});
  };
  EXPECT_GT(rms(open), 1.5 * rms({}));
}

}  // namespace
}  // namespace trussmap
