// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A true motion while it is laid, segment by segment (true_motion.hpp). A segment has as many rows
// as an earlier path's, where there is one.
#pragma once

#include "simulation/true_motion.hpp"

#include <vector>

namespace trussmap::simulation {

class MotionSoFar {
 public:
  /// `warm_at`: phase of the temperature, rad.
  MotionSoFar(const DrivingStyle& style, const PathBias& bias, double warm_at)
      : style_(style), bias_(bias), warm_at_(warm_at) {}

  /// With the style's first heading, at time 0.
  void start_at(const Vector2& position);
  void stop(int landmark);
  void surround(const Surroundings& now) { surroundings_ = now; }

  void rest(double seconds);
  /// On the spot, at a rate [rad/s].
  void spin(double angle, double wanted_rate);
  /// A turn of about so much [rad], in arcs of so many rows each.
  void turn_in_arcs(double about, double turn, double radius, const std::vector<int>& rows);
  /// At a turn rate [rad/s], one circle after the other.
  void circle(double angle, double radius, double rate);
  /// Straight on, on a course.
  void drive_on(double length, double wanted_speed, const Vector2& course);
  /// A leg of so long a way on a course; of its rows, shares of the mean speed and headings at
  /// their ends, one more than there are rows.
  void drive(double length, const Vector2& course, const std::vector<double>& profile,
             const std::vector<double>& headings);

  [[nodiscard]] const Pose& pose() const { return pose_; }
  [[nodiscard]] const Surroundings& surroundings() const { return surroundings_; }
  [[nodiscard]] const TrueMotion& motion() const { return motion_; }

 private:
  [[nodiscard]] double time_after(std::size_t rows) const;
  int rows_of_segment(int wanted);
  void add_row(Activity activity, double speed, double turn_rate, double jump = 0.0);
  void drive_row(double way, double speed, double last, const Vector2& course);
  void drive_arcs(double turn, double radius, const std::vector<int>& rows);
  void move(const Vector2& step);

  const DrivingStyle& style_;
  const PathBias& bias_;
  double warm_at_;
  Pose pose_;
  Surroundings surroundings_;
  TrueMotion motion_;
};

}  // namespace trussmap::simulation
