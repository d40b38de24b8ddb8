// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What parts of the driving say of an effect's coefficient, each by itself, without fitting anew.
//
//   B    the effect's whitened column, cut into K parts of driving in order of time
//   B_   B less its projections on landmarks, poses and the other effects (score_test.hpp)
//   G = B_'B_,  s = B_'r:   what the parts' coefficients have that the common one has not is
//                           d ~ N(-G^- s, phi G^-)
#pragma once

#include "criticism/score_test.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap::criticism {

/// A while of driving within a session, and when it is on a clock that stands still between
/// sessions, h.
struct DrivePart {
  std::size_t session = 0;
  double from = 0.0;
  double until = 0.0;
  double hours = 0.0;
};

/// What the parts' rows say of the effect in each.
struct CoefficientCourse {
  std::vector<DrivePart> parts;
  Eigen::MatrixXd G;  ///< parts x parts, the constant included
  Eigen::VectorXd s;
  double chi2 = 0.0;
  int dof = 0;
};

/// Of one of the fit's effects: of its coefficient, or of a factor of all where there are several.
/// Nothing where it shows in too few places.
[[nodiscard]] std::optional<CoefficientCourse> course_of(std::size_t effect,
                                                         const fitting::FitState& fit,
                                                         const ScoreTest& tests);

/// The same beside a constant, which the fit has: G 1 = 0.
[[nodiscard]] CoefficientCourse about_constant(CoefficientCourse course);

/// The same beside a value per part, too; as it is where that is constant, or cannot be seen.
[[nodiscard]] CoefficientCourse beside(const Eigen::VectorXd& values, CoefficientCourse course);

/// Means over the parts: of the hours driven (of a single session, "t"), and of the covariates that
/// all sessions have.
[[nodiscard]] std::map<std::string, Eigen::VectorXd> variables_over(const CoefficientCourse& course,
                                                                    const fitting::FitState& fit);

}  // namespace trussmap::criticism
