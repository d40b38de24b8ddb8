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
  const auto view = [](const std::optional<Mounting>& at) -> effects::ViewPattern {
    if (!at) return {};
    return {.ahead = at->x, .left = at->y, .heading = at->yaw};
  };
  switch (stream) {
    case RecordingStream::sightings:
      return view(mounted.sensor);
    case RecordingStream::truth:
      return view(mounted.tracked);
    case RecordingStream::fixes:
      return view(mounted.antenna);
    case RecordingStream::loops:
      return view(mounted.scanner);
    case RecordingStream::drive:
    case RecordingStream::survey:
      break;
  }
  return {};
}

}  // namespace trussmap::estimation
