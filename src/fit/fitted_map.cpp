// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fitted_map.hpp"

#include <algorithm>

namespace trussmap {

FittedMap fitted_map(const ModelFit& fit, std::size_t points) {
  FittedMap map;
  for (std::size_t k = 0; k < fit.problem.landmarks.size(); ++k) {
    FittedLandmark one;
    one.name = fit.problem.landmarks[k];
    one.position = fit.adjustment.state.landmarks[k];
    one.covariance = fit.adjustment.landmark_covariances[k];
    for (const Recording& recording : fit.recordings) {
      for (const SurveyPoint& point : recording.survey) {
        if (point.landmark == one.name) one.survey = Vector2(point.x, point.y);
      }
    }
    map.landmarks.push_back(std::move(one));
  }
  std::size_t rows = 0;
  for (const SessionPath& path : fit.paths) rows += path.ends.size();
  const std::size_t step =
      std::max<std::size_t>(1, (rows + points - 1) / std::max<std::size_t>(points, 1));
  for (const SessionPath& path : fit.paths) {
    std::vector<Vector2> thinned{path.start.position()};
    for (std::size_t k = 0; k < path.ends.size(); ++k) {
      if (k % step == 0 || k + 1 == path.ends.size()) thinned.push_back(path.ends[k].position());
    }
    map.paths.push_back(std::move(thinned));
  }
  return map;
}

}  // namespace trussmap
