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
//   b   the wheels' heading error, a random walk
//
// Compasses are misled in a way that goes round with the heading, and wheelbases are off, whether
// or not the model knows: sines and cosines of the heading and of twice it, and the turn, are taken
// out first.
//
// Kalman's filter gives the likelihood, the start heading unknown (diffuse): that of the readings'
// differences, to which the mean adds what it knows besides.
#pragma once

#include "fit/fit_state.hpp"

#include <vector>

namespace trussmap {

/// A chain process of the compass.
struct ReadingProcess {
  ProcessKind process = ProcessKind::correlated_in_t;
  double sd = 0.0;
  double length = 0.0;
};

class ReadingScatter {
 public:
  /// Segments with three readings and more, freed of the fit's effects.
  explicit ReadingScatter(const FitState& fit);

  [[nodiscard]] bool empty() const { return segments_.empty(); }

  /// -2 log likelihood. `white`: sd of a reading, rad. `wheels`: by what the wheels' heading
  /// variance is larger than the fit's model has it.
  [[nodiscard]] double minus_two_log(double white, double wheels,
                                     const std::vector<ReadingProcess>& processes) const;

 private:
  struct Row {
    double y = 0.0;       ///< rad; NaN: no reading
    double lag = 0.0;     ///< s
    double way = 0.0;     ///< m
    double wheels = 0.0;  ///< variance of the wheels' heading error, rad^2
  };
  static constexpr int kHabits = 5;
  using Habits = Eigen::Matrix<double, kHabits, 1>;
  [[nodiscard]] static Habits habits_of(double heading, double turned);
  /// Takes out what the readings' steps have in common with these, by least squares.
  void free_of_habits(const std::vector<std::vector<Habits>>& habits);

  std::vector<std::vector<Row>> segments_;
};

}  // namespace trussmap
