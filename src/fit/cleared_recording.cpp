// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/cleared_recording.hpp"

#include "drive/body_motion.hpp"
#include "effects/steering.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/mounted_views.hpp"
#include "fit/effect_columns.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>

namespace trussmap::fitting {
namespace {

constexpr int kPasses = 2;

ClearedRecording as_recorded(const DrivenRecording& recording) {
  ClearedRecording result;
  result.recording = recording;
  result.sensor.assign(recording.sightings.size(), Vector2::Zero());
  return result;
}

void clear_drive(const DrivenRecording& recorded, const std::vector<effects::DrivePattern>& effects,
                 const Robot& robot, ClearedRecording& result) {
  const MotionRows& drive = recorded.drive;
  MotionRows& clear = result.recording.drive;
  clear.forward = drive.forward;
  clear.turn = drive.turn;
  clear.pair = drive.pair;
  clear.factors.reset();
  result.slip.assign(drive.rows(), 0.0);
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const effects::DrivePattern more = effects.empty() ? effects::DrivePattern() : effects[row];
    drive::add_motion(clear, row, {more.advance, 0.0, more.turn}, robot);
    result.slip[row] = more.slip;
    if (!drive.gyro.empty()) clear.gyro[row].excess = drive.gyro[row].excess + more.excess;
    if (drive.has_compass()) clear.heading[row] = drive.heading[row] - more.compass;
  }
  const bool slips =
      std::any_of(result.slip.begin(), result.slip.end(), [](double slip) { return slip != 0.0; });
  if (!slips) result.slip.clear();
}

void clear_sightings(const DrivenRecording& recorded, const estimation::EffectParameters& border,
                     const Eigen::VectorXd& offsets, int session, const Robot& robot,
                     ClearedRecording& result) {
  constexpr estimation::RecordingStream kStream = estimation::RecordingStream::sightings;
  const effects::ViewPattern mounted = estimation::mounted_view(robot.mounted, kStream);
  for (std::size_t k = 0; k < recorded.sightings.size(); ++k) {
    const effects::ViewPattern view =
        estimation::view_of(border, offsets, kStream, idx(session), k, mounted);
    const Sighting& seen = recorded.sightings[k];
    Sighting& clear = result.recording.sightings[k];
    result.sensor[k] = {view.ahead, view.left};
    clear.yaw = wrap_angle(seen.yaw - view.yaw + view.heading);
    if (seen.standing()) continue;
    // Noise may have left a range shorter than its offset.
    clear.range = std::max((seen.range - view.range) / (1.0 + view.range_scale), 0.0);
    clear.bearing = wrap_angle(seen.bearing - view.bearing + view.heading);
  }
}

void clear(const std::vector<DrivenRecording>& timed, const estimation::EffectParameters& border,
           const Eigen::VectorXd& offsets, const Robot& robot,
           std::vector<ClearedRecording>& result) {
  for (std::size_t s = 0; s < timed.size(); ++s) {
    clear_drive(timed[s], estimation::summed_patterns_of(border, offsets, s), robot, result[s]);
    clear_sightings(timed[s], border, offsets, static_cast<int>(s), robot, result[s]);
  }
}

}  // namespace

SessionPath reckoned_path(const ClearedRecording& one, const Model& model) {
  const MotionRows& drive = one.recording.drive;
  SessionPath path;
  path.start.heading =
      initial_heading(drive, drive.start(), model.robot, model.noise).heading.heading;
  path.ends = dead_reckoned_path(drive, model.robot, model.noise, one.slip);
  return path;
}

namespace {

std::vector<SessionPath> reckoned_paths(const std::vector<ClearedRecording>& recordings,
                                        const Model& model) {
  std::vector<SessionPath> paths;
  paths.reserve(recordings.size());
  for (const ClearedRecording& one : recordings) paths.push_back(reckoned_path(one, model));
  return paths;
}

}  // namespace

std::vector<ClearedRecording> cleared(const std::vector<DrivenRecording>& recorded,
                                      const Model& model) {
  std::vector<ClearedRecording> result;
  if (model.effects.empty()) {
    const estimation::EffectParameters none;
    for (const DrivenRecording& one : odometry::with_gyro(recorded, model.robot, model.noise)) {
      result.push_back(as_recorded(one));
      const int session = static_cast<int>(result.size()) - 1;
      clear_sightings(one, none, {}, session, model.robot, result.back());
    }
    return result;
  }
  std::vector<Effect> effects = model.effects;
  for (Effect& effect : effects) effect.coefficients = coefficients_of(effect, recorded.size());
  std::vector<DrivenRecording> timed;
  std::vector<SessionPath> paths;
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) paths = reckoned_paths(result, model);
    if (pass == 0 || effects::steers(effects)) {  // along the path
      timed = retimed(odometry::with_gyro(steered(recorded, effects, model.robot, paths),
                                          model.robot, model.noise),
                      effects, model.robot);
      result.clear();
      for (const DrivenRecording& recording : timed) result.push_back(as_recorded(recording));
    }
    if (pass == 0) paths = reckoned_paths(result, model);
    const ShapeContext context(timed, model.robot, paths);
    const EffectColumns columns = effect_columns(effects, context);
    Eigen::VectorXd offsets(static_cast<Eigen::Index>(columns.border.size()));
    for (std::size_t k = 0; k < columns.border.size(); ++k) {
      const Coefficient& one = columns.coefficients[k];
      offsets[static_cast<Eigen::Index>(k)] =
          effects[one.effect].coefficients[one.place] - columns.border[k].reference;
    }
    clear(timed, columns.border, offsets, model.robot, result);
  }
  for (std::size_t s = 0; s < timed.size(); ++s) {
    result[s].recording.truth = recorded[s].truth;
  }
  return result;
}

std::vector<ClearedRecording> cleared(const FitState& fit) {
  return cleared(fit, offsets_of(fit));
}

std::vector<ClearedRecording> cleared(const FitState& fit, const Eigen::VectorXd& offsets) {
  std::vector<ClearedRecording> result;
  for (const DrivenRecording& recording : fit.recordings) result.push_back(as_recorded(recording));
  clear(fit.recordings, fit.columns.border, offsets, fit.model.robot, result);
  return result;
}

}  // namespace trussmap::fitting
