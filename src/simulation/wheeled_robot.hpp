// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a robot with two driven wheels, a compass and an eye for landmarks records on its way.
//
//   v, w       speed [m/s] and turn rate [rad/s] of the axle's centre, constant within a row
//   B          distance of the wheels                                            m
//   v -+ wB/2  speed of the left and right wheel over the floor                  m/s
//   k          wheel noise: a row's travel d is recorded with variance k^2 |d|   m^(1/2)
//
// The compass is read at the end of each row and wrapped to (-pi, pi]. At every stop of the walk
// the robot sights the landmark it stands on, and with a range sensor some of the others in reach.
// Each kind of noise has a random stream of its own: leaving one sensor out, or its noise, changes
// nothing in the others, and a noise-free twin follows the same path (but see DrivingStyle).
//
// Physical effects (effect_gains.hpp) change what the sensors say of the true motion. A coefficient
// is exact: without noise, the same effect in a model explains the recording fully.
#pragma once

#include "simulation/effect_gains.hpp"
#include "simulation/true_motion.hpp"
#include "trussmap/recording.hpp"

#include <cstdint>
#include <vector>

namespace trussmap {

/// Standard deviations; the stop's distance from its landmark is part of the path
/// (DrivingStyle::standing).
struct SensorNoise {
  double left = 0.003;    ///< k of the left wheel, m^(1/2)
  double right = 0.003;   ///< m^(1/2)
  double compass = 0.02;  ///< rad per reading
  double range = 0.05;    ///< m
  double bearing = 0.02;  ///< rad
  double survey = 0.001;  ///< m per coordinate
};

struct WheeledRobot {
  double wheelbase = 0.34;  ///< m
  bool compass = true;
  bool range_sensor = false;
  double reach = 8.0;        ///< m, range sensor
  double recognition = 0.5;  ///< chance that a landmark in reach is recognised
  SensorNoise noise;
};

struct SimulatedDrive {
  Recording recording;
  TrueMotion motion;
};

/// What the robot records on this motion, without the survey. Throws std::invalid_argument on
/// noise that is negative or not finite, on a wheelbase or reach that is not positive, and on
/// effects that leave a range of 0 or less or a sighting outside the drive.
[[nodiscard]] Recording record(const TrueMotion& motion, const Mesh& mesh,
                               const WheeledRobot& robot, std::uint64_t seed,
                               const ChannelGains& gains = {});

/// Every landmark's position as surveyed with this standard deviation [m per coordinate].
[[nodiscard]] std::vector<SurveyPoint> survey(const Mesh& mesh, double sd, std::uint64_t seed);

/// Physical effects on a simulated drive; each with coefficients.
struct SimulatedEffects {
  std::vector<Effect> effects;
  Rates rates = Rates::as_recorded;
};

/// Lays the path, records it and adds the survey. Under a delay the robot rests before the first
/// and after the last sighting, so that they stay within the drive.
[[nodiscard]] SimulatedDrive simulate_drive(const Mesh& mesh, const std::vector<int>& walk,
                                            const DrivingStyle& style, const WheeledRobot& robot,
                                            std::uint64_t seed,
                                            const SimulatedEffects& effects = {});

}  // namespace trussmap
