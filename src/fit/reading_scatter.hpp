// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the compass readings of a segment say of noise among themselves. The adjustment knows a
// segment's readings by their mean alone; how they scatter about it tells noise that is white from
// noise that lasts, which the mean cannot.
//
//   y_k = reading_k - turned since the segment's start
//       = start heading + z_k + w_k - b_k
//
//   z   Ornstein-Uhlenbeck or walk (the compass's processes)     w   white
//   b   the wheels' heading error: a random walk, and what their processes add to the turn (a row's
//       mean as that of its ends; what lasts for a leg as lasting for the segment)
//
// Compasses are misled in a way that goes round with the heading, and wheelbases are off, whether
// or not the model knows: sines and cosines of the heading and of twice it, and the turn, are taken
// out first.
//
// Kalman's filter gives the likelihood, the start heading unknown (diffuse): that of the readings'
// differences, to which the mean adds what it knows besides.
#pragma once

#include "drive/row_motion.hpp"
#include "fit/fit_state.hpp"

#include <vector>

namespace trussmap::fitting {

/// Noise as far as it shows in readings.
struct ReadingNoise {
  double white = 0.0;   ///< sd of a reading, rad
  double wheels = 1.0;  ///< by what the wheels' variance is larger than the fit's model has it
  double heading_per_s = 0.0;    ///< rad/s^(1/2)
  double heading_per_rad = 0.0;  ///< rad/rad^(1/2)
  std::vector<NoiseProcess> processes = {};

  friend bool operator==(const ReadingNoise& a, const ReadingNoise& b) = default;
};

/// Whether a process matters here: white ones of the compass are not asked for.
[[nodiscard]] bool shows_in_readings(const NoiseProcess& process);

class ReadingScatter {
 public:
  /// Segments with three readings and more, freed of the fit's effects.
  explicit ReadingScatter(const FitState& fit);

  [[nodiscard]] bool empty() const { return segments_.empty(); }

  /// -2 log likelihood. Processes that do not matter here are passed over, and what comes after the
  /// fourth that does.
  [[nodiscard]] double minus_two_log(const ReadingNoise& noise) const;

 private:
  /// White noise of the turn.
  struct TurnLaws {
    double wheels = 1.0;   ///< as ReadingNoise has them
    double per_s = 0.0;    ///< rad/s^(1/2)
    double per_rad = 0.0;  ///< rad/rad^(1/2)
  };
  struct Row {
    double y = 0.0;  ///< rad; NaN: no reading
    drive::RowMotion motion;
    double way = 0.0;     ///< m
    double turn = 0.0;    ///< rad, not signed
    double wheels = 0.0;  ///< variance that the wheels' k give the turn, rad^2

    [[nodiscard]] double turn_variance(const TurnLaws& laws) const {  ///< rad^2
      return laws.wheels * wheels + laws.per_s * laws.per_s * motion.duration +
             laws.per_rad * laws.per_rad * turn;
    }
  };
  /// With so many of the processes.
  template <int Count>
  struct Filter;
  template <int Count>
  [[nodiscard]] double filtered(const ReadingNoise& noise) const;

  static constexpr int kHabits = 5;
  using Habits = Eigen::Matrix<double, kHabits, 1>;
  [[nodiscard]] static Habits habits_of(double heading, double turned);
  /// Takes out what the readings have in common with these, by least squares within segments that
  /// turn by far more than the wheels' noise: elsewhere the turn is mostly that noise, which is in
  /// y as well, and would be taken for a habit.
  void free_of_habits(const std::vector<std::vector<Habits>>& habits, const Noise& believed);

  std::vector<std::vector<Row>> segments_;
};

}  // namespace trussmap::fitting
