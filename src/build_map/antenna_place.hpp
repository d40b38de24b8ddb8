// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The antenna of fixes, where the model says nothing of it. Believed over the axle it pulls the
// path to one side in every turn, and then the sightings are what contradicts. So it is looked for
// by a map of the sightings alone, whose path p, theta knows nothing of the fixes f:
//
//   f = t + R(alpha) (p + R(theta) s)      linear in t, in (cos, sin) of alpha, and in R(alpha) s
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/robot.hpp"

#include <optional>
#include <vector>

namespace trussmap::map_building {

struct AntennaFound {
  Mounting place;
  double sd = 0.0;  ///< m, the larger one of its two coordinates
};

/// Nothing where the model states a place or an effect of it, where sightings or fixes are few, and
/// where the antenna may as well be over the axle. `how`: of the map's fit.
[[nodiscard]] std::optional<AntennaFound> antenna_by_sightings(
    const std::vector<DrivenRecording>& recordings, const Model& model, fitting::FitterOptions how);

}  // namespace trussmap::map_building
