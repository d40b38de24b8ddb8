// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "monitor/lasting_error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::monitor {
namespace {

bool goes_with_distance(ProcessKind kind) {
  return kind == ProcessKind::correlated_in_distance || kind == ProcessKind::walk_in_distance;
}

}  // namespace

double LastingError::first_variance() const {
  return process_.process == ProcessKind::per_session ? process_.sd * process_.sd : 0.0;
}

LastingError::Step LastingError::next(const LegReckoning& leg) {
  const double variance = process_.sd * process_.sd;
  const double long_for = goes_with_distance(process_.process) ? leg.way : leg.duration;
  switch (process_.process) {
    case ProcessKind::per_session:
      return {1.0, 0.0};
    case ProcessKind::walk_in_t:
    case ProcessKind::walk_in_distance:
      return {1.0, variance * long_for};
    case ProcessKind::per_leg:
    case ProcessKind::per_pass:
      return {0.0, variance};
    case ProcessKind::white: {
      const int number = process_.channel == Channel::compass ? leg.readings : leg.rows;
      return {0.0, variance / std::max(number, 1)};
    }
    case ProcessKind::correlated_in_t:
    case ProcessKind::correlated_in_distance:
      break;
  }
  const double x = process_.length > 0.0 ? std::max(long_for / process_.length, 1e-6) : 1e6;
  const double share = -std::expm1(-x) / x;
  // Of a short leg the difference would be rounding.
  const double mean = variance * (x < 1e-3 ? 1.0 - x / 3.0 : 2.0 / x * (1.0 - share));
  const double rho = last_variance_ > 0.0 ? variance * share * last_share_ / last_variance_ : 0.0;
  const double q = std::max(mean - rho * rho * last_variance_, 0.0);
  last_share_ = share;
  last_variance_ = mean;
  return {rho, q};
}

}  // namespace trussmap::monitor
