// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/sighted_drive.hpp"

namespace trussmap::map_building {

LandmarkOffset SightedDrive::offset_of(const Sighting& sighting) const {
  LandmarkOffset offset = landmark_offset(sighting, model_.noise);
  offset.offset_robot += cleared_.sensor[place_of(sighting)];
  return offset;
}

}  // namespace trussmap::map_building
