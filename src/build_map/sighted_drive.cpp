// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/sighted_drive.hpp"

#include "geometry/index.hpp"

#include <cmath>

namespace trussmap {

LandmarkOffset SightedDrive::offset_of(const Sighting& sighting, double bearing_slack) const {
  Noise noise = model_.noise;
  if (bearing_slack > 0.0) noise.bearing = std::hypot(noise.bearing, bearing_slack);
  LandmarkOffset offset = landmark_offset(sighting, noise);
  offset.offset_robot += cleared_.sensor[idx(&sighting - recording().sightings.data())];
  return offset;
}

}  // namespace trussmap
