// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the stated places of a robot's sensors (Mountings) add to every view, as constant effects
// would: views of effects begin with them.
#pragma once

#include "effects/channel_physics.hpp"
#include "estimation/measurement_kind.hpp"
#include "trussmap/robot.hpp"

#include <optional>

namespace trussmap::estimation {

/// Nothing of the drive and of the survey.
[[nodiscard]] inline effects::ViewPattern mounted_view(const Mountings& mounted,
                                                       RecordingStream stream) {
  const std::optional<Mounting> none;
  const std::optional<Mounting>& at = stream == RecordingStream::sightings ? mounted.sensor
                                      : stream == RecordingStream::truth   ? mounted.tracked
                                      : stream == RecordingStream::fixes   ? mounted.antenna
                                      : stream == RecordingStream::loops   ? mounted.scanner
                                                                           : none;
  if (!at) return {};
  return {.ahead = at->x, .left = at->y, .heading = at->yaw};
}

}  // namespace trussmap::estimation
