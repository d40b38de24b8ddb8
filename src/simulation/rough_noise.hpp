// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Errors of a simulated robot's wheels and compass: as its SensorNoise states them, or rough
// (RoughNoise).
//
//   z        white, normal, variance 1: what the stated standard deviation multiplies
//   tails    z / sqrt(q), q chi-square with 3 degrees of freedom: Student's t, variance 1
//   memory,  e_k = a e_(k-1) + sqrt(1 - a^2) z_k, variance 1; a = exp(-T/m) with the row's
//   haze     duration T and the memory m, both in s
//   memory   e_k sqrt((1 - a)/(1 + a)): the sum of n errors e_k has variance n (1 + a)/(1 - a) for
//            large n, that of white ones n
//   half     times 2
//   floor    all wheels' travels of a leg, mean and difference, times 1 + a share of the leg's own
//
// The steering angle's noise is white and normal whatever the others are.
//
// Each acts on the one before, on the z that are there without it: a kind left out changes nothing
// in the others.
#pragma once

#include "trussmap/simulation.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace trussmap::simulation {

/// White errors of variance 1: normal, or with heavy tails.
class WhiteErrors {
 public:
  WhiteErrors(std::uint64_t seed, Stream normal, Stream tails, bool heavy);
  double next();

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::mt19937_64 random_tails_;
  std::chi_squared_distribution<double> chi_square_;
  bool heavy_;
};

/// Errors that last.
class DriftingNoise {
 public:
  enum class Keeps {
    variance,  ///< each error is as uncertain as a white one
    sum        ///< many errors together are
  };

  /// `memory` in s; 0: white.
  DriftingNoise(double memory, Keeps keeps) : memory_(memory), keeps_(keeps) {}

  /// The error that comes `elapsed` s after the last one; `white` is what is new in it.
  double next(double white, double elapsed);

 private:
  double memory_;
  Keeps keeps_;
  bool begun_ = false;
  double last_ = 0.0;
};

/// What is wrong with each row's readings, to be asked for row by row.
class SensorErrors {
 public:
  SensorErrors(const WheeledRobot& robot, std::uint64_t seed);

  /// m, of one of the robot's columns.
  double wheel(std::size_t column, double travel, double duration);
  double steering(double travel);   ///< rad
  double compass(double duration);  ///< rad

 private:
  SensorNoise noise_;
  double size_;  ///< of wheel and compass errors, in units of the stated ones
  WhiteErrors white_wheels_;
  WhiteErrors white_compass_;
  std::vector<double> wheel_noise_;    ///< k, m^(1/2)
  std::vector<DriftingNoise> wheels_;  ///< one per column
  DriftingNoise compass_;
  std::mt19937_64 random_steering_;
  std::normal_distribution<double> normal_;
};

/// By which share the wheels misread a leg.
struct LegMisreading {
  double travel = 0.0;
  double turn = 0.0;
};

/// Of every row, the same from one stop to the next; empty without RoughNoise::floor.
[[nodiscard]] std::vector<LegMisreading> leg_misreadings(const TrueMotion& motion,
                                                         const RoughNoise& rough,
                                                         std::uint64_t seed);

}  // namespace trussmap::simulation
