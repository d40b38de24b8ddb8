// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/track.hpp"

#include "drive/body_motion.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::check {

BodyMotion motion_without(WheelMistake mistake, const MotionRows& drive, std::size_t row,
                          double wheelbase) {
  const BodyMotion recorded = drive.motion(row);
  switch (mistake) {
    case WheelMistake::none:
      break;
    case WheelMistake::exchanged:
      return {recorded.forward, -recorded.sideways, -recorded.turn};
    case WheelMistake::negated:
      return -1.0 * recorded;
    case WheelMistake::left_negated:
      return drive::body_motion({-drive.pair.left[row], drive.pair.right[row]}, wheelbase);
    case WheelMistake::right_negated:
      return drive::body_motion({drive.pair.left[row], -drive.pair.right[row]}, wheelbase);
  }
  return recorded;
}

std::string wheel_columns(const MotionRows& drive) {
  if (drive.of_two_wheels()) return "left,right";
  std::string names;
  for (const std::string& one : drive.unicycle) names += (names.empty() ? "" : ",") + one;
  for (const WheelColumn& one : drive.wheels) names += (names.empty() ? "" : ",") + one.name;
  return names;
}

Track::Track(const MotionRows& drive, WheelMistake mistake, double wheelbase, Heading heading) {
  constexpr double kHeed = 0.05;  // of what the compass says, per reading
  t_.reserve(drive.rows() + 1);
  poses_.reserve(drive.rows() + 1);
  way_.reserve(drive.rows() + 1);
  t_.push_back(drive.start());
  poses_.push_back({});
  way_.push_back(0.0);
  Pose at;
  bool seen = false;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const BodyMotion motion = motion_without(mistake, drive, row, wheelbase);
    const double half = at.heading + 0.5 * motion.turn;
    at.x += motion.forward * std::cos(half) - motion.sideways * std::sin(half);
    at.y += motion.forward * std::sin(half) + motion.sideways * std::cos(half);
    at.heading += motion.turn;
    if (heading == Heading::of_compass && !std::isnan(drive.heading[row])) {
      const double off = wrap_angle(drive.heading[row] - at.heading);
      at.heading += seen ? kHeed * off : off;
      seen = true;
    }
    t_.push_back(drive.t[row]);
    poses_.push_back(at);
    way_.push_back(way_.back() + std::hypot(motion.forward, motion.sideways));
  }
}

std::pair<std::size_t, double> Track::place_of(double t) const {
  const auto after = std::lower_bound(t_.begin() + 1, t_.end() - 1, t);
  const auto k = static_cast<std::size_t>(after - t_.begin());
  const double share = (t - t_[k - 1]) / (t_[k] - t_[k - 1]);
  return {k, std::clamp(share, 0.0, 1.0)};
}

Pose Track::at(double t) const {
  const auto [k, share] = place_of(t);
  const Pose& a = poses_[k - 1];
  const Pose& b = poses_[k];
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
          a.heading + share * (b.heading - a.heading)};
}

double Track::way_at(double t) const {
  const auto [k, share] = place_of(t);
  return way_[k - 1] + share * (way_[k] - way_[k - 1]);
}

}  // namespace trussmap::check
