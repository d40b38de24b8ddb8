// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How likely a channel's field is of what size and length, by the scores of its places.
//
//   u ~ N(0, sigma^2 R),  s ~ N(0, phi G + sigma^2 G R G),  R = L L'
//   L'GL = V diag(d) V',  t = V'L's:   t_k^2/d_k ~ phi + sigma^2 d_k, each by itself
//
// phi is chi^2/dof of what the field leaves, at least 1.
#pragma once

#include "criticism/place_scores.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::criticism {

/// Fields that are thought possible, sigma = 1: L of each length.
struct FieldPriors {
  std::vector<double> lengths;  ///< m
  std::vector<Eigen::MatrixXd> roots;
};

/// From two cells to the whole floor.
[[nodiscard]] FieldPriors priors_over(const PlaceScores& scores);

/// The mean R of three of these lengths: what is asked of before any length is known.
[[nodiscard]] Eigen::MatrixXd mean_covariance(const PlaceScores& scores);

/// Scores of what may be there, beside what is taken to be.
struct ScoresBeside {
  Eigen::MatrixXd G;
  Eigen::VectorXd s;
  double chi2 = 0.0;
  double dof = 0.0;

  /// From now on beside one value for all columns together, so much of each; none where that
  /// cannot be seen.
  void take_out(const Eigen::VectorXd& amounts);
  /// Likewise beside normal ones of variance phi/stiffness, a column of amounts each.
  void take_out(const Eigen::MatrixXd& amounts, double stiffness);
  /// Of some of the columns alone.
  [[nodiscard]] ScoresBeside part(Eigen::Index first, Eigen::Index count) const;
  /// phi where nothing more is there.
  [[nodiscard]] double dispersion() const;
  /// -2 log likelihood at that phi.
  [[nodiscard]] double deviance() const;
};

/// A channel's field of some length in modes.
struct FieldModes {
  Eigen::VectorXd variances;  ///< d
  Eigen::VectorXd t;
  Eigen::MatrixXd fields;  ///< L V: a mode each, over the nodes
};

/// A size that a field may have.
struct FieldSize {
  std::size_t length = 0;  ///< among those thought possible
  double sigma = 0.0;      ///< in the channel's unit
  double phi = 1.0;
  double gain = 0.0;  ///< -2 log of the restricted likelihood that it takes away
};

struct FieldLikelihood {
  std::vector<FieldModes> modes;  ///< per length
  std::vector<FieldSize> sizes;   ///< length by length; equally far apart on logarithmic scales
  FieldSize likeliest;            ///< sigma = 0 where no field gains anything
};

[[nodiscard]] FieldLikelihood likelihood_of(const ScoresBeside& one, const FieldPriors& priors);

/// s'Rs, a quadratic form in normal errors where nothing is there.
struct FieldForm {
  double value = 0.0;
  std::vector<double> weights;  ///< of chi^2 with one degree of freedom each

  /// How likely noise of dispersion phi makes it as large.
  [[nodiscard]] double chance(double phi) const;
};
[[nodiscard]] FieldForm form_of(const ScoresBeside& one, const Eigen::MatrixXd& R);

/// Whether that may be below 0.01 at all, by its mean and variance: quick.
[[nodiscard]] bool may_be_there(const ScoresBeside& one, const Eigen::MatrixXd& R);

}  // namespace trussmap::criticism
