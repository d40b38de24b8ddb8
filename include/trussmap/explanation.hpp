// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects explained to a robot's owner: in whole sentences, and drawn. Each effect of the catalogue
// has a text and a drawing of its own; any other is explained by its channel and what it goes with.
#pragma once

#include "trussmap/model.hpp"

#include <string>

namespace trussmap {

struct Explanation {
  std::string does;   ///< what it does to the robot
  std::string look;   ///< what to look at on the robot
  std::string drive;  ///< what to drive to be sure
};
[[nodiscard]] Explanation explanation_of(const Effect& effect);

/// What an effect does to a robot, as SVG of 320 x 170: dashed as the robot believes it to be, blue
/// as it is, orange the cause. An effect that is not in the catalogue has the drawing of the
/// catalogue's plainest effect of its channel, or none (empty) where there is none. In a page its
/// colours are the page's.
[[nodiscard]] std::string effect_drawing(const Effect& effect);

/// Both, with cause and remedy, as JSON for the workbench's page.
[[nodiscard]] std::string explanation_json(const Effect& effect);

}  // namespace trussmap
