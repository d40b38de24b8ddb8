// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/robust_weights.hpp"

#include <cmath>

namespace trussmap::estimation {

double soft_weight(double squared_error, double gate) {
  return std::pow(gate / (squared_error + gate), 2);
}

double gnc_weight(double squared_error, double gate, double mu) {
  if (squared_error <= mu / (mu + 1.0) * gate) return 1.0;
  if (squared_error >= (mu + 1.0) / mu * gate) return 0.0;
  return std::sqrt(gate * mu * (mu + 1.0) / squared_error) - mu;
}

double first_bend(double largest_squared_error, double gate) {
  return gate / (2.0 * largest_squared_error - gate);
}

}  // namespace trussmap::estimation
