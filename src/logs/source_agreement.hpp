// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Two sources of one robot's motion, compared before anything is fitted: the velocities of an
// odometry with the poses beside them, wheels with an odometry.
//
//   window       a second or so, over which late and jittering messages do not matter
//   a, b         what either moved in it: ahead and to the left [m], turned [rad]
//   times        sqrt(sum a^2/sum b^2): how many times as much a moves; in its sign sum ab's
//   likeness     sum ab/sqrt(sum a^2 sum b^2), 1: the same but for a factor
//
// No effect of a robot is as large as what is said here: a scale beyond a tenth, a sign, an axis,
// velocities in the axes of the odometry's frame in place of the robot's.
#pragma once

#include "logs/pose_fields.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

/// Over a window, or a part of one.
struct PlanarStep {
  double ahead = 0.0;  ///< m
  double left = 0.0;   ///< m
  double turn = 0.0;   ///< rad

  PlanarStep& operator+=(const PlanarStep& more) {
    ahead += more.ahead;
    left += more.left;
    turn += more.turn;
    return *this;
  }
};

/// Sums over all windows: memory does not grow.
class MotionAgreement {
 public:
  void add_window(const PlanarStep& a, const PlanarStep& b);
  /// What contradicts, in words with numbers; none where either hardly moves. `a` and `b` are what
  /// the sources are called: "the twist of /odom".
  [[nodiscard]] std::vector<std::string> contradictions(const std::string& a,
                                                        const std::string& b) const;

 private:
  struct Products {
    double aa = 0.0, bb = 0.0, ab = 0.0;

    void add(double one, double other);
    [[nodiscard]] double times() const;
    [[nodiscard]] double likeness() const;
    [[nodiscard]] bool both_move() const { return aa > 0.0 && bb > 0.0; }
  };

  std::size_t windows_ = 0;
  double way_a_ = 0.0;    // m
  double way_b_ = 0.0;    // m
  double turns_a_ = 0.0;  // rad
  double turns_b_ = 0.0;  // rad
  Products ahead_;
  Products turn_;
  Products left_as_ahead_;  // a's way to the left with b's ahead
};

/// Velocities beside poses in the messages of one odometry, in the order of the log.
class TwistBesidePose {
 public:
  void add(std::int64_t t, const FieldTwist& twist, const FieldPose& pose);
  [[nodiscard]] std::vector<std::string> contradictions(const std::string& path) const;

 private:
  struct Message {
    std::int64_t t = 0;  // ns
    FieldTwist twist;
    double x = 0.0, y = 0.0, heading = 0.0;
  };
  struct Window {
    double duration = 0.0;  // s
    std::size_t steps = 0;
    double way = 0.0;      // m, of all steps of the pose
    double longest = 0.0;  // m, of one
    PlanarStep twist, turned_twist, pose;
  };

  void close_window();

  std::optional<Message> before_;
  Window window_;
  MotionAgreement agreement_;
  double missed_ = 0.0;         // m^2, squares of what the pose moves beyond the twist
  double missed_turned_ = 0.0;  // the same of the twist taken in the axes of the odometry's frame
  double moved_ = 0.0;          // m^2, squares of what the pose moves
};

}  // namespace trussmap::logs
