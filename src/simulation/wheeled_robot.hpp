// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the simulated robot records on a motion that is given (trussmap/simulation.hpp).
#pragma once

#include "simulation/effect_gains.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::simulation {

/// What the robot records on this motion, without the survey. Throws std::invalid_argument on
/// noise that is negative or not finite, on a wheelbase or reach that is not positive, and on
/// effects that leave a range of 0 or less or a sighting outside the drive.
[[nodiscard]] Recording record(const TrueMotion& motion, const Mesh& mesh,
                               const WheeledRobot& robot, std::uint64_t seed,
                               const ChannelGains& gains = {});

/// Every landmark's position as surveyed with this standard deviation [m per coordinate].
[[nodiscard]] std::vector<SurveyPoint> survey(const Mesh& mesh, double sd, std::uint64_t seed);

/// The same by the robot's noise, of markers with headings.
[[nodiscard]] std::vector<SurveyPoint> survey(const Mesh& mesh, const WheeledRobot& robot,
                                              std::uint64_t seed);

}  // namespace trussmap::simulation
