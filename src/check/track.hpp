// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the wheels alone lead, taken as recorded or as if a mistake had been made with them. Drives
// with other wheels are taken by the body's motion that their columns give (with_wheels).
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <string>
#include <utility>
#include <vector>

namespace trussmap::check {

/// Of other drives than two wheels: `exchanged` is the mirrored motion.
enum class WheelMistake { none, exchanged, negated, left_negated, right_negated };

/// A row's motion as it would be without the mistake; `wheelbase` (m) of two wheels.
[[nodiscard]] BodyMotion motion_without(WheelMistake mistake, const MotionRows& drive,
                                        std::size_t row, double wheelbase);

/// "left,right", or the names of the drive's own columns.
[[nodiscard]] std::string wheel_columns(const MotionRows& drive);

/// Whether headings are kept near a compass's readings.
enum class Heading { of_wheels, of_compass };

/// Poses at the ends of a drive's rows, from (0, 0, 0) at its start; straight in between.
class Track {
 public:
  /// `wheelbase`: as motion_without.
  explicit Track(const MotionRows& drive, WheelMistake mistake = WheelMistake::none,
                 double wheelbase = 0.0, Heading heading = Heading::of_wheels);

  [[nodiscard]] Pose at(double t) const;
  [[nodiscard]] double way_at(double t) const;  ///< m driven since the start

 private:
  [[nodiscard]] std::pair<std::size_t, double> place_of(double t) const;

  std::vector<double> t_;  ///< one more than rows
  std::vector<Pose> poses_;
  std::vector<double> way_;
};

}  // namespace trussmap::check
