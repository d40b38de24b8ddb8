// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map of a fit, as it is drawn: landmarks with what is unsure of them, and the robot's path.
#pragma once

#include "fit/model_fit.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct FittedLandmark {
  std::string name;
  Vector2 position = Vector2::Zero();    ///< m, map frame
  Matrix2 covariance = Matrix2::Zero();  ///< m^2
  std::optional<Vector2> survey;         ///< m, where surveyed
};

struct FittedMap {
  std::vector<FittedLandmark> landmarks;
  std::vector<std::vector<Vector2>> paths;  ///< m, one per session, thinned out
};

/// At most about `points` points of paths in all.
[[nodiscard]] FittedMap fitted_map(const ModelFit& fit, std::size_t points = 2000);

}  // namespace trussmap
