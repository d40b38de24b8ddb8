// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Latitude and longitude (WGS 84) as metres to the east and to the north of a first one.
//
// Exact in the plane that touches the ellipsoid there; a kilometre away the ground is 8 cm below
// it, which shortens nothing by more than 5 micrometres.
#pragma once

#include "trussmap/planar.hpp"

namespace trussmap::logs {

class TangentPlane {
 public:
  /// deg, deg, m above the ellipsoid.
  TangentPlane(double latitude, double longitude, double height);

  /// x to the east, y to the north, m.
  [[nodiscard]] Vector2 position(double latitude, double longitude, double height) const;

 private:
  double origin_[3];  ///< m, earth-centred
  double east_[3];
  double north_[3];
};

}  // namespace trussmap::logs
