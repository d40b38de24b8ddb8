// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One session, laid down pose by pose (pose_reckoner.hpp).
#pragma once

#include "estimation/pose_reckoner.hpp"
#include "estimation/recording_start.hpp"
#include "trussmap/planar.hpp"

#include <vector>

namespace trussmap::estimation {

/// What is to be laid down, with a session's measurements by the poses that they belong to. Keeps
/// references to problem and border.
struct SessionToLay {
  SessionToLay(const RecordingProblem& session, const EffectParameters& effects,
               const StartOptions& start = {});

  const RecordingProblem& problem;
  const EffectParameters& border;
  StartOptions options;
  std::vector<const Measurement*> drive_from;            ///< what leads on; nullptr: nothing
  std::vector<std::vector<const Measurement*>> seen_at;  ///< all else

  [[nodiscard]] int pose_count() const { return static_cast<int>(problem.poses.size()); }
};

/// How a session lies so far.
struct LaidSession {
  PlacedLandmarks landmarks;
  KnownOrientations orientations;
  std::vector<Pose> poses;
  KnownCoefficients coefficients;
};

struct KnownPose {
  Pose pose;
  Matrix3 covariance = Matrix3::Zero();
};

[[nodiscard]] LaidSession nothing_laid(const RecordingProblem& session,
                                       const KnownCoefficients& coefficients);

/// At the origin, along the first compass reading less the turn up to there. Without a compass its
/// heading, too, is the frame's own.
[[nodiscard]] KnownPose start_of_frame(const SessionToLay& session);

/// Poses first ... last, of which the first is known that well. `correct`: by what they see.
[[nodiscard]] LaidSession lay_poses(const SessionToLay& session, LaidSession laid, int first,
                                    int last, const KnownPose& from, bool correct = true);

/// Poses before `first`, backwards, by the motions alone.
[[nodiscard]] LaidSession lay_backwards(const SessionToLay& session, LaidSession laid, int first);

/// Landmarks of which the first `count` poses have ranges or bearings alone: those that these tell,
/// or at last all that have some.
[[nodiscard]] LaidSession place_from_afar(const SessionToLay& session, LaidSession laid, int count,
                                          bool at_last);

[[nodiscard]] Pose moved_by(const Alignment& over, const Pose& pose);
/// All of it.
[[nodiscard]] LaidSession moved_by(const Alignment& over, LaidSession laid);

}  // namespace trussmap::estimation
