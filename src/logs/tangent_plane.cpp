// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/tangent_plane.hpp"

#include "geometry/units.hpp"

#include <array>
#include <cmath>

namespace trussmap::logs {
namespace {

constexpr double kRadius = 6378137.0;                // m, of the equator
constexpr double kFlattening = 1.0 / 298.257223563;  // NIMA TR8350.2

/// Earth-centred, earth-fixed, m.
std::array<double, 3> earth_centred(double latitude, double longitude, double height) {
  constexpr double kE2 = kFlattening * (2.0 - kFlattening);
  const double sin = std::sin(latitude * geometry::kDegree);
  const double cos = std::cos(latitude * geometry::kDegree);
  const double normal = kRadius / std::sqrt(1.0 - kE2 * sin * sin);
  return {(normal + height) * cos * std::cos(longitude * geometry::kDegree),
          (normal + height) * cos * std::sin(longitude * geometry::kDegree),
          ((1.0 - kE2) * normal + height) * sin};
}

}  // namespace

TangentPlane::TangentPlane(double latitude, double longitude, double height) {
  const std::array<double, 3> origin = earth_centred(latitude, longitude, height);
  const double lat = latitude * geometry::kDegree;
  const double lon = longitude * geometry::kDegree;
  const std::array<double, 3> east{-std::sin(lon), std::cos(lon), 0.0};
  const std::array<double, 3> north{-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon),
                                    std::cos(lat)};
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = origin[k];
    east_[k] = east[k];
    north_[k] = north[k];
  }
}

Vector2 TangentPlane::position(double latitude, double longitude, double height) const {
  const std::array<double, 3> at = earth_centred(latitude, longitude, height);
  Vector2 result = Vector2::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    result.x() += east_[k] * (at[k] - origin_[k]);
    result.y() += north_[k] * (at[k] - origin_[k]);
  }
  return result;
}

}  // namespace trussmap::logs
