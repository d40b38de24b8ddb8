// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::logs.
//
// Bags and logs of others: MCAP, rosbag2, bags of ROS 1, WPILib, Road Runner, any table; and bags
// out of poses and recordings. Link trussmap::logs for it.
//
//   log + map.toml --read_log_recording--> recording + model
//   log ------------inspect_log----------> what is in it, and a first map.toml
//   logs -----------inspect_logs---------> the same of several, and which clock is which
//
// docs/logs.md has the formats and the keys of map.toml.
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

// ----------------------------------------
// In.

/// Whether the path is a log that can be read: an .mcap, a .db3 or a rosbag2's folder, a .bag of
/// ROS 1, a .wpilog, a Road Runner .log, or a table (.csv, .tsv, .txt, also with .xz;
/// .mat of MATLAB).
[[nodiscard]] bool is_log(const std::filesystem::path& path);

struct LogOptions {
  /// Definitions of ROS 2 messages for bags that lack them: PACKAGE/NAME.msg, PACKAGE/msg/NAME.msg,
  /// or folders in which such files are. What a bag defines itself counts before them.
  std::vector<std::filesystem::path> definitions = {};
};

/// So many of something, for a list.
struct LogCount {
  std::size_t number = 0;
  std::string what;
};

struct LogRecording {
  Recording recording;
  Model model;                        ///< the map's [robot] and [noise]
  std::string epoch;                  ///< what t = 0 is
  std::vector<LogCount> counts;       ///< what came of the log, and what was left out
  std::vector<std::string> warnings;  ///< what is suspicious
};

/// Reads a log as its map.toml says. Throws InputError: the map's line where it is wrong or asks
/// for what the log does not have; the log's offset, or a table's line, where it is damaged.
[[nodiscard]] LogRecording read_log_recording(const std::filesystem::path& log,
                                              const std::filesystem::path& map,
                                              const LogOptions& options = {});
/// Of several logs that belong together: tables, or a bag and tables; of a folder all logs in it.
/// Each table of the map says by `file` which log its fields are of, and each [[time]] which one's
/// times. Throws InputError too where no log, or more than one, is called like a `file`.
[[nodiscard]] LogRecording read_log_recording(const std::vector<std::filesystem::path>& logs,
                                              const std::filesystem::path& map,
                                              const LogOptions& options = {});

/// A field of a log's topic, or a column of a table.
struct LogFieldFacts {
  std::string path;        ///< as map.toml names it
  std::size_t values = 0;  ///< messages that have it
  bool is_text = false;
  double least = kAbsent;  ///< of numbers
  double largest = kAbsent;
  double first = kAbsent;
  double last = kAbsent;
  std::string example;        ///< of texts, the first that is not empty
  std::size_t different = 0;  ///< values that differ from the one before
  double total_step = 0.0;    ///< sum of the sizes of all steps from one value to the next
  std::size_t decreases = 0;  ///< values that are smaller than the one before
  bool is_whole = true;       ///< only whole numbers
};

struct LogTopicFacts {
  std::string file;  ///< of which log, where several are inspected
  std::string name;
  std::string type;
  std::string unread;  ///< why its fields cannot be read; empty: they can
  std::uint64_t messages = 0;
  double first = kAbsent;  ///< s, in the log's own time
  double last = kAbsent;   ///< s
  double step = kAbsent;   ///< s between messages, median of the first thousands
  std::vector<LogFieldFacts> fields;
};

/// A transform of /tf or /tf_static.
struct LogFrameFacts {
  std::string parent;
  std::string child;
  bool is_static = false;
  std::size_t samples = 0;
};

/// The clock of one of several logs that are inspected together.
struct LogClockFacts {
  std::string file;        ///< the log
  double first = kAbsent;  ///< s, by its own clock; NaN: no times were found
  double last = kAbsent;
  double clock = 0.0;         ///< s, to be added to its times, as in the map
  double offset = kAbsent;    ///< s, the same as measured by motion that both have; NaN: none
  double sd = kAbsent;        ///< s, of the offset
  double likeness = kAbsent;  ///< correlation of the two motions at it
  double drift = 0.0;         ///< by how much the offset grows per s, where that is plain
  bool certain = true;        ///< false: nothing tells which clock it is; the map asks for it
  std::string why;            ///< in words
};

struct LogInspection {
  std::vector<LogTopicFacts> topics;
  std::vector<LogFrameFacts> frames;
  std::string cut_off;                     ///< where the log ends too soon; empty: it is whole
  std::string map;                         ///< a first map.toml, whose guesses are its comments
  std::vector<LogClockFacts> clocks = {};  ///< of several logs, one each; else none
  std::vector<LogCount> passed_over = {};  ///< records that belong to no topic
};

/// Throws InputError where the log is damaged.
[[nodiscard]] LogInspection inspect_log(const std::filesystem::path& log,
                                        const LogOptions& options = {});
/// The same of several that belong together (of a folder: all logs in it), with their clocks: that
/// of the wheels' log is the reference, and others are compared with it by turns, else by speeds. A
/// table of landmarks (landmark,x,y) is the map's survey.
[[nodiscard]] LogInspection inspect_logs(const std::vector<std::filesystem::path>& logs,
                                         const LogOptions& options = {});

// ----------------------------------------
// Bags of ROS 2 messages (MCAP, profile ros2) out of poses and recordings: for Foxglove,
// `ros2 bag play` and whatever reads bags. Written from the specifications; no ROS is needed.
//
// A message's time is t + epoch in whole nanoseconds: recorded, published and in its header. Frames
// are right-handed, x ahead, y to the left, z up. What a planar robot cannot know (z, roll, pitch
// and their rates) is 0, with a variance of 1e6 where the message has a place for one.

struct BagOptions {
  /// ns, Unix time of t = 0. Absent: 0, or the first whole second that leaves no time before 1970.
  std::optional<std::int64_t> epoch = {};
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string robot_frame = "base_link";
  double wheel_radius = 0.05;  ///< m: a wheel's angle is its travel over this
};

struct Bag {
  struct Topic {
    std::string name;
    std::string type;  ///< nav_msgs/msg/Odometry
    std::size_t messages = 0;
  };
  struct LeftOut {
    std::size_t count = 0;
    std::string what;  ///< in the plural: "loops"
  };

  std::string bytes;  ///< the file
  std::vector<Topic> topics;
  std::vector<LeftOut> left_out;  ///< what a bag has no message for
  std::int64_t epoch = 0;         ///< ns, as it was taken
  /// Of a recording's bag: the map.toml by which read_log_recording makes a recording of it again.
  std::string map;
};

/// Poses as /odometry/corrected (nav_msgs/Odometry): each with the covariance of x, y and heading,
/// and the mean velocity since the pose before, in the robot's axes, which the first has of the
/// second. Of velocities no covariance is known: 1e6. In the map's frame, or in that of the
/// odometry. Throws InputError where a time is none of ROS (1970 to 2038),
/// std::invalid_argument where there are no poses or times do not increase.
[[nodiscard]] Bag format_odometry_bag(const std::vector<TimedPose>& poses, bool in_map_frame,
                                      const BagOptions& options = {});

/// A recording, as its robot would have published it.
///
///   /joint_states     sensor_msgs/JointState: left_wheel, right_wheel, or the columns of another
///                     drive; position = travel so far/wheel_radius [rad], of a steering its angle;
///                     one at the drive's start, where wheels stand at 0, one at each row's end
///   /odom             nav_msgs/Odometry: dead reckoned by the model without its effects, with
///                     the covariance of its noise; the twist is the wheels', over the row
///   /imu/data         sensor_msgs/Imu: compass as orientation, gyro as angular velocity about z;
///                     covariance[0] = -1 of whichever a row has not
///   /tf               tf2_msgs/TFMessage: robot -> landmark, of sightings by range and bearing,
///                     turned by the yaw, 0 where none was read
///   /landmark         std_msgs/String: the name of the landmark that the robot stands on
///   /range/NAME       sensor_msgs/Range: ranges alone. NAME as ROS allows names; frame_id is the
///                     landmark's own name
///   /fix, /truth      geometry_msgs/PointStamped, PoseStamped: in the map's frame
///   /covariates/NAME  std_msgs/Float64: at each row's end
///
/// Bearings alone, loops, the survey and stated standard deviations have no place and are counted
/// in left_out; the survey stands in Bag::map. Ranges are single precision there. Throws InputError
/// where a time is none of ROS and where the recording has not the columns of the model's drive.
[[nodiscard]] Bag format_recording_bag(const Recording& recording, const Model& model,
                                       const BagOptions& options = {});

}  // namespace trussmap
