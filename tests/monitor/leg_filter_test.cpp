// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The monitor's filter beside the least-squares fit of the whole recording: the squares of its
// innovations add up to the fit's chi^2, and what effects do to them to the fit's standard errors.
#include "monitor/leg_filter.hpp"

#include "effects/simple_shapes.hpp"
#include "fit/online_odometry.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::leg_filter_test {
using namespace monitor;
namespace {

struct Filtered {
  double squares = 0.0;
  long numbers = 0;
  double score = 0.0;         ///< h w of the effect watched, from the first leg on
  double information = 0.0;   ///< h h
  std::vector<double> ahead;  ///< numbers of the landmarks' innovations, ahead of the robot
};

Filtered filtered(const Recording& recording, const Model& model, Channel channel, int landmarks) {
  OdometryInputs inputs;
  inputs.compass = recording.drive.has_compass();
  inputs.gyro = recording.drive.has_gyro();
  for (const Covariate& one : recording.drive.covariates) inputs.covariates.push_back(one.name);
  fitting::OnlineOdometry odometry(model, inputs);
  LegOdometry leg({channel});
  LegFilter filter({}, landmarks, 1);
  filter.set_columns(1);
  Filtered result;
  const LegFilter::Said said = [&](const Eigen::VectorXd& w, const Eigen::MatrixXd& columns) {
    result.squares += w.squaredNorm();
    result.numbers += w.size();
    if (w.size() == 2) result.ahead.push_back(w[0]);
    result.score += w.dot(columns.col(0));
    result.information += columns.col(0).squaredNorm();
  };
  std::map<std::string, MapPlace> survey;
  for (const SurveyPoint& point : recording.survey) {
    survey[point.landmark] = {{point.x, point.y},
                              model.noise.survey * model.noise.survey * Matrix2::Identity()};
  }
  const Drive& drive = recording.drive;
  std::size_t row = 0;
  std::vector<double> covariates(inputs.covariates.size());
  for (const Sighting& sighting : recording.sightings) {
    for (; row < drive.rows() && drive.t[row] <= sighting.t + 1e-9; ++row) {
      WheelRow one{drive.duration(row), drive.left[row], drive.right[row]};
      if (inputs.compass) one.compass = drive.heading[row];
      if (inputs.gyro) one.yaw_rate = drive.yaw_rate[row];
      for (std::size_t k = 0; k < covariates.size(); ++k) {
        covariates[k] = drive.covariates[k].values[row];
      }
      const CorrectedRow corrected = odometry.drive(one, covariates);
      const double gyro = model.noise.gyro * model.noise.gyro * one.duration;
      leg.take(corrected.motion, odometry.shown(), odometry.reading(), odometry.excess(),
               gyro / (1.0 - odometry.shown().gyro_share));
    }
    const LegReckoning done = leg.finish();
    filter.drive(done, done.by_channel, LegColumns::Zero(5, 0));
    if (done.gyro_readings > 0) filter.read_gyro(said);
    filter.read_compass(done, model.noise.compass, Eigen::RowVectorXd::Zero(1), said);
    const auto known = survey.find(sighting.landmark);
    filter.see(sighting.landmark, landmark_offset(sighting, model.noise),
               known == survey.end() ? nullptr : &known->second, said);
  }
  return result;
}

struct Drawn {
  Recording recording;
  Model model;
};

/// 120 legs on 3 x 3 landmarks.
Drawn drawn(std::uint64_t seed, bool compass, bool survey, const WheeledRobot& as = {}) {
  Drawn result;
  const Mesh mesh = even_mesh({3, 3}, 4.0);
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  std::vector<int> walk = make_tours(mesh, WalkKind::random, 12, random).walk;
  walk.resize(121);
  WheeledRobot robot = as;
  robot.compass = compass;
  DrivingStyle style;
  style.row_duration = 0.5;
  result.model.robot.wheelbase = robot.geometry.wheelbase;
  result.model.noise.left = result.model.noise.right = robot.noise.left;
  result.recording = simulate_drive(mesh, walk, style, robot, seed).recording;
  if (!survey) result.recording.survey.clear();
  return result;
}

/// Over all landmarks the filter is recursive least squares; what differs is of second order, but
/// that a compass is averaged over each leg: chi^2 within its numbers' own spread, degrees of
/// freedom the same.
TEST(LegFilter, InnovationsAddUpToTheFitsChiSquare) {
  for (const bool survey : {true, false}) {
    const Drawn one = drawn(5, false, survey);
    const ModelFit fit = fit_model({one.recording}, one.model);
    const Filtered sums = filtered(one.recording, one.model, Channel::turn, 9);
    EXPECT_NEAR(sums.squares, fit.chi2, 0.03 * fit.chi2) << survey;
    // Directions that nothing tells before they are told count among the numbers, as 0.
    EXPECT_NEAR(static_cast<double>(sums.numbers), fit.dof, survey ? 2.0 : 0.0) << survey;
  }
}

TEST(LegFilter, EffectsAreAsUncertainAsInTheFit) {
  for (const Channel channel :
       {Channel::turn, Channel::difference, Channel::left, Channel::travel, Channel::drift}) {
    Drawn one = drawn(6, false, true);
    const Filtered sums = filtered(one.recording, one.model, channel, 9);
    one.model.effects.push_back({"own", channel, {effects::constant_shape()}, {}});
    const ModelFit fit = fit_model({one.recording}, one.model);
    const double sd = fit.effects.front().sd.front();
    EXPECT_NEAR(1.0 / std::sqrt(sums.information), sd, 0.05 * sd) << name_of(channel);
    EXPECT_NEAR(sums.score / sums.information, fit.effects.front().effect.coefficients.front(),
                0.4 * sd)
        << name_of(channel);
  }
}

// Where landmarks are forgotten, innovations are still those of a right model: 40 drives of 120
// legs, seeds 100 to 139; chi^2 per number within 4 standard errors.
TEST(LegFilter, ForgettingLandmarksLeavesInnovationsWhite) {
  for (const bool compass : {true, false}) {
    double squares = 0.0;
    long numbers = 0;
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
      const Drawn one = drawn(seed, compass, false);
      const Filtered sums = filtered(one.recording, one.model, Channel::turn, 4);
      squares += sums.squares;
      numbers += sums.numbers;
    }
    const auto count = static_cast<double>(numbers);
    EXPECT_GT(numbers, 3000);
    EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << compass;
  }
}

// A short track and noisy wheels, which turn by 0.06 rad a leg: what is of second order in that
// shows, in the mean, the variance and from one leg to the next, where the filter leaves it out.
// 20 drives of 120 legs each, seeds 200 to 219; 4 standard errors, of the mean 0.06 more (measured:
// 0.03 to 0.05).
TEST(LegFilter, InnovationsOfNoisyWheelsAreWhite) {
  WheeledRobot noisy;
  noisy.geometry.wheelbase = 0.25;
  noisy.noise.left = noisy.noise.right = 0.005;
  for (const bool compass : {true, false}) {
    double sum = 0.0;
    double squares = 0.0;
    double products = 0.0;
    double count = 0.0;
    for (std::uint64_t seed = 200; seed < 220; ++seed) {
      const Drawn one = drawn(seed, compass, true, noisy);
      double before = 0.0;
      for (const double w : filtered(one.recording, one.model, Channel::turn, 9).ahead) {
        sum += w;
        squares += w * w;
        products += w * before;
        before = w;
        ++count;
      }
    }
    EXPECT_GT(count, 2000.0);
    EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count) + 0.06) << compass;
    EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << compass;
    EXPECT_NEAR(products / count, 0.0, 4.0 / std::sqrt(count)) << compass;
  }
}

}  // namespace
}  // namespace trussmap::leg_filter_test
