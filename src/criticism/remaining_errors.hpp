// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Single events and laws of noise, asked of what errors there are once what is missing is in the
// model: fitted with it, for a large effect bends the rows, what a plane leaves of it would pass
// for noise, and what contradicts a model without it may well fit then.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace trussmap::criticism {

struct RemainingErrors {
  std::vector<EventTest> events;  ///< likeliest first
  std::vector<NoiseTest> noise;   ///< beyond what is stated, best explanation first
  bool fitted = false;            ///< what is missing could be: only then are there
  std::size_t left_out = 0;       ///< measurements that the gate still leaves out
  double p_value = 0.0;           ///< of chi^2
};

/// `fit` lacks `missing`, whose places and thresholds are known, and which are in the fit `with`
/// (if_fitted_with, refits.hpp); `about`: the tests of that, or of `fit` where there is none;
/// `stated`: the noise that the user's model has. Where they cannot be fitted together, all is
/// asked of the fit as it is, less what their columns explain. Throws as refit does.
[[nodiscard]] RemainingErrors remaining_errors(const std::vector<DrivenRecording>& recordings,
                                               const ModelFit& fit,
                                               const std::optional<ModelFit>& with,
                                               const ScoreTest& about, const Noise& stated,
                                               const std::vector<Effect>& missing);

/// The laws of noise alone, of a fit that lacks nothing.
[[nodiscard]] std::vector<NoiseTest> noise_beyond(const std::vector<DrivenRecording>& recordings,
                                                  const ModelFit& fit, const Noise& stated);

}  // namespace trussmap::criticism
