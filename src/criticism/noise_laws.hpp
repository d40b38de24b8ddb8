// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What each law of noise adds to the covariance of each measurement.
#pragma once

#include "fit/effect_columns.hpp"
#include "fit/fit_state.hpp"

#include <string>
#include <vector>

namespace trussmap::criticism {

struct NoiseLaw {
  std::string name;
  std::string unit;
  double stated = 0.0;  ///< standard deviation that the model has, in `unit`
  double margin = 0.0;  ///< by which its score must exceed those of laws without
  std::vector<estimation::Matrix4>
      added;  ///< per measurement: covariance per unit of variance, in its values
};

/// Those that add something anywhere.
[[nodiscard]] std::vector<NoiseLaw> noise_laws(const fitting::FitState& fit,
                                               const fitting::ShapeContext& context);

}  // namespace trussmap::criticism
