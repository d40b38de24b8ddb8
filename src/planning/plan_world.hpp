// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a drive is planned, and what the robot records there without noise.
//
//   plan --simulate_plan--> noise-free recording --fit_recordings--> FitState --> DriveInformation
#pragma once

#include "planning/drive_information.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/test_path.hpp"

#include <string>
#include <vector>

namespace trussmap::planning {

/// A column of the recording that the driver sets, and what to.
struct LoadLevels {
  std::string name;
  std::vector<double> levels;
};

/// A column as it goes by itself: what it is from each time [s] on, the last value for ever.
struct ColumnInTime {
  std::string name;
  std::vector<double> from;
  std::vector<double> values;
};

struct PlanWorld {
  Mesh mesh;                            ///< names, places; those seen from afar among them
  std::vector<std::vector<int>> exits;  ///< per landmark, to where routes lead
  int start = 0;                        ///< landmark
  WheeledRobot robot;                   ///< its sensors; noise-free
  Model model;                          ///< noise as it is believed, no effects
  bool truth = false;                   ///< its poses are measured, once a second
  std::vector<double> speeds;           ///< m/s: slow, usual, limit
  std::vector<double> turn_rates;       ///< rad/s: slow, fast
  std::vector<LoadLevels> loads;
  std::vector<ColumnInTime> columns;  ///< that nobody sets: they go on as they were recorded
};

/// Landmarks and the routes between them.
struct RouteNetwork {
  std::vector<std::string> names;
  std::vector<Vector2> positions;
  std::vector<std::vector<int>> exits;  ///< per landmark, to where routes lead
};

/// Gives a world the start, as its first landmark, and the nearest others by routes, up to 30.
void lay_near(int start, const RouteNetwork& routes, PlanWorld& world);

/// What the robot records of the plan without noise; the survey has all landmarks, exactly.
[[nodiscard]] DrivenRecording planned_recording(const PlanWorld& world, const DrivePlan& plan);

/// A fit of it, at the truth.
[[nodiscard]] fitting::FitState planned_fit(const PlanWorld& world, const DrivePlan& plan);

}  // namespace trussmap::planning
