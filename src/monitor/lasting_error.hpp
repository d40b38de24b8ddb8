// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise that lasts (NoiseProcess), leg by leg: the mean z of its g over a leg goes on as
//
//   z_k = rho_k z_{k-1} + N(0, q_k)
//
//   Ornstein-Uhlenbeck, sd s, leg x = duration/length long:
//     variance of the mean       v = s^2 2/x (1 - (1 - exp(-x))/x)
//     covariance with the last   s^2 (1 - exp(-x))/x (1 - exp(-x'))/x'     = rho v',  q = v - rho^2
//     v'
//   per leg   rho = 0, q = s^2      per session   rho = 1, q = 0, at first s^2
//   white     rho = 0, q = s^2/number of rows or readings
//   walk      rho = 1, q = s^2 duration or way, at first 0
#pragma once

#include "monitor/leg_odometry.hpp"
#include "trussmap/model.hpp"

namespace trussmap::monitor {

class LastingError {
 public:
  explicit LastingError(const NoiseProcess& process) : process_(process) {}

  [[nodiscard]] Channel channel() const { return process_.channel; }
  /// Of z before the first leg.
  [[nodiscard]] double first_variance() const;

  struct Step {
    double rho = 0.0;
    double variance = 0.0;  ///< q
  };
  /// To this leg from the one before.
  [[nodiscard]] Step next(const LegReckoning& leg);

 private:
  NoiseProcess process_;
  double last_share_ = 0.0;     ///< (1 - exp(-x))/x of the leg before; 0: none
  double last_variance_ = 0.0;  ///< v of the leg before
};

}  // namespace trussmap::monitor
