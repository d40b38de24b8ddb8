// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise that lasts: its states against its kernel, and the adjustment with states against
// generalised least squares under the whole dense covariance.
#include "estimation/noise_states.hpp"

#include "driven.hpp"
#include "effects/channel_physics.hpp"
#include "estimation/kernel_covariance.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/recording_system.hpp"
#include "fit/fit_projection.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::noise_states_test {
using namespace effects;
using namespace estimation;
namespace {

using testing::process_covariance;

const Robot kRobot{0.34};

// ----------------------------------------
// States against kernels.

/// Rows of unequal durations: bows ahead and back, rests, some readings missing. The robot stands
/// on landmarks at the ends of rows and within them.
DrivenRecording uneven_recording(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  DrivenRecording recording;
  recording.name = "uneven";
  double t = 3.0;
  double heading = 0.0;
  for (int row = 0; row < 30; ++row) {
    t += 0.05 + 0.5 * uniform(random);
    const double kind = uniform(random);
    const double path = kind < 0.15 ? 0.0 : (kind < 0.3 ? -1.0 : 1.0) * (0.05 + uniform(random));
    const double turn = path == 0.0 ? 0.0 : 0.6 * (uniform(random) - 0.5);
    recording.drive.t.push_back(t);
    testing::add_travels(recording.drive, path - 0.5 * kRobot.wheelbase * turn,
                         path + 0.5 * kRobot.wheelbase * turn, kRobot.wheelbase);
    heading += turn;
    const bool read = row % 3 != 1 && row / 6 != 2;  // a whole segment without
    recording.drive.heading.push_back(read ? wrap_angle(heading + 0.1 * uniform(random)) : kAbsent);
  }
  const std::vector<double>& ends = recording.drive.t;
  const auto stand = [&recording](double at, const char* name) {
    Sighting one;
    one.t = at;
    one.landmark = name;
    recording.sightings.push_back(one);
  };
  stand(ends[1], "a");
  stand(0.3 * ends[5] + 0.7 * ends[6], "b");
  stand(ends[11], "c");
  stand(ends[18], "a");
  stand(0.6 * ends[21] + 0.4 * ends[22], "b");
  stand(ends[28], "c");
  return recording;
}

/// All values of the problem, one below the other: what the states and what is within each
/// measurement give them, for sd = 1.
Eigen::MatrixXd covariance_by_states(const RecordingProblem& problem, const LaidProcess& laid) {
  const auto count = static_cast<Eigen::Index>(laid.states.size());
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(count, count);  // z = steps times white noise
  for (Eigen::Index k = 0; k < count; ++k) {
    const NoiseState& state = laid.states[static_cast<std::size_t>(k)];
    if (state.previous >= 0) steps.row(k) = state.keep * steps.row(state.previous);
    steps(k, k) += state.sd;
  }
  Eigen::Index rows = 0;
  for (const Measurement& one : problem.measurements) rows += one.rows;
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(rows, count);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    for (const NoiseTerm& term : laid.terms[k]) {
      Z.block(at, term.state, one.rows, 1) += term.by.head(one.rows);
    }
    result.block(at, at, one.rows, one.rows) = laid.within[k].topLeftCorner(one.rows, one.rows);
    at += one.rows;
  }
  const Eigen::MatrixXd spread = Z * steps;
  return result + spread * spread.transpose();
}

/// Largest difference of two covariances, in their own standard deviations.
double largest_difference(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  double most = 0.0;
  for (Eigen::Index r = 0; r < expected.rows(); ++r) {
    for (Eigen::Index c = 0; c < expected.cols(); ++c) {
      const double size = std::sqrt(std::max(expected(r, r) * expected(c, c), 1e-16));
      most = std::max(most, std::abs(found(r, c) - expected(r, c)) / size);
    }
  }
  return most;
}

struct Lasting {
  const char* name;
  Channel channel;
  ProcessKind process;
  double length = 0.0;
};

void PrintTo(const Lasting& lasting, std::ostream* stream) {
  *stream << lasting.name;
}

class NoiseStates : public ::testing::TestWithParam<Lasting> {};

/// Two sessions, seeds 1 and 2; of the first a segment in the middle is left out, and the process
/// goes on across it.
///
/// Tolerance: slopes by differences are good to 1e-11 (h^4/30 of the fifth derivative, turns of
/// 0.3 rad over 10 m), integrals to 1e-13, a row's conditional variance to 1e-11 (cancellation of
/// rounding 2e-16 over x^3); sums have some 20 terms.
TEST_P(NoiseStates, HaveTheCovarianceOfTheKernel) {
  const std::vector<DrivenRecording> recordings = {uneven_recording(1), uneven_recording(2)};
  Model model;
  model.robot = kRobot;
  ProblemOptions options;
  const std::vector<Sighting>& seen = recordings[0].sightings;
  options.left_out = {{{seen[2].t, seen[3].t}}, {}};
  const RecordingProblem problem = make_problem(recordings, model, options);
  const auto segments =
      std::count_if(problem.measurements.begin(), problem.measurements.end(),
                    [](const Measurement& one) { return one.kind == &kinds::segment; });
  ASSERT_EQ(segments, 9);
  const Lasting& lasting = GetParam();
  const ProcessLayer layer(problem, recordings, kRobot);
  const LaidProcess laid = layer.lay(lasting.channel, lasting.process, lasting.length);
  const Eigen::MatrixXd found = covariance_by_states(problem, laid);
  const Eigen::MatrixXd expected = process_covariance(
      problem, recordings, model, {lasting.channel, lasting.process, 1.0, lasting.length});
  ASSERT_GT(expected.diagonal().maxCoeff(), 1e-4);
  EXPECT_LT(largest_difference(found, expected), 1e-9);
}

std::vector<Lasting> all_lasting() {
  return {
      {"TurnForgottenInTime", Channel::turn, ProcessKind::correlated_in_t, 1.3},
      {"TurnForgottenOnTheWay", Channel::turn, ProcessKind::correlated_in_distance, 0.8},
      {"TurnWalksInTime", Channel::turn, ProcessKind::walk_in_t},
      {"TurnWalksOnTheWay", Channel::turn, ProcessKind::walk_in_distance},
      {"TravelForgottenInTime", Channel::travel, ProcessKind::correlated_in_t, 1.3},
      {"TravelForgottenOnTheWay", Channel::travel, ProcessKind::correlated_in_distance, 0.8},
      {"TravelWalksInTime", Channel::travel, ProcessKind::walk_in_t},
      {"TravelWalksOnTheWay", Channel::travel, ProcessKind::walk_in_distance},
      {"DifferenceForgottenInTime", Channel::difference, ProcessKind::correlated_in_t, 1.3},
      {"DifferenceForgottenOnTheWay", Channel::difference, ProcessKind::correlated_in_distance,
       0.8},
      {"DifferenceWalksInTime", Channel::difference, ProcessKind::walk_in_t},
      {"DifferenceWalksOnTheWay", Channel::difference, ProcessKind::walk_in_distance},
      {"DriftForgottenInTime", Channel::drift, ProcessKind::correlated_in_t, 1.3},
      {"DriftForgottenOnTheWay", Channel::drift, ProcessKind::correlated_in_distance, 0.8},
      {"DriftWalksInTime", Channel::drift, ProcessKind::walk_in_t},
      {"DriftWalksOnTheWay", Channel::drift, ProcessKind::walk_in_distance},
      {"CompassForgottenInTime", Channel::compass, ProcessKind::correlated_in_t, 1.3},
      {"CompassForgottenOnTheWay", Channel::compass, ProcessKind::correlated_in_distance, 0.8},
      {"CompassWalksInTime", Channel::compass, ProcessKind::walk_in_t},
      {"CompassWalksOnTheWay", Channel::compass, ProcessKind::walk_in_distance},
      // So fast, so slowly, and about where formulas change into series.
      {"AtOnceForgotten", Channel::turn, ProcessKind::correlated_in_t, 0.1},
      {"SlowlyForgotten", Channel::turn, ProcessKind::correlated_in_t, 40.0},
      {"HardlyForgotten", Channel::turn, ProcessKind::correlated_in_t, 1500.0},
      {"NeverForgotten", Channel::difference, ProcessKind::correlated_in_distance, 1e5},
      {"CompassHardlyForgotten", Channel::compass, ProcessKind::correlated_in_t, 3000.0},
      {"TravelOfALeg", Channel::travel, ProcessKind::per_leg},
      {"CompassOfALeg", Channel::compass, ProcessKind::per_leg},
      {"LeftOfASession", Channel::left, ProcessKind::per_session},
      {"CompassOfASession", Channel::compass, ProcessKind::per_session},
      {"CompassOfAReading", Channel::compass, ProcessKind::white},
  };
}

INSTANTIATE_TEST_SUITE_P(EveryProcess, NoiseStates, ::testing::ValuesIn(all_lasting()),
                         [](const auto& one) { return std::string(one.param.name); });

/// What is within the segments tells a slow process from one that never changes: its share is as
/// small as x, and must not drown in rounding. One segment of 20 rows of 0.1 s; what is within it
/// grows as 1/length for long ones, up to terms of x = 2 s/length.
TEST(NoiseStatesWithin, OfASlowProcessGoesAsOneOverItsLength) {
  DrivenRecording recording;
  for (int row = 0; row < 21; ++row) {
    recording.drive.t.push_back(0.1 * (row + 1));
    testing::add_travels(recording.drive, 0.05, 0.05);
  }
  Sighting seen;
  seen.t = 0.1;
  seen.landmark = "a";
  recording.sightings = {seen, seen};
  recording.sightings[1].t = 2.1;
  recording.sightings[1].landmark = "b";
  const RecordingProblem problem = make_problem({recording}, {});
  const std::vector<DrivenRecording> recordings = {recording};
  const ProcessLayer layer(problem, recordings, {});
  const auto within = [&](double length) {
    return layer.lay(Channel::travel, ProcessKind::correlated_in_t, length).within.front()(0, 0);
  };
  // Of a bridge of 1 m and 2 s, free to second order in x: 2 x/12 with x = 2/length.
  for (const double length : {50.0, 400.0, 900.0, 1100.0, 5000.0, 3e4, 1e6}) {
    const double x = 2.0 / length;
    EXPECT_NEAR(within(length) / (x / 6.0), 1.0, x * x + 1e-8) << length;
  }
}

/// The robot turns on the spot from one sighting to the next: no way at all between poses. The
/// variance of a step is never less than 1e-8.
TEST(NoiseStatesWithin, AnyWayAProcessMayStandStill) {
  DrivenRecording recording;
  for (int row = 0; row < 40; ++row) {
    const bool spins = row / 10 % 2 == 1;
    recording.drive.t.push_back(0.1 * (row + 1));
    testing::add_travels(recording.drive, spins ? -0.03 : 0.05, spins ? 0.03 : 0.05,
                         kRobot.wheelbase);
  }
  for (const int row : {0, 9, 19, 29, 39}) {
    Sighting seen;
    seen.t = recording.drive.t[idx(row)];
    seen.landmark = std::string(1, static_cast<char>('a' + row / 10));
    recording.sightings.push_back(seen);
  }
  Model model;
  model.robot = kRobot;
  const std::vector<DrivenRecording> recordings = {recording};
  const RecordingProblem problem = make_problem(recordings, model);
  const ProcessLayer layer(problem, recordings, kRobot);
  for (const ProcessKind process :
       {ProcessKind::correlated_in_distance, ProcessKind::walk_in_distance}) {
    const LaidProcess laid = layer.lay(Channel::turn, process, 0.7);
    const Eigen::MatrixXd expected =
        process_covariance(problem, recordings, model, {Channel::turn, process, 1.0, 0.7});
    // Each of 4 steps adds up to 1e-8 to a unit process of variance 0.05 or more.
    EXPECT_LT(largest_difference(covariance_by_states(problem, laid), expected), 1e-6);
  }
}

/// Session, t and landmark of views.
RecordingProblem views_only(const std::vector<std::pair<double, const char*>>& seen,
                            std::vector<DrivenRecording>& recordings, double resting_from = 100.0,
                            double resting_to = 100.0) {
  DrivenRecording recording;
  for (int row = 0; row < 300; ++row) {
    const double t = 0.1 * (row + 1);
    const bool rests = t > resting_from + 0.05 && t < resting_to + 0.05;
    recording.drive.t.push_back(t);
    testing::add_travels(recording.drive, rests ? 0.0 : 0.02, rests ? 0.0 : 0.02, kRobot.wheelbase);
  }
  for (const auto& [t, name] : seen) {
    Sighting one;
    one.t = t;
    one.landmark = name;
    one.range = 4.0;
    one.bearing = 0.3;
    recording.sightings.push_back(one);
  }
  recordings = {recording};
  return make_problem(recordings, {});
}

/// States of the measurements of a kind, in order.
std::vector<int> states_of(const RecordingProblem& problem, const LaidProcess& laid,
                           const MeasurementKind* kind) {
  std::vector<int> states;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    if (problem.measurements[k].kind != kind) continue;
    for (const NoiseTerm& term : laid.terms[k]) states.push_back(term.state);
  }
  return states;
}

TEST(NoiseStatesOfViews, LastAsLongAsALandmarkIsNeverUnseenForLong) {
  std::vector<DrivenRecording> recordings;
  // b is unseen for 5.5 s, a never for more than 4.
  const RecordingProblem problem = views_only(
      {{1.0, "a"}, {1.0, "b"}, {5.0, "a"}, {6.5, "b"}, {7.0, "b"}, {9.0, "a"}}, recordings);
  const ProcessLayer layer(problem, recordings, {});
  const auto states = [&](Channel channel, ProcessKind process) {
    return states_of(problem, layer.lay(channel, process, 2.0), &kinds::view);
  };
  EXPECT_EQ(states(Channel::range, ProcessKind::per_pass), (std::vector<int>{0, 1, 0, 2, 2, 0}));
  EXPECT_EQ(states(Channel::lever, ProcessKind::white), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  // A white reading is a larger variance, and no state.
  const LaidProcess white = layer.lay(Channel::bearing, ProcessKind::white, 0.0);
  EXPECT_TRUE(white.states.empty());
  EXPECT_EQ(states(Channel::lever, ProcessKind::per_session), (std::vector<int>{0, 0, 0, 0, 0, 0}));
  // One state per instant.
  EXPECT_EQ(states(Channel::range, ProcessKind::correlated_in_t),
            (std::vector<int>{0, 0, 1, 2, 3, 4}));
  const LaidProcess laid = layer.lay(Channel::range, ProcessKind::correlated_in_t, 2.0);
  ASSERT_EQ(laid.states.size(), 5U);
  EXPECT_EQ(laid.states[1].previous, 0);
  EXPECT_NEAR(laid.states[1].keep, std::exp(-2.0), 1e-15);
  EXPECT_NEAR(laid.states[1].sd, std::sqrt(1.0 - std::exp(-4.0)), 1e-15);
}

/// Where the robot stands on no landmark, legs end with its rests, also within a segment.
TEST(NoiseStatesOfLegs, EndWithRests) {
  std::vector<DrivenRecording> recordings;
  const RecordingProblem problem =
      views_only({{2.0, "a"}, {8.0, "a"}, {16.0, "a"}, {20.0, "a"}}, recordings, 10.0, 11.0);
  const ProcessLayer layer(problem, recordings, {});
  EXPECT_EQ(states_of(problem, layer.lay(Channel::range, ProcessKind::per_leg, 0.0), &kinds::view),
            (std::vector<int>{0, 0, 1, 1}));
  const LaidProcess travel = layer.lay(Channel::travel, ProcessKind::per_leg, 0.0);
  // Segments: 2 to 8 s, 1.2 m; 8 to 10 s, 0.4 m, with 11 to 16 s, 1.0 m; 16 to 20 s, 0.8 m.
  std::map<int, std::vector<double>> way;
  std::size_t segment = 0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    if (problem.measurements[k].kind != &kinds::segment) continue;
    for (const NoiseTerm& term : travel.terms[k]) {
      way[term.state].resize(3, 0.0);
      way[term.state][segment] += term.by[0];
    }
    ++segment;
  }
  ASSERT_EQ(way.size(), 2U);
  const std::vector<double> first = {1.2, 0.4, 0.0};
  const std::vector<double> second = {0.0, 1.0, 0.8};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(way[0][k], first[k], 1e-12) << k;
    EXPECT_NEAR(way[1][k], second[k], 1e-12) << k;
  }
}

/// What is seen at the instant of a stop belongs to the leg that ends there.
TEST(NoiseStatesOfLegs, EndWhereTheRobotStandsOnALandmark) {
  std::vector<DrivenRecording> recordings;
  views_only({{2.0, "a"}, {5.0, "a"}, {5.0, "b"}, {8.0, "a"}}, recordings);
  recordings[0].sightings[2].range = recordings[0].sightings[2].bearing = kAbsent;
  const RecordingProblem problem = make_problem(recordings, {});
  const ProcessLayer layer(problem, recordings, {});
  EXPECT_EQ(
      states_of(problem, layer.lay(Channel::bearing, ProcessKind::per_leg, 0.0), &kinds::view),
      (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(
      states_of(problem, layer.lay(Channel::travel, ProcessKind::per_leg, 0.0), &kinds::segment),
      (std::vector<int>{0, 1}));
}

// ----------------------------------------
// The adjustment against dense generalised least squares.

/// One tour each of a 3x3 mesh, with rows of 0.5 s; a range sensor that meets landmarks again.
std::vector<DrivenRecording> tours(std::uint64_t seed, bool compass, bool survey) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::vector<DrivenRecording> recordings;
  for (const std::uint64_t session : {seed, seed + 1}) {
    std::mt19937_64 random = random_stream(session, Stream::walk);
    const Tours walk = make_tours(mesh, WalkKind::euler, 1, random);
    WheeledRobot robot;
    robot.compass = compass;
    robot.range_sensor = true;
    robot.recognition = 0.4;
    DrivingStyle style;
    style.row_duration = 0.5;
    DrivenRecording recording =
        testing::driven(simulate_drive(mesh, walk.walk, style, robot, session).recording);
    recording.name = "tour " + std::to_string(session);
    if (!survey) recording.survey.clear();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

/// Of every kind; as large as the white noise or larger.
Model lasting_model(bool compass) {
  Model model;
  model.noise.processes = {
      {Channel::travel, ProcessKind::per_leg, 0.01},
      {Channel::turn, ProcessKind::per_session, 0.02},
      {Channel::left, ProcessKind::white, 0.03},
      {Channel::drift, ProcessKind::correlated_in_t, 0.004, 5.0},
      {Channel::difference, ProcessKind::correlated_in_distance, 0.01, 2.0},
      {Channel::turn, ProcessKind::walk_in_distance, 0.003},
      {Channel::travel, ProcessKind::walk_in_t, 0.001},
      {Channel::range, ProcessKind::per_pass, 0.05},
      {Channel::range, ProcessKind::white, 0.03},
      {Channel::bearing, ProcessKind::correlated_in_t, 0.02, 20.0},
      {Channel::bearing, ProcessKind::per_leg, 0.01},
  };
  if (compass) {
    model.noise.processes.push_back({Channel::compass, ProcessKind::correlated_in_t, 0.03, 3.0});
    model.noise.processes.push_back({Channel::compass, ProcessKind::per_session, 0.02});
  }
  return model;
}

Model without_processes(Model model) {
  model.noise.processes.clear();
  return model;
}

/// Landmarks, poses and their covariance by Gauss-Newton steps under the dense covariance. The
/// errors and their derivatives are those of the problem without processes.
struct Dense {
  RecordingState state;
  double chi2 = 0.0;
  int unknowns = 0;
  Eigen::MatrixXd inverse;        ///< of the normal matrix
  double log_determinants = 0.0;  ///< log|Sigma| + log|X' Sigma^-1 X|
};

Dense dense_adjustment(const RecordingProblem& plain, const Eigen::MatrixXd& lasting) {
  const EffectParameters no_effects;
  RecordingSystem system(plain, no_effects);
  Dense result;
  result.unknowns = system.unknowns();
  result.state = start_of(plain, no_effects).state;
  const Eigen::Index n = system.normal_equations().unknowns();
  Eigen::MatrixXd Sigma = lasting;
  for (std::size_t k = 0; k < plain.measurements.size(); ++k) {
    const Measurement& one = plain.measurements[k];
    const Eigen::MatrixXd colour = one.whitener.topLeftCorner(one.rows, one.rows).inverse();
    Sigma.block(system.first_row(k), system.first_row(k), one.rows, one.rows) +=
        colour * colour.transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(Sigma);
  Eigen::MatrixXd X(system.rows(), n);
  Eigen::VectorXd e(system.rows());
  for (int round = 0; round < 30; ++round) {
    system.linearise(result.state, Eigen::VectorXd());
    for (std::size_t k = 0; k < plain.measurements.size(); ++k) {
      const Measurement& one = plain.measurements[k];
      const Eigen::MatrixXd colour = one.whitener.topLeftCorner(one.rows, one.rows).inverse();
      const int at = system.first_row(k);
      X.middleRows(at, one.rows) = colour * system.transposed_rows(k).transpose();
      e.segment(at, one.rows) = colour * system.residuals().segment(at, one.rows);
    }
    Eigen::MatrixXd normal = X.transpose() * factor.solve(X);
    for (Eigen::Index k = 0; k < n; ++k) {
      if (normal(k, k) == 0.0) normal(k, k) = 1.0;  // held
    }
    const Eigen::LLT<Eigen::MatrixXd> solver(normal);
    const Eigen::VectorXd step = -solver.solve(X.transpose() * factor.solve(e));
    result.chi2 = e.dot(factor.solve(e));
    result.inverse = solver.solve(Eigen::MatrixXd::Identity(n, n));
    const auto log_of = [](const Eigen::LLT<Eigen::MatrixXd>& A) {
      return 2.0 * Eigen::MatrixXd(A.matrixL()).diagonal().array().log().sum();
    };
    result.log_determinants = log_of(factor) + log_of(solver);
    if (step.norm() < 1e-12) break;
    result.state = system.moved(result.state, {step, Eigen::VectorXd(), 0.0});
  }
  return result;
}

struct Setting {
  const char* name;
  std::uint64_t seed;
  bool compass;
  bool survey;
};

void PrintTo(const Setting& setting, std::ostream* stream) {
  *stream << setting.name;
}

class AdjustmentWithLastingNoise : public ::testing::TestWithParam<Setting> {};

/// Henderson's mixed model equations: eliminating the states is generalised least squares.
///
/// Tolerances: slopes and kernels are good to 1e-10. The adjustment takes one more step where it
/// promises less than 1e-12 of chi^2 (100 or so), which is less than 1e-5 standard deviations of
/// 1e-2 m: 1e-7 m before that step. Condition numbers of some 1e9 leave 1e-7 of covariances. The
/// logarithms of some 1000 pivots add up to 1e3, good to 1e-10 each.
TEST_P(AdjustmentWithLastingNoise, IsGeneralisedLeastSquares) {
  const auto& [name, seed, compass, survey] = GetParam();
  const std::vector<DrivenRecording> recordings = tours(seed, compass, survey);
  const Model model = lasting_model(compass);
  const RecordingProblem plain = make_problem(recordings, without_processes(model));
  const RecordingProblem problem = make_problem(recordings, model);
  Eigen::Index rows = 0;
  for (const Measurement& one : plain.measurements) rows += one.rows;
  Eigen::MatrixXd lasting = Eigen::MatrixXd::Zero(rows, rows);
  for (const NoiseProcess& one : model.noise.processes) {
    const Eigen::MatrixXd own = process_covariance(plain, recordings, model, one);
    EXPECT_GT(own.trace(), 0.0) << name_of(one.channel);
    lasting += one.sd * one.sd * own;
  }
  const Dense dense = dense_adjustment(plain, lasting);
  const RecordingAdjustment fit = adjust(problem);
  EXPECT_TRUE(fit.converged);
  for (std::size_t k = 0; k < dense.state.landmarks.size(); ++k) {
    EXPECT_LT((fit.state.landmarks[k] - dense.state.landmarks[k]).norm(), 1e-7) << k;
  }
  for (std::size_t k = 0; k < dense.state.poses.size(); ++k) {
    const Pose& pose = fit.state.poses[k];
    EXPECT_LT((pose.position() - dense.state.poses[k].position()).norm(), 1e-7) << k;
    EXPECT_NEAR(wrap_angle(pose.heading - dense.state.poses[k].heading), 0.0, 1e-7) << k;
  }
  EXPECT_NEAR(fit.chi2, dense.chi2, 1e-6 * dense.chi2);
  EXPECT_EQ(fit.dof, static_cast<int>(rows) - dense.unknowns);

  const EffectParameters no_effects;
  RecordingSystem system(problem, no_effects);
  const RecordingSystem base(plain, no_effects);
  system.linearise(fit.state, Eigen::VectorXd());
  system.factorise();
  for (int k = 0; k < problem.landmark_count(); ++k) {
    if (base.normal_equations().size(k) == 0) {
      EXPECT_EQ(fit.landmark_covariances[idx(k)], Matrix2::Zero());
      continue;
    }
    const int at = base.normal_equations().offset(k);
    const Matrix2 expected = dense.inverse.block<2, 2>(at, at);
    EXPECT_LT((fit.landmark_covariances[idx(k)] - expected).norm(), 1e-6 * expected.norm()) << k;
  }
  const std::vector<Matrix3> poses = system.pose_covariances();
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const int at = base.normal_equations().offset(plain.pose_node(static_cast<int>(k)));
    const Matrix3 expected = dense.inverse.block<3, 3>(at, at);
    EXPECT_LT((poses[k] - expected).norm(), 1e-6 * expected.norm()) << k;
  }
  double sum = system.log_determinant();
  for (const Measurement& one : problem.measurements) {
    sum -= 2.0 * one.whitener.diagonal().head(one.rows).array().log().sum();
  }
  for (const NoiseState& state : problem.noise_states) sum += 2.0 * std::log(state.sd);
  EXPECT_NEAR(sum, dense.log_determinants, 1e-9 * std::abs(dense.log_determinants));
}

INSTANTIATE_TEST_SUITE_P(EverySetting, AdjustmentWithLastingNoise,
                         ::testing::Values(Setting{"Surveyed", 7, true, true},
                                           Setting{"LandmarkHeld", 17, true, false},
                                           Setting{"LandmarkAndHeadingHeld", 27, false, false}),
                         [](const auto& one) { return std::string(one.param.name); });

/// What the robot records where it has a constant g of compass, range, bearing or turn.
void disturb(DrivenRecording& recording, Channel channel, double g) {
  MotionRows& drive = recording.drive;
  if (channel == Channel::compass) {
    for (double& reading : drive.heading) reading = wrap_angle(reading + g);
  }
  for (std::size_t row = 0; channel == Channel::turn && row < drive.rows(); ++row) {
    const double less =
        0.5 * (drive.pair.right[row] - drive.pair.left[row]) * (1.0 - 1.0 / (1.0 + g));
    drive.pair.left[row] += less;
    drive.pair.right[row] -= less;
  }
  testing::retake(drive);
  for (Sighting& seen : recording.sightings) {
    if (seen.standing()) continue;
    if (channel == Channel::range) seen.range += g;
    if (channel == Channel::bearing) seen.bearing = wrap_angle(seen.bearing + g);
  }
}

/// In one session a process that never changes is a constant effect with a prior: the state times
/// its sd is the coefficient, sign and all. Compass, range and bearing are linear in it; of a turn
/// g the states leave out the second order, g^2/2 of the swing of a leg that turns by some 1 rad,
/// and with g = 0.004 a share of 1e-2 of the coefficient.
TEST(LastingNoise, OfASessionIsAConstantEffectWithAPrior) {
  constexpr double kSd = 0.05;
  const std::vector<DrivenRecording> undisturbed = {tours(7, true, true).front()};
  const Model model = without_processes(lasting_model(true));
  for (const auto& [channel, g, share] :
       {std::tuple(Channel::compass, 0.06, 1e-6), std::tuple(Channel::range, 0.08, 1e-6),
        std::tuple(Channel::bearing, -0.05, 1e-6), std::tuple(Channel::turn, 0.004, 1e-2)}) {
    std::vector<DrivenRecording> recordings = undisturbed;
    disturb(recordings[0], channel, g);
    EffectPattern effect;
    if (acts_on(channel) == ActsOn::views) {
      effect.sightings = {std::vector<ViewPattern>(recordings[0].sightings.size(),
                                                   view_pattern(channel, 1.0, 0.0, 0.0))};
    } else {
      effect = plain_effect(channel, recordings, model.robot);
    }
    effect.prior_sd = kSd;
    const RecordingAdjustment known = adjust(make_problem(recordings, model), {effect});
    Model lasting = model;
    lasting.noise.processes = {{channel, ProcessKind::per_session, kSd}};
    const RecordingAdjustment found = adjust(make_problem(recordings, lasting));
    ASSERT_EQ(found.state.noise.size(), 1);
    const double sd = std::sqrt(known.coefficient_covariance(0, 0));
    EXPECT_NEAR(known.coefficients[0], g, 5.0 * sd) << name_of(channel);
    EXPECT_GT(known.coefficients[0] / g, 0.2) << name_of(channel);
    EXPECT_NEAR(kSd * found.state.noise[0], known.coefficients[0], share * std::abs(g))
        << name_of(channel);
    EXPECT_EQ(found.dof, known.dof);
    if (channel != Channel::turn) {
      EXPECT_NEAR(found.chi2, known.chi2, 1e-6 * known.chi2);
    }
  }
}

/// A process of sd 1e-9 adds at most 1e-9 of what one unit does, some 10 m or 10 rad, to errors of
/// 1e-5 and more: shares of 1e-6 in variances.
TEST(LastingNoise, OfNoSizeChangesNothing) {
  const std::vector<DrivenRecording> recordings = tours(7, true, true);
  Model model = lasting_model(true);
  for (NoiseProcess& one : model.noise.processes) one.sd = 1e-9;
  const RecordingAdjustment with = adjust(make_problem(recordings, model));
  const RecordingAdjustment without = adjust(make_problem(recordings, without_processes(model)));
  EXPECT_NEAR(with.chi2, without.chi2, 1e-6 * without.chi2);
  EXPECT_EQ(with.dof, without.dof);
  for (std::size_t k = 0; k < with.state.landmarks.size(); ++k) {
    EXPECT_LT((with.state.landmarks[k] - without.state.landmarks[k]).norm(), 1e-8);
    EXPECT_LT((with.landmark_covariances[k] - without.landmark_covariances[k]).norm(),
              1e-6 * without.landmark_covariances[k].norm());
  }
  EXPECT_LT(with.state.noise.cwiseAbs().maxCoeff(), 1e-3);
}

TEST(LastingNoise, WhereThereIsNoneLeavesAProblemAsItIs) {
  const std::vector<DrivenRecording> recordings = tours(7, true, true);
  const Model model = without_processes(lasting_model(true));
  const RecordingProblem problem = make_problem(recordings, model);
  EXPECT_TRUE(problem.noise_states.empty());
  EXPECT_TRUE(problem.noise_terms.empty());
  EXPECT_TRUE(problem.within.empty());
  const EffectParameters no_effects;
  RecordingSystem system(problem, no_effects);
  const RecordingState state = start_of(problem, no_effects).state;
  system.linearise(state, Eigen::VectorXd());
  int rows = 0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind == &kinds::segment) {
      const MotionRows& drive = recordings[idx(one.session)].drive;
      const Matrix4 C =
          segment_covariance(drive, problem.segments[one.source], model.robot, model.noise);
      EXPECT_EQ(one.whitener, whitener_of(C, one.rows));
    }
    const Vector4 error = one.whitener * measurement_rows(problem, one, state, one.value, {}).error;
    EXPECT_EQ(system.residuals().segment(system.first_row(k), one.rows), error.head(one.rows));
    rows += one.rows;
  }
  EXPECT_EQ(system.rows(), rows);
  EXPECT_EQ(system.moved(state, system.solve_step()).noise.size(), 0);
}

// ----------------------------------------
// The system's own algebra.

struct Linearised {
  std::vector<DrivenRecording> recordings;
  RecordingProblem problem;
  EffectParameters border;
  RecordingState state;
  Eigen::VectorXd coefficients;
};

/// Somewhere off the minimum, seed 5, with states that are not 0.
Linearised linearised(std::uint64_t seed, bool compass, bool survey, const Model& model) {
  Linearised one;
  one.recordings = tours(seed, compass, survey);
  one.problem = make_problem(one.recordings, model);
  one.border = {plain_effect(Channel::wheels, one.recordings, model.robot)};
  one.state = start_of(one.problem, {}).state;
  one.coefficients = Eigen::VectorXd::Constant(1, 0.002);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  one.state.noise.resize(static_cast<Eigen::Index>(one.problem.noise_states.size()));
  for (double& value : one.state.noise) value = normal(random);
  return one;
}

TEST(SystemWithStates, ProductsAreThoseOfOneMatrix) {
  for (const bool held : {false, true}) {
    const Linearised one = linearised(7, !held, !held, lasting_model(!held));
    RecordingSystem system(one.problem, one.border);
    EXPECT_EQ(system.gauge().hold_landmark, held);
    EXPECT_EQ(system.gauge().hold_heading, held);
    std::vector<double> weights(one.problem.measurements.size(), 1.0);
    for (std::size_t k = 0; k < weights.size(); k += 3) {
      weights[k] = one.problem.measurements[k].kind == &kinds::view ? 0.0 : 0.5;
    }
    system.set_weights(weights);
    const double chi2 = system.linearise(one.state, one.coefficients);
    EXPECT_NEAR(chi2, system.residuals().squaredNorm(), 1e-12 * chi2);
    const Eigen::Index n = system.normal_equations().unknowns();
    const Eigen::MatrixXd J = system.times(Eigen::MatrixXd::Identity(n, n));
    const Eigen::MatrixXd Jt =
        system.transposed_times(Eigen::MatrixXd::Identity(system.rows(), system.rows()));
    EXPECT_EQ(J, Jt.transpose());
    // The sparse normal matrix is J'J, with 1 where a heading is held. Sums of some 100 terms.
    Eigen::MatrixXd normal = J.transpose() * J;
    if (held) {
      const int heading = system.normal_equations().offset(one.problem.pose_node(0)) + 2;
      EXPECT_EQ(normal(heading, heading), 0.0);
      normal(heading, heading) = 1.0;
    }
    const Eigen::MatrixXd sparse =
        Eigen::MatrixXd(system.normal_equations().matrix()).selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
    EXPECT_LT(
        (scale.cwiseInverse().asDiagonal() * (sparse - normal) * scale.cwiseInverse().asDiagonal())
            .cwiseAbs()
            .maxCoeff(),
        1e-12);
    // A step of the whole solves the dense normal equations.
    const RecordingSystem::Step step = system.solve_step();
    Eigen::MatrixXd all(J.rows(), n + 1);
    all << J, system.border();
    Eigen::MatrixXd whole = all.transpose() * all;
    whole.topLeftCorner(n, n) = normal;
    const Eigen::VectorXd dense = -whole.ldlt().solve(all.transpose() * system.residuals());
    EXPECT_NEAR(step.coefficients[0], dense[n], 1e-6 * std::abs(dense[n]));
    EXPECT_LT((step.nodes - dense.head(n)).norm(), 1e-6 * dense.head(n).norm());
    // Measurements' rows, state by state.
    for (std::size_t k = 0; k < one.problem.measurements.size(); ++k) {
      const int rows = one.problem.measurements[k].rows;
      Eigen::MatrixXd own = Eigen::MatrixXd::Zero(rows, n);
      for (const RecordingSystem::NodeRows& link : system.node_rows(k)) {
        own.middleCols(system.normal_equations().offset(link.node), link.rows.cols()) += link.rows;
      }
      EXPECT_EQ(own, J.middleRows(system.first_row(k), rows)) << k;
      EXPECT_EQ(Eigen::MatrixXd(system.transposed_rows(k).topRows(n).transpose()), own) << k;
    }
  }
}

TEST(SystemWithStates, RowsOfStatesAreTheirSteps) {
  const Linearised one = linearised(7, true, true, lasting_model(true));
  RecordingSystem system(one.problem, one.border);
  system.linearise(one.state, one.coefficients);
  const auto states = static_cast<Eigen::Index>(one.problem.noise_states.size());
  ASSERT_GT(states, 100);
  const Eigen::Index first = system.rows() - states;
  for (Eigen::Index k = 0; k < states; ++k) {
    const NoiseState& state = one.problem.noise_states[static_cast<std::size_t>(k)];
    EXPECT_LT(state.previous, k);
    const double before = state.previous < 0 ? 0.0 : one.state.noise[state.previous];
    EXPECT_NEAR(system.residuals()[first + k],
                (one.state.noise[k] - state.keep * before) / state.sd, 1e-12 / state.sd);
  }
}

/// Derivatives by landmarks, poses and states are those of the residuals: central differences of
/// steps of 1e-5, whose error is 1e-10 of third derivatives and 1e-11 of the residuals, which are
/// up to 1e3. Columns have lengths from 1 to 1e5.
TEST(SystemWithStates, DerivativesAreThoseOfTheResiduals) {
  const Linearised one = linearised(7, true, true, lasting_model(true));
  RecordingSystem system(one.problem, one.border);
  system.linearise(one.state, one.coefficients);
  const Eigen::Index n = system.normal_equations().unknowns();
  const Eigen::MatrixXd J = system.times(Eigen::MatrixXd::Identity(n, n));
  constexpr double kStep = 1e-5;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto residuals_at = [&](double size) {
      const RecordingSystem::Step step{size * Eigen::VectorXd::Unit(n, k), Eigen::VectorXd::Zero(1),
                                       0.0};
      system.linearise(system.moved(one.state, step), one.coefficients);
      return system.residuals();
    };
    const Eigen::VectorXd slope =
        (Eigen::VectorXd(residuals_at(kStep)) - Eigen::VectorXd(residuals_at(-kStep))) /
        (2.0 * kStep);
    EXPECT_LT((slope - J.col(k)).norm(), 1e-6 * J.col(k).norm()) << k;
  }
}

// ----------------------------------------
// What a fit leaves of the noise.

/// P = 1 - H with the hat matrix H of all unknowns, the coefficient's column and a nuisance column
/// among them, by one dense factorisation. The normal matrix's condition of some 1e9 leaves 1e-7.
TEST(ProjectionWithStates, BlocksAreThoseOfTheDenseOne) {
  const Linearised one = linearised(7, true, true, lasting_model(true));
  RecordingSystem system(one.problem, one.border);
  fitting::FitState fit;
  for (std::size_t k = 0; k < one.problem.measurements.size(); ++k) {
    if (one.problem.measurements[k].kind == &kinds::view && k % 5 == 0) {
      fit.adjustment.left_out.push_back(static_cast<int>(k));
    }
  }
  ASSERT_GT(fit.adjustment.left_out.size(), 3U);
  system.set_weights(weights_without(fit.adjustment.left_out, one.problem.measurements.size()));
  system.linearise(one.state, one.coefficients);
  system.factorise();
  const Eigen::Index n = system.normal_equations().unknowns();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd nuisance(system.rows(), 1);
  for (Eigen::Index k = 0; k < nuisance.rows(); ++k) nuisance(k, 0) = normal(random);
  for (const int k : fit.adjustment.left_out) {
    nuisance.middleRows(system.first_row(idx(k)), one.problem.measurements[idx(k)].rows).setZero();
  }
  nuisance -= system.times(system.solve_nodes(system.transposed_times(nuisance)));
  Eigen::MatrixXd all(system.rows(), n + 2);
  all << system.times(Eigen::MatrixXd::Identity(n, n)), system.border(), nuisance;
  const Eigen::VectorXd scale = all.colwise().norm().cwiseInverse();
  const Eigen::MatrixXd scaled = all * scale.asDiagonal();
  const Eigen::MatrixXd P =
      Eigen::MatrixXd::Identity(system.rows(), system.rows()) -
      scaled * Eigen::LLT<Eigen::MatrixXd>(scaled.transpose() * scaled).solve(scaled.transpose());
  EXPECT_LT((P * P - P).cwiseAbs().maxCoeff(), 1e-7);
  const fitting::FitProjection projection(fit, one.problem, system, nuisance);
  for (std::size_t k = 0; k < one.problem.measurements.size(); ++k) {
    const int rows = one.problem.measurements[k].rows;
    const Eigen::MatrixXd expected = P.block(system.first_row(k), system.first_row(k), rows, rows);
    EXPECT_LT((projection.own_block(k) - expected).cwiseAbs().maxCoeff(), 1e-7) << k;
    EXPECT_EQ(projection.left_out(k), projection.own_block(k).isIdentity(0.0)) << k;
  }
  EXPECT_LT((projection.times(Eigen::MatrixXd::Identity(system.rows(), system.rows())) - P)
                .cwiseAbs()
                .maxCoeff(),
            1e-7);
  // Measured values kept, less unknowns of the map and coefficients: states come with a row each.
  double trace = P.trace();
  for (const int k : fit.adjustment.left_out) trace -= one.problem.measurements[idx(k)].rows;
  int kept = 0;
  for (std::size_t k = 0; k < one.problem.measurements.size(); ++k) {
    if (!projection.left_out(k)) kept += one.problem.measurements[k].rows;
  }
  const auto map = 2 * std::ssize(one.problem.landmarks) + 3 * std::ssize(one.problem.poses);
  EXPECT_NEAR(trace, static_cast<double>(kept - map - 2), 1e-6);
}

// ----------------------------------------

/// Prior covariances of segments, of two processes at once, with their own sizes.
TEST(LastingNoise, OfASegmentIsWhatItsStatesAdd) {
  const std::vector<DrivenRecording> recordings = tours(7, true, true);
  Model model = lasting_model(true);
  const RecordingProblem plain = make_problem(recordings, without_processes(model));
  const RecordingProblem problem = make_problem(recordings, model);
  Eigen::Index rows = 0;
  for (const Measurement& one : plain.measurements) rows += one.rows;
  Eigen::MatrixXd lasting = Eigen::MatrixXd::Zero(rows, rows);
  for (const NoiseProcess& one : model.noise.processes) {
    lasting += one.sd * one.sd * process_covariance(plain, recordings, model, one);
  }
  const std::vector<double> variances = state_variances(problem);
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind == &kinds::segment) {
      const Matrix4 found = segment_prior_covariance(problem, variances, k) + problem.within[k];
      const Eigen::MatrixXd expected = lasting.block(at, at, one.rows, one.rows);
      EXPECT_LT(largest_difference(found.topLeftCorner(one.rows, one.rows), expected), 1e-7) << k;
      // The whitener has what is within, and no more.
      const Matrix4 C = whitener_with(plain.measurements[k].whitener, problem.within[k], one.rows);
      EXPECT_LT((C - one.whitener).norm(), 1e-12 * C.norm()) << k;
    }
    at += one.rows;
  }
}

}  // namespace
}  // namespace trussmap::noise_states_test
