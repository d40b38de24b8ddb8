// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What rows of a recording measure; their nodes and their place in the recording are still open.
#pragma once

#include "estimation/recording_problem.hpp"

#include <optional>

namespace trussmap {

[[nodiscard]] Measurement measured_by(const Sighting& sighting, const Noise& noise);
/// By the sighting's yaw, if it has one.
[[nodiscard]] std::optional<Measurement> yaw_measured(const Sighting& sighting, const Noise& noise);
[[nodiscard]] Measurement measured_by(const TruthRow& row, const Noise& noise);
[[nodiscard]] Measurement measured_by(const Fix& fix, const Noise& noise);
[[nodiscard]] Measurement measured_by(const Loop& loop, const Noise& noise);
[[nodiscard]] Measurement measured_by(const SurveyPoint& point, const Noise& noise);
[[nodiscard]] Measurement heading_measured(const SurveyPoint& point, const Noise& noise);

}  // namespace trussmap
