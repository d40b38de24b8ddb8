// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is suspicious about a fit, in words.
#pragma once

#include "fit/fit_state.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::fitting {

/// What a diagnosis has found out about a fit.
struct FitAnswers {
  bool misfit = false;  ///< why its chi^2 is too large
  /// How many measurements the gate would leave out with what is missing added.
  std::optional<std::size_t> left_out_with_missing;
};

[[nodiscard]] std::vector<std::string> fit_warnings(const FitState& fit,
                                                    const FitAnswers& answers = {});

}  // namespace trussmap::fitting
