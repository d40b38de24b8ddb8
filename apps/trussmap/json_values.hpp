// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What several commands write into their JSON.
#pragma once

#include "fit/model_fit.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// null where it is not finite.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);
[[nodiscard]] nlohmann::ordered_json numbers_or_null(const std::vector<double>& values);

/// Name, channel and shape.
[[nodiscard]] nlohmann::ordered_json effect_json(const Effect& effect);
/// The same with coefficients, standard errors and words.
[[nodiscard]] nlohmann::ordered_json estimate_json(const EffectEstimate& estimate);

}  // namespace trussmap::app
