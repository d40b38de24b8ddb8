// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What real robots lack (UTIAS MRCLAM set 6), from landmarks alone, judged by the motion capture.
#include "datasets/formats.hpp"
#include "driven.hpp"
#include "shared_data.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::mrclam_discovery_test {
namespace {

Pose truth_at(const std::vector<TruthRow>& truth, std::size_t after, double t) {
  const TruthRow& a = truth[after - 1];
  const TruthRow& b = truth[after];
  const double share = (t - a.t) / (b.t - a.t);
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          a.heading + share * wrap_angle(b.heading - a.heading)};
}

/// Rms error of poses over a horizon, from anchors every half of it, where the motion capture has
/// no gap at either end; m.
double error_after(const std::vector<TimedPose>& poses, const std::vector<TruthRow>& truth,
                   double delay, double horizon) {
  const auto pose_at = [&poses](double t) {
    auto after = std::lower_bound(poses.begin(), poses.end(), t,
                                  [](const TimedPose& one, double when) { return one.t < when; });
    after = std::clamp(after, poses.begin() + 1, poses.end() - 1);
    const auto before = after - 1;
    const double share = (t - before->t) / (after->t - before->t);
    const Pose& a = before->estimate.pose;
    const Pose& b = after->estimate.pose;
    return Pose{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
                a.heading + share * (b.heading - a.heading)};
  };
  const auto moved = [](const Pose& a, const Pose& b) {
    return Vector2(rotation(-a.heading) * (b.position() - a.position()));
  };
  const auto row_after = [&truth](double t) {
    return static_cast<std::size_t>(
        std::lower_bound(truth.begin(), truth.end(), t,
                         [](const TruthRow& row, double when) { return row.t < when; }) -
        truth.begin());
  };
  double sum = 0.0;
  int windows = 0;
  for (double t = truth.front().t + 1.0; t + horizon + 1.0 < truth.back().t; t += 0.5 * horizon) {
    const std::size_t from = row_after(t);
    const std::size_t to = row_after(t + horizon);
    if (truth[from].t - truth[from - 1].t > 0.25 || truth[to].t - truth[to - 1].t > 0.25) continue;
    const Vector2 said = moved(pose_at(t - delay), pose_at(t + horizon - delay));
    const Vector2 was = moved(truth_at(truth, from, t), truth_at(truth, to, t + horizon));
    sum += (said - was).squaredNorm();
    ++windows;
  }
  return std::sqrt(sum / std::max(1, windows));
}

TEST(SlowMrclamDiscovery, FindsDelayAndLossInArcsAndDeadReckoningGetsBetter) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  const Dataset read = datasets::read_mrclam(testing::shared("data/mrclam/MRCLAM_Dataset6/Robot5"));
  DiscoverOptions options;
  options.diagnosis.fit.use_truth = false;
  options.diagnosis.fit.gate = 16.0;
  options.diagnosis.fit.most_left_out = 0.12;
  const LastingErrors errors =
      lasting_errors(fit_model({read.recording}, read.model, options.diagnosis.fit));
  EXPECT_GE(errors.lasts, 0.5);
  const Discovery found =
      discover(thinned_frames({testing::driven(read.recording, read.model.robot)}, errors.lasts),
               read.model, options);
  EXPECT_TRUE(found.found.settled);
  std::set<std::string> names;
  double delay = 0.0;
  for (const Effect& effect : found.found.model.effects) {
    names.insert(effect.name);
    if (effect.name == "sighting delay") delay = effect.coefficients.front();
  }
  EXPECT_TRUE(names.contains("sighting delay"));
  EXPECT_TRUE(names.contains("arc loss"));
  EXPECT_NEAR(delay, 0.3, 0.06);
  const std::vector<TruthRow>& truth = read.recording.truth;
  const auto before = dead_reckoned_poses(read.recording, read.model);
  const auto after = dead_reckoned_poses(read.recording, found.found.model);
  EXPECT_LT(error_after(after, truth, delay, 10.0), 0.7 * error_after(before, truth, 0.0, 10.0));
  EXPECT_LT(error_after(after, truth, delay, 30.0), 0.9 * error_after(before, truth, 0.0, 30.0));
}

}  // namespace
}  // namespace trussmap::mrclam_discovery_test
