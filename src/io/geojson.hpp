// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// GeoJSON (RFC 7946) of places and ways, in metres of the map frame.
#pragma once

#include "trussmap/planar.hpp"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace trussmap::io {

[[nodiscard]] inline nlohmann::json geojson_coordinates(const Vector2& place) {
  return {place.x(), place.y()};
}

[[nodiscard]] inline nlohmann::json geojson_point(const Vector2& place, nlohmann::json properties) {
  return {{"type", "Feature"},
          {"geometry", {{"type", "Point"}, {"coordinates", geojson_coordinates(place)}}},
          {"properties", std::move(properties)}};
}

[[nodiscard]] inline nlohmann::json geojson_line(const Vector2& from, const Vector2& to,
                                                 nlohmann::json properties) {
  return {{"type", "Feature"},
          {"geometry",
           {{"type", "LineString"},
            {"coordinates", {geojson_coordinates(from), geojson_coordinates(to)}}}},
          {"properties", std::move(properties)}};
}

/// A square with its sides along the axes.
[[nodiscard]] inline nlohmann::json geojson_square(const Vector2& centre, double side,
                                                   nlohmann::json properties) {
  const double half = 0.5 * side;
  nlohmann::json ring = nlohmann::json::array();
  // Anticlockwise, and closed: RFC 7946, 3.1.6.
  for (const Vector2& corner : {Vector2(-half, -half), Vector2(half, -half), Vector2(half, half),
                                Vector2(-half, half), Vector2(-half, -half)}) {
    ring.push_back(geojson_coordinates(centre + corner));
  }
  return {{"type", "Feature"},
          {"geometry", {{"type", "Polygon"}, {"coordinates", nlohmann::json::array({ring})}}},
          {"properties", std::move(properties)}};
}

/// A file's text.
[[nodiscard]] inline std::string geojson_text(const nlohmann::json& features) {
  return nlohmann::json{{"type", "FeatureCollection"}, {"features", features}}.dump(1) + "\n";
}

}  // namespace trussmap::io
