// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/session_summary.hpp"

#include "estimation/kinds/kinds.hpp"
#include "estimation/summarised_days.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::session_summary_test {
using namespace estimation;
using namespace effects;
namespace {

using testing::Days;
using testing::days_of;
using testing::rows_of;

/// One of a node's numbers.
double& number_of(const RecordingProblem& problem, RecordingState& state, int node, int place) {
  if (problem.is_landmark(node)) return state.landmarks[idx(node)][place];
  if (problem.is_orientation(node)) return state.orientations[idx(node - problem.pose_end())];
  Pose& pose = state.poses[idx(node - problem.landmark_count())];
  return place == 0 ? pose.x : place == 1 ? pose.y : pose.heading;
}

/// Second differences of w'e, which know nothing of slopes.
SecondOrder by_differences(const RecordingProblem& problem, const Measurement& one,
                           RecordingState state, const ViewPattern& view, const Vector4& weighted) {
  constexpr double kStep = 1e-3;
  SecondOrder result = SecondOrder::Zero();
  ViewVector numbers = view.vector();
  const auto number = [&](int at) -> double* {
    if (at >= kSecondOrderView) return &numbers[at - kSecondOrderView];
    const int node = at < kSecondOrderTo ? one.from : one.to;
    const int place = at < kSecondOrderTo ? at : at - kSecondOrderTo;
    if (node < 0 || place >= problem.size_of(node)) return nullptr;
    return &number_of(problem, state, node, place);
  };
  const auto value = [&] {
    const ViewPattern at{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4],
                         numbers[5], numbers[6], numbers[7], numbers[8]};
    return weighted.dot(measurement_rows(problem, one, state, one.value, at).error);
  };
  const int size = is_driven(one) ? kSecondOrderView : 15;
  for (int r = 0; r < size; ++r) {
    for (int c = 0; c < size; ++c) {
      if (number(r) == nullptr || number(c) == nullptr) continue;
      for (const double along : {1.0, -1.0}) {
        for (const double across : {1.0, -1.0}) {
          *number(r) += along * kStep;
          *number(c) += across * kStep;
          result(r, c) += along * across * value() / (4.0 * kStep * kStep);
          *number(c) -= across * kStep;
          *number(r) -= along * kStep;
        }
      }
    }
  }
  return result;
}

/// Of every kind of measurement, by its nodes in closed form and by the view as well.
TEST(SecondOrder, IsWhatSecondDifferencesGive) {
  WheeledRobot robot;
  robot.fix_rate = 0.5;
  robot.loops = robot.markers = robot.range_sensor = true;
  Days days = days_of(robot, true, 1, 161);
  DrivenRecording& recording = days.recordings[0];
  for (std::size_t k = 1; k < recording.sightings.size(); k += 9) {
    const double t = recording.sightings[k].t;
    if (recording.truth.empty() || t > recording.truth.back().t) {
      recording.truth.push_back({t, 1.0, 2.0, 0.3});
    }
  }
  for (std::size_t k = 0; k < recording.sightings.size(); k += 4) {
    if (!recording.sightings[k].standing()) recording.sightings[k].range = std::nan("");
  }
  const RecordingProblem problem = make_problem(days.recordings, days.model);
  RecordingState state = dead_reckoned(problem);
  ViewPattern view;
  view.ahead = 0.2;
  view.left = -0.1;
  view.heading = 0.05;
  const Vector4 weighted(0.7, -1.1, 0.4, 0.9);
  std::set<const MeasurementKind*> seen;
  for (const Measurement& one : problem.measurements) {
    if (one.kind == &kinds::gyro) continue;
    const ViewPattern at = is_driven(one) ? ViewPattern() : view;
    const SecondOrder there = by_differences(problem, one, state, at, weighted);
    const double bound = 1e-3 * (1.0 + there.cwiseAbs().maxCoeff());
    const SecondOrder whole = second_order(problem, one, state, at, weighted, true);
    EXPECT_LT((whole - there).cwiseAbs().maxCoeff(), bound) << describe(problem, one);
    const SecondOrder nodes = second_order(problem, one, state, at, weighted, false);
    const Eigen::MatrixXd missed = (nodes - there).topLeftCorner<6, 6>();
    EXPECT_LT(missed.cwiseAbs().maxCoeff(), bound) << describe(problem, one);
    seen.insert(one.kind);
  }
  EXPECT_GE(seen.size(), 9U);
}

/// H is the derivative of g, and g that of phi, by differences.
TEST(SessionSummary, IsTheQuadraticOfItsSession) {
  Days days = days_of({true, false, true, 1}, 1, false, 91);
  days.model.noise.processes = {{Channel::bearing, ProcessKind::correlated_in_t, 0.01, 5.0}};
  days.lever = true;
  SummarisedSessions none;
  SessionRows rows = rows_of(days.recordings[0], days, none);
  const RecordingState state = rows.state;
  SessionSummary summary(std::move(rows));
  Eigen::VectorXd u = summary.shared_of(state, Eigen::VectorXd::Constant(1, 0.02));
  for (Eigen::Index k = 0; k < u.size() - 1; ++k) u[k] += 0.003 * std::sin(static_cast<double>(k));
  summary.linearise(u);
  const SessionSummary::Quadratic& one = summary.quadratic();
  constexpr double kStep = 1e-4;
  for (const Eigen::Index k : {Eigen::Index{0}, Eigen::Index{5}, u.size() - 1}) {
    const Eigen::VectorXd move = kStep * Eigen::VectorXd::Unit(u.size(), k);
    const auto above = summary.value_at(u + move);
    const auto below = summary.value_at(u - move);
    const double slope = (above.half_chi2 - below.half_chi2) / (2.0 * kStep);
    EXPECT_NEAR(slope, one.gradient[k], 1e-4 * one.gradient.norm());
    const Eigen::VectorXd column = (above.gradient - below.gradient) / (2.0 * kStep);
    EXPECT_LT((column - one.information.col(k)).norm(), 1e-5 * one.information.col(k).norm());
  }
}

}  // namespace
}  // namespace trussmap::session_summary_test
