// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/legs.hpp"
#include "fit/row_at_hand.hpp"
#include "trussmap/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

/// Instants nearer to each other are one, s.
constexpr double kSameInstant = 1e-9;

/// Legs after an alarm, by which what it is has settled.
constexpr long kSettled = 50;

/// Where legs may end, in order of time.
struct PossibleEnd {
  double t = 0.0;
  MeasuredEnd measured;
  std::string landmark;
  double apart = 0.0;  ///< m of driven path from the end before, at least
};

/// The rows of a drive, or parts of them, one after the other.
class RowsAsRead {
 public:
  RowsAsRead(const MotionRows& drive, const Robot& robot, Monitor& monitor)
      : drive_(drive), robot_(robot), monitor_(monitor) {
    t_ = drive.start();
    for (const Covariate& one : drive.covariates) columns_.push_back(&one.values);
    covariates_.resize(columns_.size());
  }

  /// Drives up to this instant; a row that it falls into is cut there.
  void drive_to(double t) {
    while (row_ < drive_.rows() && t_ < t - kSameInstant) {
      const double end = drive_.t[row_];
      const double until = end <= t + kSameInstant ? end : t;
      drive_part(until, (until - t_) / drive_.duration(row_), until == end);
      t_ = until;
      if (until == end) ++row_;
    }
  }

 private:
  void drive_part(double until, double share, bool ends) {
    WheelRow row;
    row.duration = until - t_;
    if (ends && drive_.has_compass()) row.compass = drive_.heading[row_];
    if (drive_.has_gyro()) row.yaw_rate = drive_.yaw_rate[row_];
    if (drive_.of_two_wheels()) {
      row.left = share * drive_.pair.left[row_];
      row.right = share * drive_.pair.right[row_];
    } else if (!drive_.unicycle.empty()) {
      take_unicycle_part(share, row);
    }
    for (const WheelColumn& one : drive_.wheels) {
      row.readings.push_back(one.steers ? one.reading[row_] : share * one.reading[row_]);
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) covariates_[k] = (*columns_[k])[row_];
    monitor_.drive(row, covariates_);
  }

  void take_unicycle_part(double share, WheelRow& row) const {
    const BodyMotion body = drive_.wheel_motion(row_);
    row.readings.push_back(share * body.forward);
    if (fitting::turns_by_gyro(robot_)) {
      row.yaw_rate = body.turn / drive_.duration(row_);
    } else {
      row.readings.push_back(share * body.turn);
    }
  }

  const MotionRows& drive_;
  const Robot& robot_;
  Monitor& monitor_;
  std::vector<const std::vector<double>*> columns_;
  std::vector<double> covariates_;
  std::size_t row_ = 0;
  double t_ = 0.0;  ///< s, up to where it was driven
};

std::vector<PossibleEnd> possible_ends(const DrivenRecording& recording,
                                       const WatchOptions& options, int& passed_over) {
  std::vector<PossibleEnd> ends;
  for (const drive::Stop& stop : drive::stops_of(recording.sightings)) {
    PossibleEnd end{stop.t, {}, {}, options.min_drive};
    for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
      const Sighting& one = recording.sightings[k];
      if (!one.locates()) {
        ++passed_over;
        continue;
      }
      end.measured.sightings.push_back(one);
    }
    end.landmark = recording.sightings[stop.reference].landmark;
    if (!end.measured.sightings.empty()) ends.push_back(std::move(end));
  }
  const bool sighted = !ends.empty();
  for (const Fix& fix : recording.fixes) {
    PossibleEnd end{fix.t, {}, {}, options.leg};
    end.measured.fix = fix;
    ends.push_back(std::move(end));
  }
  for (const TruthRow& row : recording.truth) {
    if (sighted) break;  // the robot has not got it
    PossibleEnd end{row.t, {}, {}, options.leg};
    end.measured.pose = row;
    ends.push_back(std::move(end));
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const auto& a, const auto& b) { return a.t < b.t; });
  return ends;
}

}  // namespace

Watch watch(const DrivenRecording& recording, const Model& model, const WatchOptions& options) {
  const MotionRows& drive = recording.drive;
  Watch result;
  const std::vector<PossibleEnd> ends = possible_ends(recording, options, result.passed_over);
  if (drive.rows() == 0 || ends.empty()) {
    throw std::invalid_argument(
        "nothing ties the recording to a place, expected sightings, fixes or truth");
  }
  OdometryInputs inputs;
  for (const Covariate& one : drive.covariates) inputs.covariates.push_back(one.name);
  inputs.compass = drive.has_compass();
  inputs.gyro = drive.has_gyro() || fitting::turns_by_gyro(model.robot);
  Monitor monitor(model, inputs, options.monitor);
  for (const SurveyPoint& point : recording.survey) monitor.know(point);
  const std::vector<double> path = drive::driven_path(drive);
  RowsAsRead rows(drive, model.robot, monitor);
  double last = 0.0;  // m of driven path
  bool begun = false;
  for (const PossibleEnd& end : ends) {
    if (end.t < drive.start() - kSameInstant || end.t > drive.t.back() + kSameInstant) continue;
    const double driven = drive::path_at(drive, path, end.t);
    if (begun && driven - last < end.apart) continue;
    rows.drive_to(end.t);
    const MonitorReport report = monitor.arrive(end.measured);
    last = driven;
    begun = true;
    if (report.legs == 0) continue;  // where it starts
    result.legs.push_back({report.legs, end.t, end.landmark, report.evidence});
    if (report.alarm && !result.alarm) {
      result.alarm = report;
      result.alarm_t = end.t;
    }
    if (result.alarm && report.legs <= result.alarm->legs + kSettled) result.found = report.found;
  }
  result.last = monitor.report();
  if (result.found) {
    const long leg = result.found->leg;
    result.since_t = leg < 2 ? drive.start() : result.legs[static_cast<std::size_t>(leg - 2)].t;
  }
  return result;
}

}  // namespace trussmap
