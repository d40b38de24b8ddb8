// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Batch least squares for maps of any size: measured displacements between joints, all at once.
//
//   minimise  chi2 = sum (p_j - p_i - z)' B (p_j - p_i - z)      first joint held
//
//   z    measured displacement from i to j                  m     map axes
//   B    information of a measurement, C^-1                 1/m^2
//   p    positions                                          m
//
// Measurements of the same two joints are merged as they come, into the sums that chi2 needs, so
// that everything after costs what the map's bars cost, however often each was measured. Sums are
// taken about a bar's first measurement: chi2 loses no digits.
//
// The system is ordered by nested dissection of the joints' rough positions (dissection.hpp).
#pragma once

#include "truss/truss_system.hpp"

#include <optional>
#include <vector>

namespace trussmap::truss {

class MeasuredTruss {
 public:
  struct Fit {
    std::vector<Vector2> positions;  ///< per joint, m
    double chi2 = 0.0;               ///< of all measurements, repeats included
    int dof = 0;                     ///< 2 (measurements - joints + 1)
  };

  /// Joints are numbered from 0; joint 0 stays at its position, others are `about` there, m.
  int add_joint(const Vector2& about);

  /// Throws std::invalid_argument unless both joints exist, are two, and the information is
  /// positive definite.
  void add(int i, int j, const Vector2& displacement, const Matrix2& information);

  /// Throws UnsupportedJoint where a joint is tied to nothing.
  [[nodiscard]] Fit fit(linalg::Kernel kernel = linalg::Kernel::frontal);

  /// Covariances of all joints, m^2, zero for the first: those of the last fit. Throws
  /// std::logic_error without one or if measurements were added since.
  [[nodiscard]] std::vector<Matrix2> covariances() const;

  [[nodiscard]] int joints() const { return static_cast<int>(about_.size()); }
  [[nodiscard]] int bars() const { return static_cast<int>(bars_.size()); }

 private:
  struct Sums {
    Vector2 first = Vector2::Zero();      ///< z_0
    Matrix2 stiffness = Matrix2::Zero();  ///< sum B
    Vector2 pull = Vector2::Zero();       ///< sum B (z - z_0)
    double scatter = 0.0;                 ///< sum (z - z_0)' B (z - z_0)
    int next = -1;                        ///< next bar of the same lower joint
  };

  int bar_between(int low, int high);

  std::vector<Vector2> about_;
  std::vector<int> bars_at_;             ///< per joint: the last bar of which it is the lower end
  std::vector<linalg::NodePair> pairs_;  ///< per bar: its joints, the lower first
  std::vector<Sums> bars_;               ///< displacements from the lower joint to the higher
  long measurements_ = 0;
  std::optional<TrussSystem> system_;  ///< of the last fit
};

}  // namespace trussmap::truss
