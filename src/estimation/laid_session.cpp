// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/laid_session.hpp"

#include "estimation/problem_part.hpp"

namespace trussmap::estimation {

SessionToLay::SessionToLay(const RecordingProblem& session, const EffectParameters& effects,
                           const StartOptions& start)
    : problem(session),
      border(effects),
      options(start),
      drive_from(session.poses.size()),
      seen_at(session.poses.size()) {
  for (const Measurement& one : session.measurements) {
    if (one.session < 0) continue;
    const std::size_t pose = idx(one.from - session.landmark_count());
    if (is_segment(one)) {
      drive_from[pose] = &one;
    } else if (!is_driven(one)) {
      seen_at[pose].push_back(&one);
    }
  }
}

LaidSession nothing_laid(const RecordingProblem& session, const KnownCoefficients& coefficients) {
  return {PlacedLandmarks(session.landmarks.size()), KnownOrientations(session.oriented.size()),
          std::vector<Pose>(session.poses.size()), coefficients};
}

KnownPose start_of_frame(const SessionToLay& session) {
  KnownPose start;
  start.covariance(2, 2) = has_compass(session.problem) ? 10.0 : 0.0;
  double turned = 0.0;
  for (const Measurement* drive : session.drive_from) {
    if (drive == nullptr) break;
    if (drive->rows == 4) {
      start.pose.heading = wrap_angle(drive->value[3] - turned);
      break;
    }
    turned += drive->value[2];
  }
  return start;
}

LaidSession lay_poses(const SessionToLay& session, LaidSession laid, int first, int last,
                      const KnownPose& from, bool correct) {
  const StartOptions& options = session.options;
  PoseReckoner robot(session.problem, session.border, {options.map_sd, options.gate},
                     laid.landmarks, laid.orientations);
  robot.place(from.pose, from.covariance, laid.coefficients);
  for (int k = first; k <= last; ++k) {
    const Measurement* drive = session.drive_from[idx(k)];
    if (drive != nullptr) robot.read_compass(*drive);
    robot.look(session.seen_at[idx(k)], correct);
    laid.poses[idx(k)] = robot.pose();
    if (drive != nullptr && k < last) robot.drive(*drive);
  }
  laid.coefficients = robot.coefficients();
  return laid;
}

LaidSession lay_backwards(const SessionToLay& session, LaidSession laid, int first) {
  for (int k = first - 1; k >= 0; --k) {
    const Measurement& drive = *session.drive_from[idx(k)];
    const Pose motion{drive.value[0], drive.value[1], drive.value[2]};
    const Pose& pose = laid.poses[idx(k)] = compose(laid.poses[idx(k + 1)], inverse(motion));
    for (const Measurement* one : session.seen_at[idx(k)]) {
      if (!locates(*one) || laid.landmarks[idx(one->to)]) continue;
      laid.landmarks[idx(one->to)] = one->kind->seen_from(*one, pose, one->mounted);
    }
  }
  return laid;
}

Pose moved_by(const Alignment& over, const Pose& pose) {
  const Vector2 place = over.apply(pose.position());
  return {place.x(), place.y(), pose.heading + over.angle};
}

LaidSession moved_by(const Alignment& over, LaidSession laid) {
  for (std::optional<Vector2>& landmark : laid.landmarks) {
    if (landmark) landmark = over.apply(*landmark);
  }
  for (std::optional<double>& orientation : laid.orientations) {
    if (orientation) orientation = wrap_angle(*orientation + over.angle);
  }
  for (Pose& pose : laid.poses) pose = moved_by(over, pose);
  return laid;
}

}  // namespace trussmap::estimation
