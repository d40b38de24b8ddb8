// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model's odometry row by row, against the same reckoned afterwards.
#include "trussmap/corrected_odometry.hpp"

#include "datasets/formats.hpp"
#include "drive/causal_variables.hpp"
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/online_models.hpp"
#include "shared_data.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::corrected_odometry_test {
using namespace drive;
namespace {

using testing::Equipment;
using testing::own_effect;
using testing::simulate_recording;
using testing::with;

DrivenRecording simulated(bool compass) {
  Equipment equipment;
  equipment.compass = compass;
  return simulate_recording(equipment, 3).recording;
}

CorrectedOdometry odometry_for(const MotionRows& drive, const Model& model) {
  OdometryInputs inputs;
  inputs.compass = drive.has_compass();
  for (const Covariate& one : drive.covariates) inputs.covariates.push_back(one.name);
  return CorrectedOdometry(model, inputs);
}

CorrectedRow drive_row(CorrectedOdometry& odometry, const MotionRows& drive, std::size_t row) {
  std::vector<double> covariates;
  for (const Covariate& one : drive.covariates) covariates.push_back(one.values[row]);
  return odometry.drive({drive.duration(row), drive.pair.left[row], drive.pair.right[row],
                         drive.has_compass() ? drive.heading[row] : kAbsent},
                        covariates);
}

std::vector<CorrectedRow> replayed(const DrivenRecording& recording, const Model& model) {
  CorrectedOdometry odometry = odometry_for(recording.drive, model);
  std::vector<CorrectedRow> rows;
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    rows.push_back(drive_row(odometry, recording.drive, row));
  }
  return rows;
}

struct Difference {
  double place = 0.0;       ///< m, largest
  double heading = 0.0;     ///< rad, largest
  double covariance = 0.0;  ///< largest, of its norm
};

Difference difference(const std::vector<CorrectedRow>& rows, const std::vector<TimedPose>& after) {
  Difference largest;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const PoseEstimate& here = rows[k].pose;
    const PoseEstimate& there = after[k + 1].estimate;
    largest.place = std::max(largest.place, (here.pose.position() - there.pose.position()).norm());
    largest.heading = std::max(largest.heading, std::abs(here.pose.heading - there.pose.heading));
    largest.covariance = std::max(largest.covariance, (here.covariance - there.covariance).norm() /
                                                          (there.covariance.norm() + 1e-12));
  }
  return largest;
}

void expect_the_same(const DrivenRecording& recording, const Model& model,
                     const std::string& what) {
  const Difference d =
      difference(replayed(recording, model), dead_reckoned_poses(recording, model));
  EXPECT_LT(d.place, 1e-10) << what;
  EXPECT_LT(d.heading, 1e-12) << what;
  EXPECT_LT(d.covariance, 1e-11) << what;
}

/// Shapes that need nothing of the future: to rounding, over 580 s and 5807 rows.
TEST(CorrectedOdometry, IsDeadReckoningByTheModelRowByRow) {
  const std::vector<std::pair<std::string, std::vector<double>>> effects{
      {"wheelbase", {0.03}},
      {"wheel scale", {0.02}},
      {"travel scale", {-0.01}},
      {"wheel diameter ratio", {0.004}},
      {"load on both wheels (payload_kg)", {0.002}},
      {"load on one wheel (payload_kg)", {0.001}},
      {"heading drift", {0.002}},
      {"constant creep", {0.02}},
      {"loss per start", {0.02}},
      {"twist per spin", {0.01}},
      {"backlash", {0.003, -0.002}},
      {"tyre drift (t)", {1e-4}},
      {"tyre drift (distance)", {1e-4}},
      {"compass offset", {0.05}},
      {"compass disturbance (lights)", {0.03}},
      {"sighting delay", {0.2}},
      {"lever arm", {0.1}},
      {"range bias", {0.1}}};
  for (const bool compass : {false, true}) {
    const DrivenRecording recording = simulated(compass);
    std::vector<Effect> all;
    for (const auto& [name, coefficients] : effects) {
      all.push_back(catalogue_effect(name, coefficients));
      expect_the_same(recording, with({all.back()}), name);
    }
    all.push_back(own_effect(Channel::travel, "payload_kg*0.001", 1.0));
    expect_the_same(recording, with(all), "all together");
    Model noisy = with(all);
    noisy.noise.heading_per_s = 0.001;
    noisy.noise.heading_per_rad = 0.002;
    noisy.noise.travel_per_s = 0.001;
    expect_the_same(recording, noisy, "further noise");
  }
}

/// Before the first reading the pose does not know what the reading will leave of the heading.
TEST(CorrectedOdometry, AgreesFromTheFirstReadingOn) {
  DrivenRecording recording = simulated(true);
  for (std::size_t row = 0; row < 50; ++row) recording.drive.heading[row] = kAbsent;
  for (std::size_t row = 51; row < 5000; row += 3) recording.drive.heading[row] = kAbsent;
  const Model model = with({catalogue_effect("wheelbase", {0.03})});
  const std::vector<CorrectedRow> rows = replayed(recording, model);
  const std::vector<TimedPose> after = dead_reckoned_poses(recording, model);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const PoseEstimate& there = after[row + 1].estimate;
    EXPECT_LT((rows[row].pose.pose.position() - there.pose.position()).norm(), 1e-9);
    const double covariance = (rows[row].pose.covariance - there.covariance).norm();
    EXPECT_EQ(covariance > 1e-9, row < 50) << row;
  }
}

/// Afterwards, two passes see the path; here each row sees it at its best. A hard iron of 0.05
/// bends the first path by as much, the second by its square, and its cube is what the readings
/// lack.
TEST(CorrectedOdometry, SeesThePathAtItsBest) {
  const DrivenRecording recording = simulated(true);
  double way = 0.0;
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    way += std::abs(recording.drive.forward[row]);
  }
  for (const double a : {0.05, 0.02}) {
    const Model model = with({catalogue_effect("hard iron", {a, 0.0})});
    const Difference d =
        difference(replayed(recording, model), dead_reckoned_poses(recording, model));
    EXPECT_LT(d.heading, a * a * a);
    EXPECT_LT(d.place, a * a * a * way);
  }
  // A slope turns nothing: without a compass all passes see the same headings.
  expect_the_same(simulated(false), with({catalogue_effect("slope", {0.02, 0.01})}), "slope");
}

/// What the second up to now lacks to the second about now, at most: a loss in the direction of
/// travel moves no heading, so that poses differ by no more than the sum of the rows' differences.
void expect_late_only(const DrivenRecording& recording, const Robot& robot, Channel channel,
                      const char* shape, double a) {
  Model model = with({own_effect(channel, shape, a)});
  model.robot = robot;
  const MotionRows& drive = recording.drive;
  const RowVariables about = row_variables(drive, robot, {}, std::vector<Pose>(drive.rows()), 0);
  const std::vector<double>& whole = about.at(shape);
  CausalVariables variables;
  double most = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const WheelWay wheels{drive.pair.at(row)};
    const BodyMotion body = drive.motion(row);
    const CausalRow now = variables.next(wheels, body, drive.duration(row));
    variables.take(wheels, body, drive.duration(row));
    const double f = std::string(shape) == "speed" ? now.speed : now.arc_angle;
    const double path = std::abs(drive.forward[row]);
    most += std::abs(a * (f - whole[row])) * (channel == Channel::travel ? path : 1.0);
  }
  const std::vector<TimedPose> after = dead_reckoned_poses(recording, model);
  const Difference d = difference(replayed(recording, model), after);
  EXPECT_LT(d.place, most + 1e-8) << shape;
  EXPECT_LT(d.heading, 1e-9) << shape;
  Model nominal = model;
  nominal.effects.clear();
  const double effect =
      difference(replayed(recording, nominal), after).place;  // what it moves at all
  EXPECT_GT(effect, 0.01) << shape;
  EXPECT_LT(d.place, 0.2 * effect) << shape;
}

TEST(CorrectedOdometry, RatesAreLateAndNothingElse) {
  const DrivenRecording recording = simulated(false);
  expect_late_only(recording, {}, Channel::travel, "speed", -0.1);
  expect_late_only(recording, {}, Channel::advance, "arc_angle", -0.1);
}

TEST(CorrectedOdometry, RatesOfARealRobotAreLateAndNothingElse) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  const Dataset read = datasets::read_mrclam(testing::shared("data/mrclam/MRCLAM_Dataset6/Robot1"));
  expect_late_only(testing::driven(read.recording, read.model.robot), read.model.robot,
                   Channel::travel, "speed", -0.1);
  expect_late_only(testing::driven(read.recording, read.model.robot), read.model.robot,
                   Channel::advance, "arc_angle", -0.1);
}

/// Two wheels have no steering that could be scaled.
TEST(CorrectedOdometry, RefusesEffectsOfAnotherDrive) {
  Model model;
  model.effects.push_back(catalogue_effect("steering gain"));
  try {
    const CorrectedOdometry odometry(model);
    FAIL() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "effect \"steering gain\": channel \"steer_gain\" is of another drive than "
                 "differential");
  }
}

/// Without a compass rows make up the pose; each has the covariance of its own arc.
TEST(CorrectedOdometry, RowsMakeUpThePose) {
  const DrivenRecording recording = simulated(false);
  const Model model =
      with({catalogue_effect("wheelbase", {0.03}), catalogue_effect("constant creep", {0.02})});
  Pose pose;
  for (const CorrectedRow& row : replayed(recording, model)) {
    pose = compose(pose, row.motion.displacement);
    EXPECT_NEAR(pose.x, row.pose.pose.x, 1e-9);
    EXPECT_NEAR(pose.y, row.pose.pose.y, 1e-9);
    EXPECT_NEAR(pose.heading, row.pose.pose.heading, 1e-9);
  }
  CorrectedOdometry odometry(with({catalogue_effect("wheel scale", {0.1})}));
  const Matrix3 row = odometry.drive({0.1, 0.5, 0.5}).motion.covariance;
  const Matrix3 alone = arc_covariance({0.55, 0.55}, 0.1, Robot{}, Noise{});
  EXPECT_LT((row - alone).norm(), 1e-18);
}

TEST(CorrectedOdometry, EqualRowsGiveEqualResults) {
  const DrivenRecording recording = simulated(true);
  const Model model = with(
      {catalogue_effect("slip with speed", {-0.02}), catalogue_effect("hard iron", {0.03, 0.01})});
  const std::vector<CorrectedRow> once = replayed(recording, model);
  const std::vector<CorrectedRow> twice = replayed(recording, model);
  for (std::size_t row = 0; row < once.size(); ++row) {
    EXPECT_EQ(once[row].pose.pose.x, twice[row].pose.pose.x);
    EXPECT_EQ(once[row].pose.pose.heading, twice[row].pose.pose.heading);
    EXPECT_EQ(once[row].pose.covariance, twice[row].pose.covariance);
  }
}

/// The pose begins anew, while time, distance and the place in the map go on.
TEST(CorrectedOdometry, ResetCountsThePoseAnew) {
  for (const bool compass : {false, true}) {
    const DrivenRecording recording = simulated(compass);
    const Model model = with({catalogue_effect("tyre drift (distance)", {1e-4}),
                              catalogue_effect("slope", {0.02, 0.01}),
                              own_effect(Channel::travel, "0.001*x", 1.0)});
    const std::vector<CorrectedRow> whole = replayed(recording, model);
    CorrectedOdometry odometry = odometry_for(recording.drive, model);
    const std::size_t half = recording.drive.rows() / 2;
    for (std::size_t row = 0; row < half; ++row) drive_row(odometry, recording.drive, row);
    odometry.reset();
    EXPECT_EQ(odometry.pose().pose.heading, 0.0);
    EXPECT_EQ(odometry.pose().covariance(0, 0), 0.0);
    EXPECT_EQ(odometry.pose().covariance(2, 2),
              compass ? whole[half - 1].pose.covariance(2, 2) : 0.0);
    for (std::size_t row = half; row < half + 500; ++row) {
      const CorrectedRow here = drive_row(odometry, recording.drive, row);
      EXPECT_NEAR(here.motion.displacement.x, whole[row].motion.displacement.x, 1e-6);
      // With a compass, what a reading says of the way before it no longer moves the place.
      const Pose there = relative(whole[half - 1].pose.pose, whole[row].pose.pose);
      EXPECT_NEAR(here.pose.pose.heading, there.heading, compass ? 1e-6 : 1e-9);
      EXPECT_NEAR(here.pose.pose.x, there.x, compass ? 0.05 : 1e-9);
    }
  }
}

}  // namespace
}  // namespace trussmap::corrected_odometry_test
