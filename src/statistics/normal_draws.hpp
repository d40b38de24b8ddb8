// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <random>

namespace trussmap::statistics {

/// Normal errors, one after the other.
struct NormalDraws {
  std::mt19937_64 random;
  std::normal_distribution<double> normal = {};

  double operator()(double sd) { return sd * normal(random); }
};

}  // namespace trussmap::statistics
