// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/effect_correction.hpp"

#include "drive/row_variables.hpp"
#include "effects/corrected_recording.hpp"

namespace trussmap::odometry {
namespace {

Pose start_pose(const MotionRows& drive, const Model& model) {
  Pose pose;
  pose.heading = initial_heading(drive, drive.start(), model.robot, model.noise).heading.heading;
  return pose;
}

}  // namespace

std::vector<DrivenRecording> without_effects(const std::vector<DrivenRecording>& recordings,
                                             const Model& model) {
  std::vector<DrivenRecording> result;
  for (const DrivenRecording& recording : recordings) {
    const int session = static_cast<int>(result.size());
    DrivenRecording corrected = recording;
    for (int pass = 0; pass < 2; ++pass) {
      const std::vector<Pose> path = dead_reckoned_path(corrected.drive, model.robot, model.noise);
      corrected = effects::corrected_recording(
          recording, model,
          drive::row_variables(recording.drive, model.robot, start_pose(corrected.drive, model),
                               path, session),
          session);
    }
    result.push_back(std::move(corrected));
  }
  return result;
}

}  // namespace trussmap::odometry
