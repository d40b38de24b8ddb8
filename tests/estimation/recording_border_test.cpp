// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients of effects, eliminated as a dense border.
#include "driven.hpp"
#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_descent.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/error.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::recording_border_test {
using namespace estimation;
namespace {

using testing::simulate_recording;
using testing::SimulatedRecording;

/// Wheelbase and compass offset in the data: what the robot records if its wheels stand
/// (1 + turn) apart relative to the nominal, and its compass is off.
void disturb(MotionRows& drive, double wheelbase, double turn, double offset) {
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    // True turn = recorded turn (1 + g): the wheels went less far apart than they should have.
    const double path = 0.5 * (drive.pair.left[row] + drive.pair.right[row]);
    const double angle = (drive.pair.right[row] - drive.pair.left[row]) / wheelbase / (1.0 + turn);
    drive.pair.left[row] = path - 0.5 * wheelbase * angle;
    drive.pair.right[row] = path + 0.5 * wheelbase * angle;
  }
  testing::retake(drive, wheelbase);
  for (double& reading : drive.heading) reading = wrap_angle(reading + offset);
}

struct Case {
  RecordingProblem problem;
  EffectParameters border;
};

Case two_effects(std::uint64_t seed, double turn, double offset) {
  SimulatedRecording simulated = simulate_recording({}, seed);
  disturb(simulated.recording.drive, simulated.model.robot.wheelbase, turn, offset);
  const std::vector<DrivenRecording> recordings = {simulated.recording};
  return {make_problem(recordings, simulated.model),
          {plain_effect(Channel::turn, recordings, simulated.model.robot),
           plain_effect(Channel::compass, recordings, simulated.model.robot)}};
}

/// All unknowns at once: rows of J and M side by side, one dense factorisation.
Eigen::MatrixXd dense_rows(const RecordingSystem& system, const RecordingProblem& problem) {
  Eigen::MatrixXd rows(system.rows(),
                       system.normal_equations().unknowns() + system.border().cols());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    rows.middleRows(system.first_row(k), problem.measurements[k].rows) =
        system.transposed_rows(k).transpose();
  }
  return rows;
}

TEST(RecordingEffectParameters, StepAndCovarianceAreThoseOfADenseJointSolve) {
  const Case one = two_effects(1, -0.02, 0.05);
  RecordingSystem system(one.problem, one.border);
  system.linearise(start_of(one.problem, {}).state, Eigen::Vector2d(0.01, 0.02));
  const RecordingSystem::Step step = system.solve_step();
  const Eigen::MatrixXd rows = dense_rows(system, one.problem);
  const Eigen::MatrixXd normal = rows.transpose() * rows;
  const Eigen::LLT<Eigen::MatrixXd> factor(normal);
  const Eigen::VectorXd dense = factor.solve(-rows.transpose() * system.residuals());
  const Eigen::Index n = dense.size() - 2;
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(step.coefficients[k], dense[n + k], 1e-8 * std::abs(dense[n + k]));
  }
  EXPECT_LT((step.nodes - dense.head(n)).norm(), 1e-8 * dense.norm());
  const Eigen::MatrixXd inverse =
      factor.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  system.factorise();
  const Matrix2 corner = inverse.bottomRightCorner<2, 2>();
  EXPECT_LT((system.coefficient_covariance() - corner).norm(), 1e-8 * corner.norm());
  const Eigen::Index at = system.normal_equations().offset(3);  // a landmark
  const std::vector<Eigen::Index> entries = {at, at + 1, n, n + 1};
  const Eigen::MatrixXd joint = system.joint_covariance({3});
  for (Eigen::Index r = 0; r < 4; ++r) {
    for (Eigen::Index c = 0; c < 4; ++c) {
      EXPECT_NEAR(joint(r, c), inverse(entries[idx(r)], entries[idx(c)]), 1e-8 * joint.norm());
    }
  }
}

TEST(RecordingEffectParameters, BothEffectsAreFoundWithinTheirErrors) {
  const Case one = two_effects(7, -0.02, 0.05);
  const RecordingAdjustment fit = adjust(one.problem, one.border);
  EXPECT_TRUE(fit.converged);
  const Eigen::Vector2d sd = fit.coefficient_covariance.diagonal().cwiseSqrt();
  EXPECT_LT(sd[0], 0.002);
  EXPECT_NEAR(fit.coefficients[0], -0.02, 4.0 * sd[0]);
  EXPECT_NEAR(fit.coefficients[1], 0.05, 4.0 * sd[1]);
  // Without them the misfit shows.
  EXPECT_LT(adjust(one.problem).p_value, 1e-6);
  EXPECT_GT(fit.p_value, 1e-4);
}

TEST(RecordingEffectParameters, ViewPatternsActLikeTheSensorsOffsets) {
  SimulatedRecording simulated = simulate_recording({true, true, true, 1}, 3);
  constexpr double kOffset = 0.07;  // rad, bearing reads too much
  for (Sighting& sighting : simulated.recording.sightings) {
    if (!sighting.standing()) sighting.bearing = wrap_angle(sighting.bearing + kOffset);
  }
  EffectPattern bearing;
  bearing.name = "bearing";
  bearing.sightings = {std::vector<effects::ViewPattern>(simulated.recording.sightings.size())};
  for (effects::ViewPattern& view : bearing.sightings[0]) view.bearing = 1.0;
  const RecordingProblem problem = make_problem({simulated.recording}, simulated.model);
  const RecordingAdjustment fit = adjust(problem, {bearing});
  const double sd = std::sqrt(fit.coefficient_covariance(0, 0));
  EXPECT_LT(sd, 0.005);
  EXPECT_NEAR(fit.coefficients[0], kOffset, 4.0 * sd);
}

TEST(RecordingEffectParameters, AnUndeterminedCoefficientIsNamed) {
  // Without a survey a constant compass offset only turns the map.
  SimulatedRecording simulated = simulate_recording({true, false, false, 1}, 2);
  const std::vector<DrivenRecording> recordings = {simulated.recording};
  const RecordingProblem problem = make_problem(recordings, simulated.model);
  const EffectParameters border = {
      plain_effect(Channel::turn, recordings, simulated.model.robot),
      plain_effect(Channel::compass, recordings, simulated.model.robot)};
  try {
    static_cast<void>(adjust(problem, border));
    FAIL() << "should be refused";
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("compass"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("turn,"), std::string::npos) << error.what();
  }
}

TEST(SlowRecordingEffectParameters, StandardErrorsAreTheScatterOfSimulations) {
  // sd of a sample's sd over n = 500 runs: 1/sqrt(2 n) = 3.2 %; 10 % is three of them.
  constexpr int kRuns = 500;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  Eigen::Vector2d variances = Eigen::Vector2d::Zero();
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Case one = two_effects(seed, 0.0, 0.0);
    const RecordingAdjustment fit = adjust(one.problem, one.border);
    sum += fit.coefficients;
    squares += fit.coefficients.cwiseAbs2();
    variances += fit.coefficient_covariance.diagonal();
  }
  for (int k = 0; k < 2; ++k) {
    const double mean = sum[k] / kRuns;
    const double scatter = std::sqrt(squares[k] / kRuns - mean * mean);
    const double stated = std::sqrt(variances[k] / kRuns);
    EXPECT_NEAR(scatter / stated, 1.0, 0.1) << k;
    EXPECT_LT(std::abs(mean), 4.0 * stated / std::sqrt(kRuns)) << k;
  }
}

/// Each landmark's own covariance, and products with the joint one, are those of the dense joint
/// covariance.
TEST(RecordingEffectParameters, LandmarkCovariancesAreBlocksOfTheJointOne) {
  const Case one = two_effects(3, -0.02, 0.05);
  RecordingSystem system(one.problem, one.border);
  const RecordingDescent fit =
      descend(system, start_of(one.problem, {}).state, Eigen::Vector2d::Zero());
  system.factorise();
  std::vector<int> nodes;
  for (int k = 0; k < one.problem.landmark_count(); ++k) nodes.push_back(k);
  const Eigen::Index rows = 2 * std::ssize(nodes);
  const Eigen::MatrixXd joint = system.joint_covariance(nodes).topLeftCorner(rows, rows);
  const std::vector<Matrix2> own = system.landmark_covariances();
  for (Eigen::Index k = 0; k < rows; k += 2) {
    const Matrix2 block = joint.block<2, 2>(k, k);
    EXPECT_LT((own[static_cast<std::size_t>(k / 2)] - block).norm(), 1e-9 * joint.norm());
  }
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(rows, 3);
  EXPECT_LT((system.landmark_covariance_times(b) - joint * b).norm(), 1e-8 * (joint * b).norm());
}

/// What is left of the landmarks' uncertainty when shifts and turns of the whole do not count, by
/// dense projection.
TEST(RecordingEffectParameters, StandardErrorsOfTheShapeAreThoseOfInnerConstraints) {
  const SimulatedRecording simulated = simulate_recording({}, 4);
  const RecordingProblem problem = make_problem({simulated.recording}, simulated.model);
  const RecordingAdjustment fit = adjust(problem);
  std::vector<int> nodes;
  for (int k = 0; k < problem.landmark_count(); ++k) nodes.push_back(k);
  const Eigen::MatrixXd joint = joint_covariance(problem, {}, fit, nodes);
  Eigen::MatrixXd G(joint.rows(), 3);
  for (Eigen::Index k = 0; k < joint.rows(); k += 2) {
    const Vector2& at = fit.state.landmarks[static_cast<std::size_t>(k / 2)];
    G.row(k) << 1.0, 0.0, -at.y();
    G.row(k + 1) << 0.0, 1.0, at.x();
  }
  const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(joint.rows(), joint.rows()) -
                            G * (G.transpose() * G).inverse() * G.transpose();
  const Eigen::MatrixXd inner = S * joint * S.transpose();
  for (Eigen::Index k = 0; k < joint.rows(); k += 2) {
    EXPECT_NEAR(fit.landmark_sds[static_cast<std::size_t>(k / 2)],
                std::sqrt(inner(k, k) + inner(k + 1, k + 1)), 1e-9);
  }
}

}  // namespace
}  // namespace trussmap::recording_border_test
