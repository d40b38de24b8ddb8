// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_rows.hpp"

#include "estimation/kinds/kinds.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::measurement_rows_test {
using namespace estimation;
namespace {

/// Two landmarks (nodes 0, 1), two poses (nodes 2, 3) and the second landmark's orientation (4).
RecordingProblem small_problem() {
  RecordingProblem problem;
  problem.landmarks = {"A", "B"};
  problem.poses = {{0, 1.0}, {0, 2.0}};
  problem.oriented = {1};
  problem.sessions = {"s"};
  return problem;
}

Measurement measurement(const MeasurementKind* kind, int from, int to, int rows) {
  Measurement one;
  one.kind = kind;
  one.from = from;
  one.to = to;
  one.rows = rows;
  one.value << 0.7, -0.3, 0.4, 1.1;
  return one;
}

struct Everything {
  RecordingState state;
  effects::ViewPattern view;
};

Everything random_values(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  const auto draw = [&] { return uniform(random); };
  Everything all;
  all.state.landmarks = {{draw(), draw()}, {draw(), draw()}};
  all.state.poses = {{draw(), draw(), 2.0 * draw()}, {draw(), draw(), 2.0 * draw()}};
  all.state.orientations = {draw()};
  all.view = {0.1 * draw(), 0.1 * draw(), 0.1 * draw(), 0.1 * draw(), 0.1 * draw(),
              0.1 * draw(), 0.1 * draw(), 0.1 * draw(), 0.1 * draw()};
  return all;
}

double* coordinate(Everything& all, int node, int k) {
  if (node < 2) return &all.state.landmarks[idx(node)][k];
  if (node == 4) return all.state.orientations.data();
  Pose& pose = all.state.poses[idx(node - 2)];
  return k == 0 ? &pose.x : k == 1 ? &pose.y : &pose.heading;
}

double* view_entry(Everything& all, int k) {
  effects::ViewPattern& view = all.view;
  double* const entries[] = {&view.ahead, &view.left,        &view.heading,
                             &view.range, &view.range_scale, &view.bearing,
                             &view.x,     &view.y,           &view.yaw};
  return entries[k];
}

Vector4 difference(const Measurement& one, Everything all,
                   const std::function<double*(Everything&)>& entry) {
  constexpr double kStep = 1e-6;
  const RecordingProblem problem = small_problem();
  const auto error = [&](double change) {
    Everything moved = all;
    *entry(moved) += change;
    return measurement_rows(problem, one, moved.state, one.value, moved.view).error;
  };
  return (error(kStep) - error(-kStep)) / (2.0 * kStep);
}

std::vector<Measurement> of_all_kinds() {
  return {
      measurement(&kinds::segment, 2, 3, 4),      measurement(&kinds::segment, 3, 2, 3),
      measurement(&kinds::standing, 2, 1, 2),     measurement(&kinds::view, 3, 0, 2),
      measurement(&kinds::view, 3, 1, 1),         measurement(&kinds::cartesian_view, 2, 0, 2),
      measurement(&kinds::survey, 1, -1, 2),      measurement(&kinds::truth, 3, -1, 3),
      measurement(&kinds::fix, 2, -1, 2),         measurement(&kinds::loop, 3, 2, 3),
      measurement(&kinds::sighting_yaw, 3, 4, 1), measurement(&kinds::survey_heading, 4, -1, 1)};
}

TEST(MeasurementRows, DerivativesAreThoseOfDifferences) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Everything all = random_values(seed);
    for (const Measurement& one : of_all_kinds()) {
      const MeasurementRows rows =
          measurement_rows(small_problem(), one, all.state, one.value, all.view);
      for (int k = 0; k < 3; ++k) {
        const auto check = [&](int node, const RowsByNode& found) {
          if (node < 0 || (node < 2 && k == 2) || (node == 4 && k > 0)) return;
          const Vector4 expected =
              difference(one, all, [&](Everything& at) { return coordinate(at, node, k); });
          EXPECT_LT((found.col(k) - expected).norm(), 1e-7)
              << one.kind->facts().words << " node " << node << " entry " << k;
        };
        check(one.from, rows.by_from);
        check(one.to, rows.by_to);
      }
      for (int k = 0; k < 9; ++k) {
        const Vector4 expected =
            difference(one, all, [&](Everything& at) { return view_entry(at, k); });
        EXPECT_LT((rows.by_view.col(k) - expected).norm(), 1e-7)
            << one.kind->facts().words << " view entry " << k;
      }
    }
  }
}

/// What is laid over a measurement as lasting noise of a channel must change it.
TEST(MeasurementKinds, WhatAChannelShowsInIsChangedByIt) {
  const Everything all = random_values(7);
  int shown = 0;
  for (const Measurement& one : of_all_kinds()) {
    const MeasurementRows rows =
        measurement_rows(small_problem(), one, all.state, one.value, all.view);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(Channel::sighting_yaw); ++k) {
      const auto channel = static_cast<Channel>(k);
      if (is_driven(one) || !one.kind->shows(channel, one)) continue;
      ++shown;
      EXPECT_GT((rows.by_view * one.kind->unit_view(channel, one, 0.5, 0.3)).norm(), 0.01)
          << one.kind->facts().words << ", " << name_of(channel);
    }
  }
  EXPECT_GE(shown, 20);
}

TEST(MeasurementRows, WhatFitsHasNoError) {
  const RecordingProblem problem = small_problem();
  RecordingState state;
  state.landmarks = {{1.0, 3.0}, {0.0, 0.0}};
  state.poses = {{1.0, 1.0, std::acos(0.0)}, {1.0, 1.0, 0.0}};
  Measurement one = measurement(&kinds::view, 2, 0, 2);
  one.value << 2.0, 0.0, 0.0, 0.0;  // straight ahead
  EXPECT_LT(measurement_rows(problem, one, state, one.value, {}).error.norm(), 1e-15);
  one.kind = &kinds::cartesian_view;
  EXPECT_LT(measurement_rows(problem, one, state, one.value, {}).error.norm(), 1e-15);
}

/// Of no robot that saw it from 2 m, but of a trajectory that has folded up.
TEST(MeasurementRows, OnALandmarkThatWasSeenFromAfarADirectionHasABoundedSlope) {
  RecordingState state;
  state.landmarks = {{1.0, 1.0}, {0.0, 0.0}};
  state.poses = {{1.0, 1.0 - 1e-6, 0.0}, {1.0, 1.0, 0.0}};
  Measurement one = measurement(&kinds::view, 2, 0, 2);
  one.value << 2.0, 0.0, 0.0, 0.0;
  const MeasurementRows rows = measurement_rows(small_problem(), one, state, one.value, {});
  EXPECT_NEAR(rows.by_to.row(0).head<2>().norm(), 1.0, 1e-9);
  EXPECT_LT(rows.by_to.row(1).head<2>().norm(), 100.0 / 2.0);
}

}  // namespace
}  // namespace trussmap::measurement_rows_test
