// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "estimation/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace trussmap::estimation {

/// A row per value; an sd below a micrometre or microradian is one.
[[nodiscard]] inline Measurement independent_rows(const MeasurementKind& kind,
                                                  std::initializer_list<double> values,
                                                  std::initializer_list<double> sds) {
  constexpr double kExactSd = 1e-6;  // m or rad
  Measurement one;
  one.kind = &kind;
  one.rows = static_cast<int>(values.size());
  std::copy(values.begin(), values.end(), one.value.data());
  Eigen::Index k = 0;
  for (const double sd : sds) {
    one.whitener(k, k) = 1.0 / std::max(sd, kExactSd);
    ++k;
  }
  return one;
}

/// The row's own, or the model's.
[[nodiscard]] inline double stated_or(double sd, double otherwise) {
  return std::isnan(sd) ? otherwise : sd;
}

}  // namespace trussmap::estimation
