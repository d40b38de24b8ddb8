// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// What a robot recorded: the wheels' travel, the compass, the landmarks it recognised, where a
// receiver had it, and what somebody measured independently. Plain data, exactly as in the CSV
// streams.
//
//   drive      one row per odometry interval, which ends at t            columns, one value a row
//   sightings  at time t the robot recognised a landmark
//   fixes      at time t a receiver (GNSS, UWB tag) had the robot's antenna there
//   loops      the pose at t2 as the robot measured it from its pose at t (scan matching)
//   survey     independently measured landmark positions
//   truth      independently measured robot poses
//
// Absent values are NaN: a compass or gyro reading, a range (the robot stands on the landmark), the
// sd of a survey point, a fix or a loop (the model's applies). Several recordings together are
// sessions of the same robot in the same place: landmarks of the same name are the same, poses are
// not.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace trussmap {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// Part of a recording's time.
struct TimeSpan {
  double from = 0.0;  ///< s
  double to = 0.0;    ///< s
};

struct Covariate {
  std::string name;            ///< a letter, then letters, digits, _
  std::vector<double> values;  ///< one per drive row, in the column's own unit
};

/// The columns of a drive beside its wheels'.
struct DriveColumns {
  std::vector<double> t;        ///< s, strictly increasing; end of the row's interval
  std::vector<double> heading;  ///< rad, compass reading at t, NaN = none; empty = no compass
  std::vector<Covariate> covariates;
  /// rad/s, gyro, mean over the interval, NaN = none; empty = no gyro.
  std::vector<double> yaw_rate;

  [[nodiscard]] std::size_t rows() const { return t.size(); }
  [[nodiscard]] bool has_compass() const { return !heading.empty(); }
  [[nodiscard]] bool has_gyro() const { return !yaw_rate.empty(); }
  /// Start of the first interval: it is as long as the second.
  [[nodiscard]] double start() const { return rows() > 1 ? t[0] - (t[1] - t[0]) : t[0]; }
  /// How long a row lasts, s.
  [[nodiscard]] double duration(std::size_t row) const {
    return t[row] - (row == 0 ? start() : t[row - 1]);
  }
};

/// As read. Columns of other wheels than a left and a right one are covariates; how they move a
/// body is a robot's affair (MotionRows, robot.hpp).
struct Drive : DriveColumns {
  std::vector<double> left;   ///< m, signed travel of the left wheel over the interval
  std::vector<double> right;  ///< m
};

struct Sighting {
  double t = 0.0;  ///< s
  std::string landmark;
  double range = kAbsent;    ///< m; NaN beside a bearing: a camera's
  double bearing = kAbsent;  ///< rad, from the robot's forward axis; NaN beside a range: a beacon's
  /// rad, the landmark's own axis less the robot's heading, of a tag or a floor code; else NaN.
  double yaw = kAbsent;
  /// m, where the robot is in the landmark's axes, beside `yaw` while it stands on it; NaN: 0.
  double dx = kAbsent;
  double dy = kAbsent;

  /// Neither: the robot stands on the landmark.
  [[nodiscard]] bool standing() const { return range != range && bearing != bearing; }
  /// Whether it says where the landmark is from the robot: a range or a bearing alone does not.
  [[nodiscard]] bool locates() const {
    return standing() || (range == range && bearing == bearing);
  }
};

/// A position without a heading.
struct Fix {
  double t = 0.0;       ///< s
  double x = 0.0;       ///< m, map frame
  double y = 0.0;       ///< m
  double sd = kAbsent;  ///< m per coordinate; NaN: the model's `fix`
  double quality =
      kAbsent;  ///< as the receiver gives it, in whatever unit; shown, never reckoned with
};

/// One pose of a drive as seen from another.
struct Loop {
  double t = 0.0;               ///< s
  double t2 = 0.0;              ///< s, before or after t
  double dx = 0.0;              ///< m ahead: where the axle's centre is at t2, in its axes at t
  double dy = 0.0;              ///< m to the left
  double dtheta = 0.0;          ///< rad, heading at t2 less heading at t; may be wrapped
  double sd = kAbsent;          ///< m per coordinate; NaN: the model's `loop`
  double sd_heading = kAbsent;  ///< rad; NaN: the model's `loop_heading`
};

struct SurveyPoint {
  std::string landmark;
  double x = 0.0;            ///< m
  double y = 0.0;            ///< m
  double sd = kAbsent;       ///< m per coordinate; NaN: the model's `survey`
  double heading = kAbsent;  ///< rad, of the landmark's own axis; NaN: not surveyed
};

struct TruthRow {
  double t = 0.0;        ///< s
  double x = 0.0;        ///< m
  double y = 0.0;        ///< m
  double heading = 0.0;  ///< rad
};

/// Shortest leg: two stops that are nearer to each other, m of driven path, end none.
inline constexpr double kDefaultMinDrive = 0.25;

/// What a robot saw, and what was measured of it, while it drove.
struct Observations {
  std::string name;                 ///< of the recording: where it came from, for messages
  std::vector<Sighting> sightings;  ///< in order of time
  std::vector<SurveyPoint> survey;
  std::vector<TruthRow> truth;  ///< in order of time
  std::vector<Fix> fixes;       ///< in order of time
  std::vector<Loop> loops;
};

/// As read. What takes a recording of a caller's own making (build_map, fit_model, calibrate_wheels
/// and what calls them) throws std::invalid_argument where its drive has fewer than two rows or
/// columns that differ in length, times leave their order, sightings the drive, or a number is not
/// finite that must be. Truth and fixes may begin before the drive and end after it.
struct Recording : Observations {
  Drive drive;
};

/// What shapes speak of: a column of numbers, one per row, per variable.
using RowVariables = std::map<std::string, std::vector<double>, std::less<>>;

}  // namespace trussmap
