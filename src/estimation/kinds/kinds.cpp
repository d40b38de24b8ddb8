// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/kinds/kinds.hpp"

#include <array>

namespace trussmap::estimation::kinds {

std::span<const MeasurementKind* const> all() {
  static const std::array list{&segment,        &gyro,      &standing,     &view,
                               &cartesian_view, &direction, &sighting_yaw, &survey,
                               &survey_heading, &truth,     &fix,          &loop};
  return list;
}

}  // namespace trussmap::estimation::kinds
