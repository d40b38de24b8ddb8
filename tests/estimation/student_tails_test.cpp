// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/student_tails.hpp"

#include "criticism/disturbances.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/recording_system.hpp"
#include "fit/fit_state.hpp"
#include "fit/noise_fit.hpp"
#include "fit/noise_reml.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/noise_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::student_tails_test {
using namespace estimation;
namespace {

using testing::invert;
using testing::inverted_model;
using testing::InvertedOptions;
using testing::InvertedRecording;

constexpr double kTails = 4.0;
constexpr double kRangeSd = 0.06;      // m
constexpr double kBearingSd = 0.06;    // rad
constexpr double kNormalShare = 0.05;  // stated beside the tails: no noise may be 0

/// Views whose errors have a bivariate t distribution of these standard deviations.
DrivenRecording with_tails(std::uint64_t seed, double range_bias) {
  InvertedOptions options;
  options.noisy = true;
  options.views = true;
  options.survey = false;
  const InvertedRecording world = invert({}, options, seed);
  DrivenRecording recording = world.recording;
  std::mt19937_64 random(seed + 17);
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> chi_square(kTails);
  const std::vector<double>& t = recording.drive.t;
  for (Sighting& one : recording.sightings) {
    if (one.standing()) continue;
    // Seen from rest, at the end of a row.
    const auto row =
        static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), one.t - 1e-6) - t.begin());
    const std::complex<double> offset = world.landmarks.at(one.landmark) - world.places[row];
    const double stretch = std::sqrt((kTails - 2.0) / chi_square(random));
    one.range = std::max(0.01, std::abs(offset) + range_bias + kRangeSd * stretch * normal(random));
    one.bearing = std::remainder(
        std::arg(offset) - world.headings[row] + kBearingSd * stretch * normal(random), 2.0 * M_PI);
  }
  return recording;
}

Model with_noise(double tails) {
  Model model = inverted_model();
  model.noise.range = kNormalShare * kRangeSd;
  model.noise.bearing = kNormalShare * kBearingSd;
  const auto add = [&](Channel channel, double sd) {
    NoiseProcess process;
    process.channel = channel;
    process.process = ProcessKind::white;
    process.sd = sd;
    process.tails = tails;
    model.noise.processes.push_back(process);
  };
  add(Channel::range, kRangeSd);
  add(Channel::bearing, kBearingSd);
  return model;
}

Model with_range_bias(Model model) {
  Effect effect;
  effect.name = "range bias";
  effect.channel = Channel::range;
  effect.shape = {"1"};
  model.effects.push_back(effect);
  return model;
}

// Integrals of the density, by the midpoint rule: E psi psi' = F, and E e'F e' of the error as if
// normal has as many values as rows.
TEST(StudentTails, InformationIsTheScoresVariance) {
  for (const double nu : {2.5, 4.0, 9.0}) {
    for (const int n : {1, 2}) {
      double mass = 0.0;
      double score = 0.0;
      double variance = 0.0;
      constexpr double kStep = 1e-3;
      for (double u = 0.5 * kStep; u < 25.0; u += kStep) {
        const double r = std::expm1(u);  // |C^-1/2 e|
        const double density =
            std::exp(-0.5 * tail_deviance(nu, n, r * r)) * std::pow(r, n - 1) * (r + 1.0) * kStep;
        const double psi = (nu + n) / (nu - 2.0 + r * r) * r;
        mass += density;
        score += density * psi * psi / n;
        variance += density * r * r / n;
      }
      EXPECT_NEAR(score / mass, tail_information(nu, n), 2e-3 * tail_information(nu, n));
      if (nu < 3.0) continue;                         // the tail would have to be summed further
      EXPECT_NEAR(variance / mass, 1.0, 2e-3) << nu;  // C is the covariance
    }
  }
  EXPECT_EQ(tail_information(0.0, 2), 1.0);
  EXPECT_EQ(tail_deviance(0.0, 2, 7.0), 7.0);
  EXPECT_NEAR(tail_information(1e6, 2), 1.0, 1e-5);
  EXPECT_NEAR(tail_deviance(1e6, 2, 7.0), 7.0, 1e-4);
}

// The derivative of the likelihood by the range's bias vanishes at the fit, errors reckoned here.
TEST(StudentTails, TheFitIsTheLikeliest) {
  const DrivenRecording recording = with_tails(71, 0.05);
  const ModelFit fit = fit_model({recording}, with_range_bias(with_noise(kTails)));
  const RecordingProblem& problem = fit.state->problem;
  const RecordingState& state = fit.state->adjustment.state;
  const double bias = fit.effects[0].effect.coefficients[0];
  const double range_variance = (1.0 + kNormalShare * kNormalShare) * kRangeSd * kRangeSd;
  const double bearing_variance = (1.0 + kNormalShare * kNormalShare) * kBearingSd * kBearingSd;
  double slope = 0.0;
  double information = 0.0;
  double as_normal = 0.0;
  int far = 0;
  for (const Measurement& one : problem.measurements) {
    if (one.kind != &kinds::view) continue;
    EXPECT_EQ(one.tails, kTails);
    const Pose& pose = state.poses[idx(one.from - problem.landmark_count())];
    const Vector2 offset = state.landmarks[idx(one.to)] - pose.position();
    const double range = offset.norm() + bias - one.value[0];
    const double bearing = std::remainder(
        std::atan2(offset.y(), offset.x()) - pose.heading - one.value[1], 2.0 * M_PI);
    const double squared = range * range / range_variance + bearing * bearing / bearing_variance;
    far += squared > 16.0 ? 1 : 0;
    slope += (kTails + 2.0) / (kTails - 2.0 + squared) * range / range_variance;
    information += 1.0 / range_variance;
    as_normal += range / range_variance;
  }
  ASSERT_GT(far, 1);
  EXPECT_LT(std::abs(slope), 0.02 * std::sqrt(information));
  EXPECT_GT(std::abs(as_normal), 0.2 * std::sqrt(information));
}

struct Spread {
  double squares = 0.0;  ///< of errors of the bias, m^2
  double pulls = 0.0;    ///< of errors over standard errors
  double chi2 = 0.0;
  double dof = 0.0;
};

Spread spread_of(double tails, int recordings) {
  constexpr double kBias = 0.05;  // m
  Spread sum;
  for (int k = 0; k < recordings; ++k) {
    const DrivenRecording recording = with_tails(1000 + static_cast<std::uint64_t>(k), kBias);
    const ModelFit fit = fit_model({recording}, with_range_bias(with_noise(tails)));
    const double error = fit.effects[0].effect.coefficients[0] - kBias;
    sum.squares += error * error / recordings;
    sum.pulls += std::pow(error / fit.effects[0].sd[0], 2) / recordings;
    sum.chi2 += fit.chi2;
    sum.dof += fit.dof;
  }
  return sum;
}

// Against least squares of the same covariance the variance falls by 1/F, two thirds for 4 degrees
// of freedom and two values; standard errors and chi^2 hold.
TEST(SlowStudentTails, EstimatesAreTwoThirdsAsUncertain) {
  constexpr int kRecordings = 150;
  const Spread normal = spread_of(0.0, kRecordings);
  const Spread tails = spread_of(kTails, kRecordings);
  EXPECT_NEAR(tails.squares / normal.squares, 1.0 / tail_information(kTails, 2), 0.15);
  EXPECT_NEAR(tails.pulls, 1.0, 0.3);
  EXPECT_NEAR(tails.chi2 / tails.dof, 1.0, 0.02);
}

TEST(StudentTails, WhereTheyAreNotUsedAWarningSaysSo) {
  const DrivenRecording recording = with_tails(72, 0.0);
  Model model = with_noise(kTails);
  EXPECT_TRUE(fit_model({recording}, model).warnings.empty());
  NoiseProcess turn;
  turn.channel = Channel::turn;
  turn.process = ProcessKind::white;
  turn.sd = 0.001;
  turn.tails = 3.0;
  model.noise.processes.push_back(turn);
  const std::vector<std::string> warnings = fit_model({recording}, model).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "the tails of the noise turn, white are not used: only white noise of sightings has "
            "them");
}

// A gate is as wide for them as for normal errors that are as unlikely.
TEST(StudentTails, AGateLeavesOutHardlyAny) {
  const DrivenRecording recording = with_tails(75, 0.0);
  FitOptions options;
  options.gate = 16.0;
  const ModelFit normal = fit_model({recording}, with_noise(0.0), options);
  const ModelFit tails = fit_model({recording}, with_noise(kTails), options);
  EXPECT_GT(normal.state->adjustment.left_out.size(), tails.state->adjustment.left_out.size());
  EXPECT_LE(tails.state->adjustment.left_out.size(), 1U);
}

// An effect's columns are the same whether sightings have tails, and weigh by what these tell, or
// count by their variance, as for the size of the noise.
TEST(StudentTails, ColumnsBesideTheNoiseAreWhitenedByItsVariance) {
  const DrivenRecording recording = with_tails(76, 0.05);
  const ModelFit fitted = fit_model({recording}, with_range_bias(with_noise(kTails)));
  const fitting::FitState& fit = *fitted.state;
  const auto columns_under = [&fit](const RecordingProblem& problem) {
    RecordingSystem system(problem, fit.columns.border);
    system.linearise(fit.adjustment.state, fit.adjustment.coefficients);
    return Eigen::MatrixXd(system.border());
  };
  fitting::NoiseReml reml(fit, fit.model.noise);
  (void)fitting::minus_two_log_under(reml, fit.model.noise, columns_under(fit.problem));
  const Eigen::MatrixXd expected = columns_under(reml.problem());
  const Eigen::Index rows = std::min(expected.rows(), reml.nuisance().rows());
  const auto sightings = expected.topRows(rows);
  ASSERT_GT(sightings.norm(), 1.0);
  EXPECT_LT((reml.nuisance().topRows(rows) - sightings).norm(), 1e-6 * sightings.norm());
}

TEST(StudentTails, TheirSizeIsEstimatedWithThem) {
  const DrivenRecording recording = with_tails(76, 0.0);
  Model model = with_noise(kTails);
  for (NoiseProcess& one : model.noise.processes) one.sd *= 0.6;
  const FitWithNoise fit = fit_model_and_noise({recording}, model);
  const std::vector<NoiseProcess>& found = fit.fit.model.noise.processes;
  ASSERT_GE(found.size(), 2U);
  // With the normal white noise of the same readings, which nothing tells from it.
  const Noise& noise = fit.fit.model.noise;
  EXPECT_NEAR(std::hypot(noise.range, found[0].sd) / kRangeSd, 1.0, 0.15);
  EXPECT_NEAR(std::hypot(noise.bearing, found[1].sd) / kBearingSd, 1.0, 0.15);
  EXPECT_EQ(found[0].tails, kTails);
  EXPECT_EQ(found[1].tails, kTails);
}

TEST(StudentTails, NoEffectIsMadeOfThem) {
  int named = 0;
  for (std::uint64_t seed = 80; seed < 86; ++seed) {
    const Diagnosis diagnosis = diagnose({with_tails(seed, 0.0)}, with_noise(kTails));
    named += diagnosis.verdict == Diagnosis::Verdict::missing ? 1 : 0;
  }
  EXPECT_LE(named, 1);
}

}  // namespace
}  // namespace trussmap::student_tails_test
