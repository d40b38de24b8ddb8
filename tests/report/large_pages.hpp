// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A comparison of any size, made up: for the size and speed of its page.
#pragma once

#include "trussmap/report/comparison_page.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace trussmap::testing {

/// So many legs, a fifth as many routes, a tenth as many landmarks.
inline Page large_comparison_page(int legs) {
  const int across = static_cast<int>(std::ceil(std::sqrt(legs / 10.0)));
  Comparison result;
  result.consistent = false;
  result.chi2 = 9.0 * legs;
  result.dof = legs;
  result.legs = static_cast<std::size_t>(legs);
  FittedMap map;
  const auto name = [](int k) { return "landmark " + std::to_string(k); };
  for (int k = 0; k < across * across; ++k) {
    FittedLandmark one;
    one.name = name(k);
    one.position = {5.0 * (k % across) + 0.1 * std::sin(k), 5.0 * (k / across) + 0.1 * std::cos(k)};
    one.covariance = 0.01 * Matrix2::Identity();
    map.landmarks.push_back(one);
    for (const int step : {1, across}) {
      if (k + step >= across * across || (step == 1 && k % across == across - 1)) continue;
      result.routes.push_back({name(k), name(k + step), 5, 20.0, 30.0 * std::sin(1.7 * k),
                               0.01 * std::sin(k), 0.02 * std::cos(k)});
    }
  }
  map.paths.push_back({});
  for (int k = 0; k < 2000; ++k) {
    map.paths.front().emplace_back(0.02 * k, 50.0 + 40.0 * std::sin(0.02 * k));
  }
  for (int k = 0; k < legs; ++k) {
    result.worst.push_back({name(k % 97), name(k % 89), 10.0 * k, 100.0 * (legs - k) / legs, 4,
                            0.02 * std::sin(k), 0.03 * std::cos(k)});
    LegPrediction leg;
    leg.arrival_error = {0.02 * std::sin(k), 0.02 * std::cos(0.7 * k)};
    if (k % 3 == 0) result.held_out.legs.push_back(leg);
  }
  result.held_out.arrival_rms = 0.02;
  result.sources = {{"wheels", 3.0, 0.1, 100.0}, {"compass", 1.0, 0.1, 100.0}};
  std::vector<TrendPicture> trends;
  for (const char* variable : {"heading", "speed", "turn_rate", "t", "distance", "payload_kg"}) {
    TrendPicture picture;
    picture.trend.kind = "stretch";
    picture.trend.against = variable;
    picture.response.channel = "travel";
    picture.response.variable = variable;
    for (int bin = 0; bin < 9; ++bin) {
      picture.response.bins.push_back({0.1 * bin, 0.1 * bin, 0.1 * bin + 0.1, 0.01 * bin, 0.003});
      picture.response.curve.emplace_back(0.1 * bin, 0.01 * bin);
    }
    result.trends.push_back(picture.trend);
    trends.push_back(picture);
  }
  return comparison_page(result, map, trends, "a large recording");
}

}  // namespace trussmap::testing
