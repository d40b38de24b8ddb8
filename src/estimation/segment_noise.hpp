// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The noise of a segment, row by row, linearised where it is believed to be.
//
//   s_k, n_k   recorded step of row k (x, y, turn in the row's frame), and what it lacks: the true
//              step is s_k + n_k, n_k ~ N(0, Q_k), Q_k as trussmap/arc.hpp
//   h(n)       the segment's four numbers (segment_motion.hpp) of the steps s + n
//   z          the same numbers as the unknowns have them:  z = h(n) - (0, 0, 0, mean reading
//   error)
//
// Taken at n = 0, along the path as recorded, the linear model has a bias of second order: a wiggle
// in the record bends the chord away from the truth, and the tangent there overshoots when it is
// led back, by about as much as the wiggle had shortened the chord (0.01 ... 0.03 % of legs of 5 m,
// which 60 legs just show). Taken at the n that the fit believes,
//
//   z - v ~ N(0, C),   v = h(n) - H n,   C = H Q H' + readings,   n <- Q H' C^-1 (z - v)
//
// it is unbiased to second order: the Gauss-Helmert model of errors in the observations (Koch,
// "Parameter Estimation and Hypothesis Testing in Linear Models", 2nd ed. 1999).
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

#include <vector>

namespace trussmap::estimation {

struct SegmentNoise {
  Vector4 value = Vector4::Zero();             ///< v
  Vector4 recorded = Vector4::Zero();          ///< h(0)
  Matrix4 covariance = Matrix4::Zero();        ///< C; fourth row and column zero without readings
  std::vector<Eigen::Matrix<double, 4, 3>> H;  ///< per row
  std::vector<Matrix3> Q;                      ///< per row
};

/// `rows`: as effects move them; `missing` holds n_k per row, or nothing for n = 0. C never falls
/// below (10 micrometres)^2 and (10 microradians)^2, lest standing still be exact.
[[nodiscard]] SegmentNoise segment_noise(const MotionRows& drive,
                                         const std::vector<SegmentRow>& rows, const Robot& robot,
                                         const Noise& noise,
                                         const std::vector<Eigen::Vector3d>& missing);

/// The noise of a problem's k-th measurement, a segment, at the n that the state believes.
/// `effects`: what they do together to its session's rows.
[[nodiscard]] SegmentNoise believed_noise(const RecordingProblem& problem, std::size_t k,
                                          const std::vector<DrivenRecording>& recordings,
                                          const Model& model,
                                          const std::vector<effects::DrivePattern>& effects,
                                          const RecordingState& state);

/// Takes all segments' noise where the state believes it: changes their `bend` and whitener.
/// Returns the largest change of a value, in standard deviations.
double relinearise(RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
                   const Model& model, const EffectParameters& border,
                   const Eigen::VectorXd& offsets, const RecordingState& state);

}  // namespace trussmap::estimation
