// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects drawn as a riddle: one or two of the catalogue, of a size that the recording can show.
//
//   largest |g|   3 to 6 times what the catalogue calls detectable, more where there are fewer than
//                 60 legs; for a covariate the range of g, since a column like a temperature has an
//                 arbitrary zero
//   left out      what the recording cannot show at all: effects of sensors that the robot lacks,
//                 of events that do not happen; without a survey, those that a map may hide in its
//                 scale or its rotation; a second effect of the first one's channel
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::simulation {

/// draw_hidden_effects for a path that is laid already, without effects.
[[nodiscard]] std::vector<Effect> draw_hidden_effects(const TrueMotion& motion, const Mesh& mesh,
                                                      const WheeledRobot& robot, bool surveyed,
                                                      std::uint64_t seed);

}  // namespace trussmap::simulation
