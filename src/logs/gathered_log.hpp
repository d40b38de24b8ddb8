// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a map.toml asks of a log, gathered in one pass over its messages: streams as they came, each
// on its own clock, not yet rows of a recording.
#pragma once

#include "logs/frame_tree.hpp"
#include "logs/joined_logs.hpp"
#include "logs/log_map.hpp"
#include "logs/message_log.hpp"
#include "logs/pose_fields.hpp"
#include "logs/signal.hpp"
#include "logs/source_agreement.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::logs {

/// An odometry's message, or a pose.
struct TimedTwist {
  std::int64_t t = 0;  ///< ns
  FieldTwist twist;
};
struct TimedFieldPose {
  std::int64_t t = 0;    ///< ns
  double x = 0.0;        ///< m
  double y = 0.0;        ///< m
  double heading = 0.0;  ///< rad
};

/// A landmark in a message.
struct SeenLandmark {
  std::int64_t t = 0;  ///< ns
  const SightingMap* map = nullptr;
  std::string landmark;
  double range = kAbsent;    ///< m
  double bearing = kAbsent;  ///< rad
  double yaw = kAbsent;      ///< rad
  bool positioned = false;
  FieldPose pose;     ///< in `frame`, where it is positioned
  std::string frame;  ///< empty: the robot's base
};

/// A position, in metres or in degrees.
struct SeenFix {
  std::int64_t t = 0;   ///< ns
  double x = 0.0;       ///< m, or longitude
  double y = 0.0;       ///< m, or latitude
  double height = 0.0;  ///< m
  bool geodetic = false;
  double sd = kAbsent;  ///< m
  double quality = kAbsent;
};

struct GatheredLog {
  LogEnd end;
  std::vector<TimedTwist> twists;
  std::vector<TimedFieldPose> odometry;
  std::vector<std::pair<std::string, Signal>> wheels;
  std::vector<std::pair<std::string, Signal>> covariates;
  std::vector<Signal> heading;   ///< none or one
  std::vector<Signal> yaw_rate;  ///< none or one
  std::vector<SeenLandmark> seen;
  std::vector<SeenFix> fixes;
  std::string fix_frame;  ///< that their messages say they are of; empty: none
  std::vector<TimedFieldPose> truth;
  FrameTree frames;
  std::size_t wrong_poses = 0;  ///< poses and transforms whose quaternions are none
  std::size_t refused = 0;      ///< fields that are not what was expected: texts for numbers
  std::string first_refused;    ///< where the first of these is
  bool twists_move = false;     ///< of an odometry whose poses were asked for
  TwistBesidePose beside;       ///< of an odometry whose messages have both
  std::size_t negative_ranges = 0;
  std::size_t lost_fixes = 0;  ///< of a receiver that had no fix
  std::size_t unnamed = 0;     ///< sightings without a landmark's name
};

/// Throws InputError where a log is damaged, and with the map's line where it asks for what the
/// log does not have. The map must outlive the result.
[[nodiscard]] GatheredLog gather(const JoinedLogs& logs, const LogMap& map);

/// "/tf:map.base_link" as topic, parent and child; false where it is no such path.
struct FramePath {
  std::string topic, parent, child;
};
[[nodiscard]] bool is_frame_path(const std::string& path);
/// Frames may have dots in their names: of all ways to split, the one whose frames are known.
[[nodiscard]] FramePath frame_path(const std::string& path, const FrameTree& frames);

}  // namespace trussmap::logs
