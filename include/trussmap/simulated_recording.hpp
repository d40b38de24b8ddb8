// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// The recording of a simulated robot in one call: a mesh of landmarks, a robot of any drive that
// tours it, effects in its odometry, and the model that its owner believes in. simulation.hpp has
// the parts.
//
//   settings, effects --simulate--> recording, model without the effects, what really was
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// Lengths in m, angles in rad, times in s. Noise is given as standard deviations.
struct SimulationSettings {
  std::string mesh = "6x6";
  double spacing = 5.0;        ///< m, between neighbours
  bool uneven = false;         ///< gaps of 0.6 to 1.4 of that, landmarks a little off the lines
  std::string walk = "euler";  ///< as parse_walk_kind has them
  int tours = 3;
  std::uint64_t seed = 1;  ///< the same seed gives the same recording
  std::string drive = "differential";
  double wheelbase = 0.34;        ///< m
  double length = 0.0;            ///< m; 0: the drive's usual one
  double wheel_left = 0.0;        ///< m, of ackermann
  double steer_left = 0.0;        ///< m, of tricycle and ackermann
  double steer_noise = 0.005;     ///< rad m^1/2
  double wheel_noise = 0.003;     ///< m^1/2
  double compass_noise = 0.02;    ///< rad
  double sighting_noise = 0.005;  ///< m
  double survey_noise = 0.001;    ///< m
  std::string rough;              ///< kinds of noise that the model does not state; empty: none
  bool noise_free = false;        ///< the recording; the model still states its noise
  bool no_compass = false;
  bool gyro = false;
  bool no_survey = false;
  bool range_sensor = false;                 ///< landmarks in reach are seen by range and bearing,
  bool ranges_alone = false;                 ///< by ranges alone,
  bool bearings_alone = false;               ///< or by bearings alone
  bool rests = false;                        ///< at one stop in ten
  double gyro_noise = 0.0005;                ///< rad/s^1/2
  double gyro_walk = 0.0;                    ///< rad/s per s^1/2
  double reach = 8.0;                        ///< m
  double fix_rate = 0.0;                     ///< Hz; 0: no fixes
  double fix_noise = 0.05;                   ///< m
  double loop_noise = 0.05;                  ///< m
  double loop_heading_noise = 0.01;          ///< rad
  double yaw_noise = 0.02;                   ///< rad
  int full_turns = 0;                        ///< stops at which it turns round twice both ways
  std::vector<double> speeds = {0.25, 0.9};  ///< m/s, slowest and fastest
  std::vector<double> turn_rates = {0.3, 1.1};  ///< rad/s, likewise
  double ramp = 0.0;                            ///< s
  double overrun = -1.0;                        ///< m; negative: 0, or what a delay needs
  std::vector<std::string> covariates;          ///< further columns
  bool true_rates = false;  ///< effects follow the true rates, else the recorded ones
  bool hide = false;        ///< effects are drawn from the catalogue
  bool loops = false;
  bool markers = false;         ///< landmarks have an axis
  bool places_of_plan = false;  ///< the plan's own places are the landmarks, in place of the mesh
  double scan_every = 0.0;      ///< s: loops from scan to scan; 0: none
  Mountings mounted = {};       ///< where the sensors sit, as stated and in truth
  /// Driven in place of the tours, in the world of this seed and with its effects, by noise of its
  /// own: a further session. Without landmarks: of the mesh of these settings.
  std::optional<DrivePlan> plan = {};
};

/// A recording and what was simulated in it.
struct SimulatedRecording {
  Mesh mesh;
  SimulatedDrive drive;         ///< its recording, and the true motion
  std::vector<Effect> effects;  ///< that act: those given, or those drawn
  Model model;                  ///< without effects, with the noise as stated

  [[nodiscard]] double length() const;  ///< m that the robot really drove
};

/// `effects`: with their coefficients; none where they are to be hidden. Throws
/// std::invalid_argument on settings out of range or that contradict each other, and as
/// simulate_drive and draw_hidden_effects do.
[[nodiscard]] SimulatedRecording simulate(const SimulationSettings& settings,
                                          const std::vector<Effect>& effects = {});

/// The effect for simulate: with coefficients, those of one session. Throws std::invalid_argument,
/// naming it, where it has none.
[[nodiscard]] Effect simulated_effect(const Effect& effect);

/// The model that comes with the recording: its noise as stated, and no effect. A noise-free
/// recording keeps the noise in its model, since measurements are weighted by it.
[[nodiscard]] Model nominal_model(const SimulationSettings& settings);

/// The kinds of rough noise that are really in it. Throws std::invalid_argument where the settings
/// ask for noise of a compass that they leave out.
[[nodiscard]] RoughNoise rough_of(const SimulationSettings& settings);

/// An effect that acts, or that somebody says does, with both coefficients.
struct ScoredEffect {
  enum class Outcome { found, missed, false_alarm };
  Outcome outcome = Outcome::missed;
  std::optional<Effect> truth;     ///< none: a false alarm
  std::optional<Effect> estimate;  ///< none: missed
  std::vector<double> sd;          ///< of the estimate, one per coefficient; 0 or not finite: none
  /// (estimate - truth) / sd, one per coefficient; NaN where there is no sd. Where both are at
  /// different places, or have different thresholds, these have no part in it.
  std::vector<double> z;
};

struct AnswerScore {
  std::vector<ScoredEffect> effects;  ///< the true ones in their order, then false alarms
  int found = 0;
  int missed = 0;
  int false_alarms = 0;
};

/// What a model says, beside what really acts. Effects are the same where channel and shapes are,
/// or where both are one entry of the catalogue with other parameters (another place). An estimate
/// that is 0, or has no coefficients, says nothing. `sd`: as many lists as estimates, or none.
[[nodiscard]] AnswerScore score_answer(const std::vector<Effect>& truth,
                                       const std::vector<Effect>& estimate,
                                       const std::vector<std::vector<double>>& sd = {});

}  // namespace trussmap
