// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// map.toml: which fields of a log are what in a recording. docs/logs.md has all keys.
//
//   [time] [[time]]          of messages: their own stamp, when they were recorded, or a field
//   [robot] [noise]          as in a model file
//   [odometry]               the wheels by an odometry's twist or pose, or
//   [wheels.NAME]            by a field each: left and right, or the columns of another drive
//   [heading] [yaw_rate]     compass and gyro
//   [covariates]             further columns
//   [[sightings]] [fixes]    landmarks by frames or messages; positions without heading
//   [truth] [survey]         what was measured independently
//   [rows]                   how long a row of drive.csv is
//
// Where several logs are read as one, `file` of each table says which one its fields are of.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::logs {

/// What of a message is its time.
struct TimeMap {
  enum class From { stamp, log, publish, field } from = From::stamp;
  std::string file;            ///< of which log; empty: of all that no other one names
  std::string field;           ///< below the message, of From::field
  double unit = 1.0;           ///< s
  bool calendar = false;       ///< a text like 2026-03-01 12:30:00.25 (UTC)
  std::string fraction;        ///< below the message: what is added to it; empty: nothing
  double fraction_unit = 1.0;  ///< s
  double clock = 0.0;          ///< s, added to its times
  std::size_t line = 0;
};

/// A field over time, and what makes SI of it: value = scale x field + offset.
struct SignalMap {
  enum class Kind {
    level,       ///< the quantity itself
    cumulative,  ///< its sum so far
    per_row,     ///< what was added since the message before
    rate         ///< per second, held since the message before
  };
  std::string file;   ///< the log that it is of; empty: the only one, or any bag
  std::string field;  ///< path with its topic
  /// Instead of a group of them: the paths of a quaternion's x, y, z and w, or of z and w.
  std::vector<std::string> quaternion_fields;
  Kind kind = Kind::level;
  double scale = 1.0;       ///< SI per unit of the field, with the sign
  double offset = 0.0;      ///< SI
  double wraps = 0.0;       ///< of a sum that begins again: after how much, in the field's unit
  double clock = 0.0;       ///< s, added to its times
  double on_change = 0.0;   ///< s: written only when it changes, in cycles so long
  bool quaternion = false;  ///< the field is a group x, y, z, w: its yaw
  std::size_t line = 0;     ///< of the map's file
};

/// A pose as fields of one message: paths with their topic.
struct PoseFields {
  std::string x, y;
  std::string heading;                  ///< or
  std::vector<std::string> quaternion;  ///< x, y, z and w, or z and w
  double unit = 1.0;                    ///< m
  double heading_unit = 1.0;            ///< rad, with the sign

  [[nodiscard]] bool empty() const { return x.empty(); }
};

/// Where the wheels' travels come from, if not from fields of their own.
struct OdometryMap {
  std::string file;
  std::string twist;            ///< path to velocities ahead and round
  std::string pose;             ///< path to poses that are the wheels' sum, or /tf:parent.child
  PoseFields fields;            ///< or such poses by their fields
  std::string modules;          ///< or path to a list of speeds and angles of wheels that steer
  std::vector<Vector2> places;  ///< m, of these: x ahead, y to the left
  std::string speed, turn_rate, sideways;  ///< or velocities by theirs; the last may be empty
  double speed_unit = 1.0;                 ///< m/s
  double turn_rate_unit = 1.0;             ///< rad/s, with the sign
  double clock = 0.0;
  bool compare = false;  ///< beside [wheels]: it drives nothing, but is compared with them
  std::size_t line = 0;
};

/// Sightings, by frames or by messages.
struct SightingMap {
  std::string file;
  std::string frames;  ///< names of child frames, * for anything: one that the robot's camera sees

  std::string topic;                ///< else: of messages; of a table empty
  std::string each;                 ///< path to a list with an element per landmark; empty: one
  std::string landmark;             ///< path to the name
  std::string name;                 ///< or the name
  std::string range, bearing, yaw;  ///< paths; none of the first two: it stands on the landmark
  std::string position;             ///< or a path to the landmark's pose as the sensor has it
  double range_unit = 1.0;          ///< m
  double bearing_unit = 1.0;        ///< rad, with the sign
  double yaw_unit = 1.0;            ///< rad, with the sign
  bool changes = false;             ///< only messages that differ from the one before

  std::string tf = "/tf";         ///< topic of the frames
  std::string prefix;             ///< put before names
  std::vector<std::string> none;  ///< names that mean that nothing is seen
  std::string base = "base_link";
  std::string sensor;  ///< frame of `position`; empty: the message's own, or the base
  char axis = 'x';     ///< whose direction in the plane is the landmark's
  bool with_yaw = true;
  double clock = 0.0;
  std::size_t line = 0;
};

struct FixMap {
  std::string file;
  std::string topic;                ///< of a table empty
  std::string x, y;                 ///< paths below the message; empty: as its type has it
  std::string latitude, longitude;  ///< deg
  std::string sd, quality;
  double unit = 1.0;     ///< m, of x, y
  double sd_unit = 1.0;  ///< m
  double clock = 0.0;
  std::size_t line = 0;
};

struct TruthMap {
  std::string file;
  std::string pose;   ///< path to a pose, or /tf:parent.child
  PoseFields fields;  ///< or its fields
  double clock = 0.0;
  std::size_t line = 0;
};

struct LogMap {
  std::filesystem::path file;
  std::vector<TimeMap> times;
  OdometryMap odometry;
  std::vector<std::pair<std::string, SignalMap>> wheels;
  std::optional<SignalMap> heading;
  std::optional<SignalMap> yaw_rate;
  std::vector<std::pair<std::string, SignalMap>> covariates;
  std::vector<SightingMap> sightings;
  std::optional<FixMap> fixes;
  std::optional<TruthMap> truth;
  std::vector<SurveyPoint> survey;
  double period = 0.0;                ///< s, of a row; 0: as the wheels come
  std::vector<std::size_t> to_state;  ///< lines that still ask for a figure
  Model model;
};

/// Whether a column of the drive is its steering angle.
[[nodiscard]] bool is_steering_column(const Robot& robot, const std::string& column);

/// Throws InputError with file and line: no TOML, an unknown key, a wrong type or unit, a constant
/// that is missing.
[[nodiscard]] LogMap read_log_map(const std::filesystem::path& file);
/// Of a text, `file` being its name; it may do without wheels. Throws as read_log_map does.
[[nodiscard]] LogMap parse_log_map(const std::string& text, const std::filesystem::path& file);

}  // namespace trussmap::logs
