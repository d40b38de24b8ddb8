// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns that hold one number in every row, while the wheels say that it has to change: a sensor
// that hangs, a field that is always the message's default.
#include "check/findings.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::check {
namespace {

constexpr std::size_t kFewestReadings = 12;
constexpr double kSwing = 0.5;         // rad, within
constexpr double kLongestSwing = 5.0;  // s, or from one reading to the next
constexpr double kTurnedInAll = 2.0;   // rad, in such turns
constexpr double kMoved = 1.0;         // m
constexpr double kBroad = 0.5;         // m across the way, and
constexpr double kBroadShare = 0.2;    // of its length

/// One number, and how often; absent ones do not count.
class Constant {
 public:
  void add(double value, double t, const Pose& pose) {
    if (std::isnan(value)) return;
    if (count_ == 0) {
      first_ = value;
      low_ = high_ = pose.position();
      begin(t, pose);
    }
    same_ = same_ && value == first_;
    ++count_;
    low_ = low_.cwiseMin(pose.position());
    high_ = high_.cwiseMax(pose.position());
    const double turn = std::abs(pose.heading - heading_);
    if (turn > kSwing) turned_ += turn;
    if (turn > kSwing || t - begun_ > kLongestSwing) begin(t, pose);
  }
  [[nodiscard]] bool stuck() const { return same_ && count_ >= kFewestReadings; }
  [[nodiscard]] double value() const { return first_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double turned() const { return turned_; }               ///< rad, by the wheels
  [[nodiscard]] double moved() const { return (high_ - low_).norm(); }  ///< m

 private:
  void begin(double t, const Pose& pose) {
    begun_ = t;
    heading_ = pose.heading;
  }

  double first_ = 0.0;
  bool same_ = true;
  std::size_t count_ = 0;
  double begun_ = 0.0;
  double heading_ = 0.0;
  double turned_ = 0.0;  ///< in turns within a few seconds: no slow drift of the wheels
  Vector2 low_ = Vector2::Zero();
  Vector2 high_ = Vector2::Zero();
};

void add_stuck(Checked& checked, const char* file, const char* column, const std::string& value,
               const Constant& one, const std::string& meanwhile) {
  checked.add(file, column, "constant column",
              text::joined(value, " in all ", one.count(), " rows that have it, while ", meanwhile),
              "look where it comes from: a sensor that hangs, or a field that is never filled in");
}

std::string value_words(const char* column, const Constant& one) {
  return text::joined(column, " is ", text::shortest_text(one.value()));
}

std::string turning_words(const Constant& one) {
  return text::joined("the wheels turn the robot by ", figure(one.turned(), "rad"));
}

void check_turn(Checked& checked, const char* file, const char* column, const Constant& one) {
  if (one.stuck() && one.turned() > kTurnedInAll) {
    add_stuck(checked, file, column, value_words(column, one), one, turning_words(one));
  }
}

void check_drive_columns(Checked& checked, const Track& track) {
  const MotionRows& drive = checked.recording.drive;
  Constant heading;
  Constant yaw_rate;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (drive.has_compass()) heading.add(drive.heading[row], drive.t[row], track.at(drive.t[row]));
    if (drive.has_gyro()) yaw_rate.add(drive.yaw_rate[row], drive.t[row], track.at(drive.t[row]));
  }
  check_turn(checked, "drive.csv", "heading", heading);
  check_turn(checked, "drive.csv", "yaw_rate", yaw_rate);
}

/// Where the wheels lead on no straight line.
template <typename Rows>
bool goes_broadly(const Rows& rows, const Track& track) {
  Vector2 mean = Vector2::Zero();
  Matrix2 squares = Matrix2::Zero();
  double count = 0.0;
  for (const auto& one : rows) {
    const Vector2 at = track.at(one.t).position();
    count += 1.0;
    const Vector2 off = at - mean;
    mean += off / count;
    squares += off * (at - mean).transpose();
  }
  const double half = 0.5 * squares.trace() / count;
  const double apart =
      std::sqrt(std::max(0.0, half * half - squares.determinant() / (count * count)));
  const double across = std::sqrt(std::max(0.0, half - apart));
  return across > kBroad && across > kBroadShare * std::sqrt(half + apart);
}

template <typename Rows>
void check_places(Checked& checked, const char* file, const Rows& rows, const Track& track) {
  const MotionRows& drive = checked.recording.drive;
  Constant x;
  Constant y;
  for (const auto& one : rows) {
    if (one.t < drive.start() || one.t > drive.t.back()) continue;
    x.add(one.x, one.t, track.at(one.t));
    y.add(one.y, one.t, track.at(one.t));
  }
  if (!x.stuck() && !y.stuck()) return;
  const bool both = x.stuck() && y.stuck();
  if (x.moved() < kMoved || (!both && !goes_broadly(rows, track))) return;
  const std::string meanwhile = text::joined("the wheels lead the robot over ",
                                             figure(x.moved(), "m"), both ? "" : " all about");
  if (both) {
    add_stuck(checked, file, "x,y",
              text::joined("the place is (", text::shortest_text(x.value()), ", ",
                           text::shortest_text(y.value()), ")"),
              x, meanwhile);
  } else {
    const char* const column = x.stuck() ? "x" : "y";
    const Constant& one = x.stuck() ? x : y;
    add_stuck(checked, file, column, value_words(column, one), one, meanwhile);
  }
}

void check_sighting_columns(Checked& checked, const Track& track) {
  Constant range;
  Constant bearing;
  Constant yaw;
  std::set<std::string_view> seen;
  for (const Sighting& one : checked.recording.sightings) {
    const Pose pose = track.at(one.t);
    range.add(one.range, one.t, pose);
    bearing.add(one.bearing, one.t, pose);
    yaw.add(one.yaw, one.t, pose);
    if (!one.standing()) seen.insert(one.landmark);
  }
  if (range.stuck() && range.moved() > kMoved && seen.size() > 1) {
    add_stuck(checked, "sightings.csv", "range", value_words("range", range), range,
              text::joined("the wheels lead the robot over ", figure(range.moved(), "m")));
  }
  if (seen.size() > 1) check_turn(checked, "sightings.csv", "bearing", bearing);
  check_turn(checked, "sightings.csv", "yaw", yaw);
}

}  // namespace

void check_constant_columns(Checked& checked, const Track& track) {
  if (checked.wheels_wrong()) return;
  check_drive_columns(checked, track);
  check_sighting_columns(checked, track);
  check_places(checked, "fixes.csv", checked.recording.fixes, track);
  check_places(checked, "truth.csv", checked.recording.truth, track);
  const MotionRows& drive = checked.recording.drive;
  Constant heading;
  for (const TruthRow& one : checked.recording.truth) {
    if (one.t < drive.start() || one.t > drive.t.back()) continue;
    heading.add(one.heading, one.t, track.at(one.t));
  }
  check_turn(checked, "truth.csv", "heading", heading);
}

}  // namespace trussmap::check
