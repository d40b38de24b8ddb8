// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What several commands write into their JSON.
#pragma once

#include "trussmap/calibrate.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/held_out.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// null where it is not finite.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);
[[nodiscard]] nlohmann::ordered_json numbers_or_null(const std::vector<double>& values);

/// Name, channel and shape.
[[nodiscard]] nlohmann::ordered_json effect_json(const Effect& effect);
/// The same with the coefficient of a constant, and its standard error.
[[nodiscard]] nlohmann::ordered_json constant_json(const Effect& effect, double sd);
[[nodiscard]] nlohmann::ordered_json look_alikes_json(const std::vector<LookAlike>& look_alikes);
/// How many sightings were used, of how many.
[[nodiscard]] nlohmann::ordered_json sightings_json(const UsedSightings& sightings);
/// Arrival, stretch and orientation error; of held-out legs with their number.
[[nodiscard]] nlohmann::ordered_json metrics_json(const HeldOutMetrics& metrics);
[[nodiscard]] nlohmann::ordered_json held_out_json(const HeldOut& held_out);
/// Name, channel and shape with coefficients, standard errors and words.
[[nodiscard]] nlohmann::ordered_json estimate_json(const EffectEstimate& estimate);

/// Into a command's result, under `constants` and `stacks`.
void add_constants(const RobotConstants& constants, nlohmann::ordered_json& report);

}  // namespace trussmap::app
