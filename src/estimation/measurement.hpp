// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One measurement of a least-squares problem, and what its rows say at given values.
#pragma once

#include "estimation/segment_motion.hpp"

#include <cstddef>

namespace trussmap::estimation {

class MeasurementKind;

struct Measurement {
  const MeasurementKind* kind = nullptr;  ///< one of kinds/kinds.hpp
  int from = -1;                          ///< node
  int to = -1;                            ///< node; -1: none
  int rows = 0;                           ///< 1 to 4
  Vector4 value = Vector4::Zero();        ///< measured; a segment's last is its mean heading
  /// Added to the value: by segment_noise.hpp, and by student_tails.hpp to a sighting's.
  Vector4 value_offset = Vector4::Zero();
  Matrix4 whitener = Matrix4::Zero();  ///< rows x rows: inverse of the covariance's Cholesky factor
  effects::ViewPattern mounted =
      {};              ///< where its sensor is stated to sit: its view without effects
  double tails = 0.0;  ///< degrees of freedom of Student's t (student_tails.hpp); 0: normal
  int session = -1;    ///< -1: survey
  /// Row of the session's stream; of what is driven, the segment.
  std::size_t source = 0;
  bool own_sd = false;  ///< the stream's row states it; the model's noise counts for nothing
};

using RowsByNode = Eigen::Matrix<double, 4, 3>;  ///< unused rows and columns are zero

/// Predicted less measured, and its derivatives.
struct MeasurementRows {
  Vector4 error = Vector4::Zero();
  RowsByNode by_from = RowsByNode::Zero();
  RowsByNode by_to = RowsByNode::Zero();
  effects::ByView by_view = effects::ByView::Zero();
};

/// Inverse Cholesky factor of a covariance's leading rows x rows.
[[nodiscard]] Matrix4 whitener_of(const Matrix4& covariance, int rows);

/// What whitens a measurement with further noise: of the leading rows x rows of (W'W)^-1 + more.
[[nodiscard]] Matrix4 whitener_with(const Matrix4& whitener, const Matrix4& more, int rows);

/// Covariance of a measurement's rows, rows x rows.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Measurement& one);

}  // namespace trussmap::estimation
