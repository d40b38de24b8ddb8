// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/body_motion.hpp"
#include "logs/byte_reader.hpp"
#include "logs/calendar.hpp"
#include "logs/gathered_log.hpp"
#include "logs/seen_landmarks.hpp"
#include "logs/sensor_frames.hpp"
#include "logs/source_agreement.hpp"
#include "logs/tangent_plane.hpp"
#include "logs/untied_drive.hpp"
#include "logs/wheel_rows.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/robot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

namespace trussmap {
using namespace logs;

namespace {

namespace fs = std::filesystem;

/// Times of a recording: from a whole second on where they are those of a calendar.
class Clock {
 public:
  explicit Clock(std::int64_t first) {
    constexpr std::int64_t kDays =
        1000000 * kNanosecondsPerSecond;  // no robot runs longer without a restart
    if (std::abs(first) > kDays) epoch_ = first / kNanosecondsPerSecond * kNanosecondsPerSecond;
  }
  /// s; the nearest number to the decimal one.
  [[nodiscard]] double seconds(std::int64_t t) const {
    return static_cast<double>(t - epoch_) / static_cast<double>(kNanosecondsPerSecond);
  }
  [[nodiscard]] std::string text() const {
    return epoch_ == 0
               ? "t is the log's own time"
               : fmt::format("t = 0 is {} s of the log's time", epoch_ / kNanosecondsPerSecond);
  }

 private:
  std::int64_t epoch_ = 0;
};

double wrapped(double angle) {
  return std::abs(angle) <= std::numbers::pi ? angle : wrap_angle(angle);
}

void add_heading(Signal& heading, const std::vector<std::int64_t>& bounds, Drive& drive) {
  for (std::size_t k = 1; k < bounds.size(); ++k) {
    const bool read = heading.has_sample(bounds[k - 1], bounds[k]) &&
                      bounds[k] <= heading.times().back() && bounds[k] >= heading.times().front();
    drive.heading.push_back(read ? wrapped(heading.level(bounds[k])) : kAbsent);
  }
}

void add_yaw_rate(Signal& rate, const std::vector<std::int64_t>& bounds, Drive& drive) {
  const auto gap = static_cast<std::int64_t>(10.0 * rate.typical_step() * kNanosecondsPerSecond);
  for (std::size_t k = 1; k < bounds.size(); ++k) {
    const std::int64_t from = bounds[k - 1];
    const std::int64_t to = bounds[k];
    const bool read = from >= rate.times().front() && to <= rate.times().back() &&
                      rate.has_sample(from - gap, to);
    const double dt = static_cast<double>(to - from) / static_cast<double>(kNanosecondsPerSecond);
    drive.yaw_rate.push_back(read ? rate.sum(from, to) / dt : kAbsent);
  }
}

bool any_read(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double one) { return one == one; });
}

void add_fixes(const GatheredLog& log, const Clock& clock, Recording& recording,
               std::size_t& outside) {
  std::vector<TangentPlane> plane;
  std::vector<SeenFix> fixes = log.fixes;
  std::stable_sort(fixes.begin(), fixes.end(),
                   [](const SeenFix& a, const SeenFix& b) { return a.t < b.t; });
  const double start = recording.drive.start();
  for (const SeenFix& one : fixes) {
    Fix fix{clock.seconds(one.t), one.x, one.y, one.sd, one.quality};
    if (one.geodetic) {
      if (plane.empty()) plane.emplace_back(one.y, one.x, one.height);
      // The height of the first: a receiver's own moves by metres.
      const Vector2 at = plane.front().position(one.y, one.x, fixes.front().height);
      fix.x = at.x();
      fix.y = at.y();
    }
    if (!(fix.sd > 0.0)) fix.sd = kAbsent;
    if (!recording.fixes.empty() && recording.fixes.back().t == fix.t) {
      recording.fixes.back() = fix;  // of two at a time the later in the log
      continue;
    }
    if (fix.t < start || fix.t > recording.drive.t.back()) {
      ++outside;
    } else {
      recording.fixes.push_back(fix);
    }
  }
}

/// Poses of the truth, by messages or along frames.
std::vector<TimedFieldPose> truth_of(const LogMap& map, const GatheredLog& log) {
  if (!map.truth) return {};
  std::vector<TimedFieldPose> truth = log.truth;
  if (is_frame_path(map.truth->pose)) {
    truth = poses_along(map.truth->pose, log.frames, map, map.truth->line, map.truth->clock);
  }
  std::stable_sort(truth.begin(), truth.end(),
                   [](const TimedFieldPose& a, const TimedFieldPose& b) { return a.t < b.t; });
  const auto twin = [](const TimedFieldPose& a, const TimedFieldPose& b) { return a.t == b.t; };
  truth.erase(std::unique(truth.begin(), truth.end(), twin), truth.end());
  return truth;
}

void count(std::size_t number, const char* what, LogRecording& result) {
  if (number > 0) result.counts.push_back({number, what});
}

void warn_of_clock(const LogMap& map, const GatheredLog& log, LogRecording& result) {
  if (!log.end.cut_off.empty()) {
    result.warnings.push_back("the log is cut off " + log.end.cut_off + "; what is before is read");
  }
  for (const std::size_t line : map.to_state) {
    result.warnings.push_back(fmt::format(
        "{}:{}: the figure is a guess still (STATE IT); take the mark away once it is right",
        map.file.string(), line));
  }
  if (map.model.robot.drive == DriveKind::differential && !map.model.robot.wheelbase_stated) {
    result.warnings.push_back(fmt::format("[robot] of {} states no wheelbase: {} m is taken",
                                          map.file.string(), map.model.robot.wheelbase));
  }
}

/// How many times as much as the wheels a sensor turns, by least squares over the rows; none where
/// the wheels hardly turn.
std::optional<double> turns_as(const Drive& drive, double wheelbase,
                               const std::function<double(std::size_t)>& turn) {
  double both = 0.0;
  double wheels = 0.0;
  double all = 0.0;
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    const double seen = turn(row);
    if (seen != seen) continue;
    const double turned = (drive.right[row] - drive.left[row]) / wheelbase;
    both += seen * turned;
    wheels += turned * turned;
    all += std::abs(turned);
  }
  constexpr double kEnough = 1.0;  // rad
  if (!(all > kEnough) || !(wheels > 0.0)) return std::nullopt;
  return both / wheels;
}

/// Units and signs are the map's to state: what they cannot be is said here, before anything is
/// fitted.
void warn_of_turns(const Drive& drive, double wheelbase, LogRecording& result) {
  if (drive.left.empty()) return;
  constexpr double kMost = 3.0;  // times: no effect of a robot does that
  const auto warn = [&](const char* sensor, const std::optional<double>& times) {
    if (!times || (*times > 1.0 / kMost && *times < kMost)) return;
    result.warnings.push_back(
        fmt::format("the {} turns {:.3g} times as much as the wheels: a unit, a sign or a constant "
                    "of the wheels "
                    "is wrong in the map, expected about 1",
                    sensor, *times));
  };
  if (drive.has_gyro()) {
    warn("gyro", turns_as(drive, wheelbase, [&](std::size_t row) {
           return drive.yaw_rate[row] * drive.duration(row);
         }));
  }
  if (drive.has_compass()) {
    warn("compass", turns_as(drive, wheelbase, [&](std::size_t row) {
           const double turn = drive.heading[row] - drive.heading[row - 1];
           return turn == turn ? wrap_angle(turn) : kAbsent;
         }));
  }
}

/// The wheels, whatever they are, beside an odometry that the map has as well.
void compare_wheels(const LogMap& map, const GatheredLog& gathered,
                    const std::vector<std::int64_t>& bounds, const Drive& drive,
                    LogRecording& result) {
  const OdometryRows odometry = odometry_rows(map, gathered, bounds);
  if (odometry.left.empty()) return;
  Recording alone;
  alone.drive = drive;
  MotionRows wheels;
  try {
    wheels = with_wheels(std::move(alone), map.model.robot).drive;
  } catch (const InputError&) {  // a reading that no wheel can have, which check names
    return;
  }
  const Robot& robot = map.model.robot;
  const auto first = std::find(bounds.begin(), bounds.end(), odometry.bounds.front());
  const auto before = static_cast<std::size_t>(first - bounds.begin());
  constexpr std::int64_t kWindow = kNanosecondsPerSecond;
  MotionAgreement agreement;
  PlanarStep a;
  PlanarStep b;
  std::int64_t begin = odometry.bounds.front();
  for (std::size_t k = 0; k < odometry.left.size(); ++k) {
    const BodyMotion by_wheels = wheels.motion(before + k);
    const BodyMotion said =
        drive::body_motion({odometry.left[k], odometry.right[k]}, robot.wheelbase);
    a += {by_wheels.forward, 0.0, by_wheels.turn};
    b += {said.forward, 0.0, said.turn};
    if (odometry.bounds[k + 1] - begin < kWindow) continue;
    agreement.add_window(a, b);
    a = b = {};
    begin = odometry.bounds[k + 1];
  }
  for (std::string& one :
       agreement.contradictions("what the wheels say",
                                "the odometry (line " + std::to_string(map.odometry.line) + ")")) {
    result.warnings.push_back(std::move(one));
  }
}

/// What an odometry says twice, and what it and wheels say.
void warn_of_odometry(const LogMap& map, const GatheredLog& gathered,
                      const std::vector<std::int64_t>& bounds, const Drive& drive,
                      LogRecording& result) {
  if (map.odometry.line == 0) return;
  const std::string& path = map.odometry.twist.empty() ? map.odometry.pose : map.odometry.twist;
  for (std::string& one : gathered.beside.contradictions(path)) {
    result.warnings.push_back(std::move(one));
  }
  if (!map.wheels.empty()) compare_wheels(map, gathered, bounds, drive, result);
}

void warn_of_far_fixes(const Recording& recording, LogRecording& result) {
  constexpr double kFar = 1e5;  // m
  for (const Fix& one : recording.fixes) {
    const Fix& first = recording.fixes.front();
    const double away = std::hypot(one.x - first.x, one.y - first.y);
    if (away < kFar) continue;
    result.warnings.push_back(
        fmt::format("fixes are up to {:.0f} km apart or more: the first or "
                    "others are wrong",
                    away / 1000.0));
    return;
  }
}

}  // namespace

bool is_log(const fs::path& path) {
  return is_message_log(path);
}

namespace {

void add_readings(GatheredLog& gathered, const std::vector<std::int64_t>& bounds, Drive& drive) {
  for (Signal& one : gathered.heading) {
    one.finish();
    if (!one.empty()) add_heading(one, bounds, drive);
  }
  for (Signal& one : gathered.yaw_rate) {
    one.finish();
    if (!one.empty()) add_yaw_rate(one, bounds, drive);
  }
  if (!any_read(drive.heading)) drive.heading.clear();
  if (!any_read(drive.yaw_rate)) drive.yaw_rate.clear();
}

void add_covariates(const LogMap& map, GatheredLog& gathered,
                    const std::vector<std::int64_t>& bounds, Drive& drive) {
  for (auto& [name, signal] : gathered.covariates) {
    signal.finish();
    if (signal.empty()) {
      const std::string& key = name;
      const auto line = std::find_if(map.covariates.begin(), map.covariates.end(),
                                     [&key](const auto& one) { return one.first == key; });
      throw InputError(map.file.string(), line->second.line,
                       "covariate " + name + " has no value in the log, expected one or more");
    }
    Covariate& covariate = drive.covariates.emplace_back(Covariate{name, {}});
    for (std::size_t k = 1; k < bounds.size(); ++k) {
      covariate.values.push_back(signal.held(bounds[k]));
    }
  }
}

SightingCounts add_sightings(const LogMap& map, const GatheredLog& gathered, const Clock& clock,
                             Recording& recording) {
  SightingCounts seen;
  for (SeenSighting& one : seen_sightings(map, gathered, seen)) {
    one.sighting.t = clock.seconds(one.t);
    if (one.sighting.t < recording.drive.start() || one.sighting.t > recording.drive.t.back()) {
      ++seen.outside;
    } else {
      recording.sightings.push_back(std::move(one.sighting));
    }
  }
  return seen;
}

void count_rows(const Recording& recording, LogRecording& result) {
  count(recording.drive.rows(), "drive rows", result);
  count(recording.sightings.size(), "sightings", result);
  count(recording.fixes.size(), "fixes", result);
  count(recording.truth.size(), "truth rows", result);
  count(recording.survey.size(), "surveyed landmarks", result);
}

void count_left_out(const WheelRows& rows, const GatheredLog& gathered, const SightingCounts& seen,
                    std::size_t outside_fixes, LogRecording& result) {
  count(rows.unordered, "messages of the wheels were out of order in time: sorted", result);
  count(rows.repeated, "messages of the wheels at the time of another: the later in the log counts",
        result);
  count(seen.outside, "sightings before or after the drive left out", result);
  count(seen.repeated, "sightings that are there twice, time and all, left out", result);
  count(seen.no_frame,
        "sightings without a way from their frame to the robot's at their time left "
        "out",
        result);
  count(gathered.unnamed, "sightings without a landmark's name left out", result);
  if (gathered.refused > 0) {
    result.counts.push_back({gathered.refused,
                             "messages whose field is no number, pose or velocity left out, the "
                             "first: " +
                                 in_a_line(gathered.first_refused)});
  }
  count(gathered.negative_ranges, "ranges below 0 left out", result);
  count(outside_fixes, "fixes before or after the drive left out", result);
  count(gathered.lost_fixes, "fixes that the receiver itself calls none left out", result);
  count(gathered.wrong_poses, "poses without a valid rotation left out", result);
  for (LogCount& one : counts_of(gathered.end.passed_over)) result.counts.push_back(std::move(one));
}

LogRecording recording_of(const std::vector<fs::path>& paths, const fs::path& map_file,
                          const LogOptions& options) {
  const LogMap map = read_log_map(map_file);
  const JoinedLogs logs(paths, given_definitions(options));
  GatheredLog gathered = gather(logs, map);
  LogRecording result;
  result.model = map.model;
  const MountedByFrames by_frames = mounted_by_frames(map, gathered);
  result.model.robot.mounted = by_frames.mounted;
  WheelRows rows = wheel_rows(map, gathered);
  const Clock clock(rows.bounds.front());
  result.epoch = clock.text();

  Recording& recording = result.recording;
  recording.name = logs.all_names();
  recording.survey = map.survey;
  Drive& drive = recording.drive;
  drive.left = std::move(rows.left);
  drive.right = std::move(rows.right);
  drive.covariates = std::move(rows.columns);
  for (std::size_t k = 1; k < rows.bounds.size(); ++k) {
    drive.t.push_back(clock.seconds(rows.bounds[k]));
  }
  add_readings(gathered, rows.bounds, drive);
  add_covariates(map, gathered, rows.bounds, drive);

  const SightingCounts seen = add_sightings(map, gathered, clock, recording);
  std::size_t outside_fixes = 0;
  add_fixes(gathered, clock, recording, outside_fixes);
  for (const TimedFieldPose& one : truth_of(map, gathered)) {
    recording.truth.push_back({clock.seconds(one.t), one.x, one.y, one.heading});
  }

  count_rows(recording, result);
  for (const std::string& one : by_frames.told) result.counts.push_back({1, one});
  count_left_out(rows, gathered, seen, outside_fixes, result);
  result.warnings = std::move(rows.warnings);
  warn_of_clock(map, gathered, result);
  warn_of_far_fixes(recording, result);
  warn_of_turns(drive, map.model.robot.wheelbase, result);
  warn_of_odometry(map, gathered, rows.bounds, drive, result);
  if (recording.sightings.empty() && recording.fixes.empty() && recording.truth.empty()) {
    for (std::string& one : untied_warnings(drive, map.model.robot)) {
      result.warnings.push_back(std::move(one));
    }
  }
  return result;
}

}  // namespace

LogRecording read_log_recording(const fs::path& log, const fs::path& map_file,
                                const LogOptions& options) {
  return read_log_recording(std::vector<fs::path>{log}, map_file, options);
}

LogRecording read_log_recording(const std::vector<fs::path>& logs, const fs::path& map_file,
                                const LogOptions& options) {
  try {
    return recording_of(logs, map_file, options);
  } catch (const InputError& error) {
    // Names of fields and frames are anybody's, line ends and all.
    const std::string text = error.what();
    const std::string prefix = InputError(error.file(), error.line(), "").what();
    if (!text.starts_with(prefix)) throw;
    throw InputError(error.file(), error.line(),
                     in_a_line(std::string_view(text).substr(prefix.size())));
  }
}

}  // namespace trussmap
