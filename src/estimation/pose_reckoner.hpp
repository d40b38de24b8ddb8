// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that is reckoned from pose to pose: an extended Kalman filter over its pose and the
// coefficients of effects, in the order (x, y, heading, coefficients).
//
//   drive           the segment's motion with the effects; what is not known of them adds to the
//                   pose's covariance, and ties pose and coefficients together
//   read_compass    the heading, and with it what the compass's effects must be
//   look            truth, fixes, landmarks that have a place and orientations that are known
//                   correct pose and coefficients; the others are placed
//
// Landmarks stand still: they are as certain as `map_sd` says.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

#include <optional>
#include <vector>

namespace trussmap::estimation {

/// Places so far, m; none for a landmark not yet sighted.
using PlacedLandmarks = std::vector<std::optional<Vector2>>;

/// Orientations so far, rad; none for one of which no yaw has been read.
using KnownOrientations = std::vector<std::optional<double>>;

/// Unknown coefficients, and how well they are known.
struct KnownCoefficients {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;
};

/// What is known of a border's unknown coefficients before any measurement: their priors.
[[nodiscard]] KnownCoefficients prior_of(const EffectParameters& border);

struct ReckonerOptions {
  double map_sd = 0.1;  ///< m per coordinate
  double gate = 0.0;    ///< squared standard deviations beyond which a sighting does not correct
};

class PoseReckoner {
 public:
  /// Keeps references to all but the options.
  PoseReckoner(const RecordingProblem& problem, const EffectParameters& border,
               const ReckonerOptions& options, PlacedLandmarks& landmarks,
               KnownOrientations& orientations)
      : problem_(problem),
        border_(border),
        options_(options),
        landmarks_(landmarks),
        orientations_(orientations) {}

  void place(const Pose& pose, const Matrix3& covariance, const KnownCoefficients& coefficients);
  [[nodiscard]] const Pose& pose() const { return pose_; }
  [[nodiscard]] KnownCoefficients coefficients() const;

  void read_compass(const Measurement& segment);
  void drive(const Measurement& segment);
  /// Corrects by truth, and by fixes and landmarks that have a place, if wanted; then places the
  /// others.
  void look(const std::vector<const Measurement*>& seen, bool correct);

 private:
  struct Motion {
    Vector4 value = Vector4::Zero();                                 ///< with the effects
    Eigen::Matrix<double, 4, Eigen::Dynamic> by_coefficients{4, 0};  ///< of the unknown ones
  };
  [[nodiscard]] Motion motion_of(const Measurement& segment) const;
  /// Whether what it sees has its place, or needs none.
  [[nodiscard]] bool is_known(const Measurement& one) const;
  void meet(const Measurement& one);
  void update(const Eigen::MatrixXd& H, const Eigen::VectorXd& innovation,
              const Eigen::MatrixXd& R);
  void doubt();

  const RecordingProblem& problem_;
  const EffectParameters& border_;
  ReckonerOptions options_;
  PlacedLandmarks& landmarks_;
  KnownOrientations& orientations_;
  Pose pose_;
  Eigen::VectorXd coefficients_;
  Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(3, 3);
};

}  // namespace trussmap::estimation
