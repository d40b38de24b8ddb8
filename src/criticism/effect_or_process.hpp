// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect, or noise that lasts and went that way by chance? A gyro's bias that drifts in
// proportion to time looks like one that walks at random.
//
//   y     whitened residuals, less what all else that is unknown explains
//   Z     columns of the process's steps (process_columns.hpp), less the same
//   C_j   columns of each effect that the process might stand for, less the same; c_j coefficients
//
//   process   y ~ N(0, 1 + s Z Z')          D(s)  = log|1 + s Z Z'| + y'(1 + s Z Z')^-1 y
//   effect    y ~ N(C_j c, 1)               D_j   = min over c of |y - C_j c|^2
//
//   T_j = min over s of D(s) - D_j - 2 c_j        by how much the effect has the better claim
//
// Neither model is a case of the other, and a walk that is smooth has few values of its own: T has
// no law that one could look up. It is drawn (Cox 1961; Williams 1970): y anew under the likeliest
// s, and of each the largest T_j. The share of draws that reach the T of the effect found is how
// likely such a process looks as much like any of these effects. So the number of effects asked of
// counts as far as they differ from each other.
//
// In the basis of the modes of Z Z', of which there are no more than steps, all of this is sums.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace trussmap::criticism {

class EffectOrProcess {
 public:
  /// `effects`: C_j, of as many rows as y.
  EffectOrProcess(const Eigen::VectorXd& y, const Eigen::MatrixXd& Z,
                  const std::vector<Eigen::MatrixXd>& effects);

  /// T of one of them.
  [[nodiscard]] double claim(std::size_t effect) const;
  /// How likely a process makes the largest T as large as that.
  [[nodiscard]] double chance_of_process(std::size_t effect) const;

  [[nodiscard]] double likeliest_variance() const;  ///< s of the process alone
  [[nodiscard]] double gain_of_process() const;     ///< D(0) - D(s)

 private:
  /// Per column of y's in the basis of the modes: min over s of D(s), less y'y.
  struct Likeliest {
    Eigen::VectorXd deviance;
    std::vector<Eigen::Index> size;  ///< which of sizes_
  };
  [[nodiscard]] Likeliest likeliest(const Eigen::MatrixXd& in_modes) const;
  /// T per effect and column, of the same and of all Q'y.
  [[nodiscard]] Eigen::MatrixXd claims(const Eigen::MatrixXd& in_modes,
                                       const Eigen::MatrixXd& in_effects) const;

  Eigen::VectorXd variances_;         ///< of the modes, for s = 1
  Eigen::VectorXd sizes_;             ///< s tried
  Eigen::MatrixXd shares_;            ///< s v/(1 + s v), sizes x modes
  Eigen::VectorXd log_determinants_;  ///< per size
  std::vector<Eigen::Index> first_;   ///< of each effect's columns among those of Q, and their end
  Eigen::MatrixXd Q_modes_;           ///< U'Q: U modes, Q an orthonormal basis of each C_j
  Eigen::MatrixXd Q_outside_;         ///< a root of Q'(1 - UU')Q: it times its transpose
  Eigen::VectorXd y_modes_;
  Eigen::VectorXd y_effects_;
};

}  // namespace trussmap::criticism
