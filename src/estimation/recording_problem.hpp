// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings as one least-squares problem: what is unknown, and what was measured of it.
//
//   unknown                                        node
//     landmark positions, shared by all sessions   0 ... landmarks - 1                2 each
//     robot poses at sightings, truth rows and     landmarks ... landmarks + poses - 1 3 each
//     fixes used, at both ends of loops, and at
//     changes between spinning and driving
//     orientations of landmarks with a yaw         after the poses                    1 each
//     coefficients of effects                      none: a dense border               1 each
//
// Measurements lie between nodes; each is of a kind (measurement_kind.hpp, kinds/). A segment's
// four numbers share the wheels' noise (segment_motion.hpp); all else is independent. What was
// driven before the first and after the last of what is measured carries nothing and is left out.
#pragma once

#include "estimation/measurement_kind.hpp"
#include "geometry/index.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <limits>
#include <string>
#include <vector>

namespace trussmap::estimation {

/// A scalar unknown of a noise process (noise_states.hpp): z = keep z_previous + N(0, sd^2).
struct NoiseState {
  int process = 0;    ///< of the model's noise
  int previous = -1;  ///< state; -1: none
  double keep = 0.0;
  double sd = 1.0;
};

/// What one unit of a state adds: to a segment's four numbers, or to the ViewPattern of a view.
struct NoiseTerm {
  int state = 0;
  effects::ViewVector by = effects::ViewVector::Zero();
};

/// A robot's pose that is unknown.
struct PoseNode {
  int session = 0;
  double t = 0.0;  ///< s
};

struct RecordingProblem {
  std::vector<std::string> landmarks;  ///< names, in order of first sighting
  std::vector<PoseNode> poses;         ///< session after session, in order of time
  std::vector<int> oriented;           ///< landmarks with an orientation
  std::vector<SegmentRows> segments;   ///< rows of each segment
  /// Per segment and row what an excess of the gyro counts (gyro_excess.hpp); empty: no gyro.
  std::vector<std::vector<Vector4>> gyro_weights;
  std::vector<Measurement> measurements;
  std::vector<std::string> sessions;  ///< names of the recordings
  std::vector<NoiseState> noise_states;
  /// Per measurement, or none at all where no noise lasts.
  std::vector<std::vector<NoiseTerm>> noise_terms;
  std::vector<Matrix4> within;  ///< covariance that lasting noise adds, given the states; likewise

  [[nodiscard]] int landmark_count() const { return static_cast<int>(landmarks.size()); }
  [[nodiscard]] int pose_end() const { return landmark_count() + static_cast<int>(poses.size()); }
  [[nodiscard]] int nodes() const { return pose_end() + static_cast<int>(oriented.size()); }
  [[nodiscard]] bool is_landmark(int node) const { return node < landmark_count(); }
  [[nodiscard]] bool is_orientation(int node) const { return node >= pose_end(); }
  /// The name of the landmark that has this orientation.
  [[nodiscard]] const std::string& landmark_of(int orientation_node) const {
    return landmarks[idx(oriented[idx(orientation_node - pose_end())])];
  }
  /// Of a landmark 2, of a pose 3, of an orientation 1.
  [[nodiscard]] int size_of(int node) const {
    return is_landmark(node) ? 2 : is_orientation(node) ? 1 : 3;
  }
  [[nodiscard]] int pose_node(int pose) const { return landmark_count() + pose; }
  /// Of a pose's node, s.
  [[nodiscard]] double time_of(int node) const { return poses[idx(node - landmark_count())].t; }
};

struct ProblemOptions {
  bool survey = true;        ///< use survey.csv
  bool truth = true;         ///< use truth.csv
  bool fixes = true;         ///< use fixes.csv
  bool loops = true;         ///< use loops.csv
  double truth_path = 0.25;  ///< m between truth rows used, or
  double truth_turn = 0.5;   ///< rad turned between them, whichever comes first
  /// Fixes that follow sooner and nearer than both are passed over, for their errors are hardly
  /// independent of those before: s, and m of driven path.
  double fix_gap = 0.0999;
  double fix_path = 0.25;
  double least_spin = 0.1;   ///< rad: a shorter spin is no change of motion
  double least_drive = 0.1;  ///< m: nor is a shorter drive
  /// Per session (or none at all): what is sighted or known there, and every drive between two such
  /// instants that is partly within, is left out. An instant that would stand alone goes with it.
  std::vector<std::vector<TimeSpan>> left_out = {};
};

/// Throws InputError where a recording has nothing in use that ties it to a place.
[[nodiscard]] RecordingProblem make_problem(const std::vector<DrivenRecording>& recordings,
                                            const Model& model, const ProblemOptions& options = {});

/// Values of all unknowns but the coefficients.
struct RecordingState {
  std::vector<Vector2> landmarks;         ///< m, map frame
  std::vector<Pose> poses;                ///< map frame; headings not wrapped
  Eigen::VectorXd noise = {};             ///< noise states; empty: all 0
  std::vector<double> orientations = {};  ///< rad, map frame, not wrapped; as `oriented`
};

/// Sighting, "landmark 12 at t = 3.5 s", and so on: a measurement in the user's words.
[[nodiscard]] std::string describe(const RecordingProblem& problem, const Measurement& measurement);

}  // namespace trussmap::estimation
