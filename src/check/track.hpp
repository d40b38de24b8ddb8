// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the wheels alone lead, taken as recorded or as if a mistake had been made with them.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap {

enum class WheelMistake { none, exchanged, negated, left_negated, right_negated };

/// A row's travels as they would be without the mistake.
struct Wheels {
  double left = 0.0;   ///< m
  double right = 0.0;  ///< m

  [[nodiscard]] double path() const { return 0.5 * (left + right); }
  [[nodiscard]] double difference() const { return right - left; }
};
[[nodiscard]] Wheels wheels_of(const Drive& drive, std::size_t row, WheelMistake mistake);

/// Whether headings are kept near a compass's readings.
enum class Heading { of_wheels, of_compass };

/// Poses at the ends of a drive's rows, from (0, 0, 0) at its start; straight in between.
class Track {
 public:
  Track(const Drive& drive, double wheelbase, WheelMistake mistake = WheelMistake::none,
        Heading heading = Heading::of_wheels);

  [[nodiscard]] Pose at(double t) const;
  [[nodiscard]] double way_at(double t) const;  ///< m driven since the start

 private:
  [[nodiscard]] std::pair<std::size_t, double> place_of(double t) const;

  std::vector<double> t_;  ///< one more than rows
  std::vector<Pose> poses_;
  std::vector<double> way_;
};

}  // namespace trussmap
