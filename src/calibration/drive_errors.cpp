// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/reckoning.hpp"
#include "calibration/reference_alignment.hpp"
#include "calibration/sensor_places.hpp"
#include "odometry/effect_correction.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
using namespace calibration;

double rms_end(const std::vector<DriveError>& errors) {
  double sum = 0.0;
  for (const DriveError& one : errors) sum += one.end * one.end;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

double rms_heading_per_metre(const std::vector<DriveError>& errors) {
  double sum = 0.0;
  for (const DriveError& one : errors) sum += one.heading_per_metre() * one.heading_per_metre();
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

namespace {

/// m, of a row's wheels, each counted forwards.
double mean_travel(const MotionRows& drive, std::size_t row, const Robot& robot) {
  if (drive.wheels.empty()) return drive::mean_travel(drive.motion(row), robot);
  double sum = 0.0;
  int count = 0;
  for (const WheelColumn& wheel : drive.wheels) {
    if (wheel.steers) continue;
    sum += std::abs(wheel.reading[row]);
    ++count;
  }
  return sum / std::max(count, 1);
}

}  // namespace

namespace {

/// Of the axle's centre, of which the truth is here.
std::vector<DriveError> errors_of_axle(const std::vector<DrivenRecording>& recordings,
                                       const Model& model) {
  std::vector<DriveError> result;
  const std::vector<DrivenRecording> corrected = odometry::without_effects(recordings, model);
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const MotionRows& drive = corrected[k].drive;
    std::vector<TruthRow> truth = recordings[k].truth;
    std::erase_if(truth, [&](const TruthRow& row) {
      return row.t < drive.start() || row.t > drive.t.back();
    });
    if (truth.size() < 2) {
      throw InputError(recordings[k].name, 0,
                       "fewer than two truth rows within the drive, expected two at least");
    }
    const TruthRow& from = truth.front();
    const TruthRow& to = truth.back();
    const Pose end = reckoned(drive, pose_of(from), from.t, to.t);
    DriveError one;
    one.end = (end.position() - Vector2(to.x, to.y)).norm();
    one.heading = wrap_angle(end.heading - to.heading);
    // Metres as recorded, so that they are the same for every model.
    for (const odometry::DriveRow& row :
         odometry::rows_between(recordings[k].drive, from.t, to.t)) {
      one.driven += row.part * mean_travel(recordings[k].drive, row.row, model.robot);
    }
    result.push_back(one);
  }
  return result;
}

}  // namespace

std::vector<DriveError> drive_errors(const std::vector<DrivenRecording>& recordings,
                                     const Model& model) {
  const Mounting stated = with_places_in_robot(model).robot.mounted.tracked.value_or(Mounting());
  return drive_errors(recordings, model, TruthAlignment{stated.x, stated.y, stated.yaw, {}});
}

std::vector<DriveError> drive_errors(const std::vector<DrivenRecording>& recordings,
                                     const Model& model, const TruthAlignment& truth) {
  TruthAlignment mounting = truth;
  mounting.clocks.clear();
  return errors_of_axle(aligned(recordings, mounting), with_places_in_robot(model));
}

}  // namespace trussmap
