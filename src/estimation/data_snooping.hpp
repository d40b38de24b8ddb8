// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How well each measurement is checked by the others, and which of them do not fit.
//
//   r   whitened residual of one measurement, n values        N   inverse normal matrix
//   J   its whitened rows                                      R = 1 - J N J'   (n x n)
//
//   redundancy  trace R, 0 ... n: what of it is checked by others; all of them sum to the dof
//   statistic   r' R^-1 r: chi^2 of n dof if the measurement is right, whatever the noise of others
//   standardised residual  r_k/sqrt(R_kk), one per value: standard normal
//   smallest detectable outlier  sd sqrt(noncentrality/R_kk), in the value's own unit: seen at
//               99.9 % confidence with 80 % power (noncentrality 17.08; Baarda, "A testing
//               procedure for use in geodetic networks", 1968)
//
// A value with R_kk below 1e-6 is not checked at all: its residual says nothing (0), and no outlier
// is large enough to show (infinity).
#pragma once

#include "estimation/fitted_rows.hpp"
#include "estimation/recording_adjustment.hpp"

#include <vector>

namespace trussmap::estimation {

struct CheckedMeasurement {
  int measurement = -1;
  int checked = 0;          ///< values that the others check
  double redundancy = 0.0;  ///< sum over its values
  double statistic = 0.0;   ///< chi^2 with `checked` degrees of freedom
  double p_value = 1.0;
  Vector4 standardised = Vector4::Zero();
  Vector4 minimal_detectable = Vector4::Zero();  ///< m or rad, as the measurement's values
};

/// Every measurement, in the problem's order; those left out are tested against the fit without
/// them. One factorisation and one inverse of its fronts.
[[nodiscard]] std::vector<CheckedMeasurement> snoop(const RecordingProblem& problem,
                                                    const EffectParameters& border,
                                                    const RecordingAdjustment& adjustment);

/// The same of a fit whose system is there already, with those left out at weight 0.
[[nodiscard]] std::vector<CheckedMeasurement> snoop(const RecordingSystem& system,
                                                    const FittedRows& fitted,
                                                    const RecordingProblem& problem,
                                                    const EffectParameters& border,
                                                    const RecordingAdjustment& adjustment);

/// A measurement that the others contradict.
struct OutlierTest {
  int measurement = -1;
  int checked = 0;          ///< values that the others check
  double statistic = 0.0;   ///< over the dispersion
  double p_adjusted = 1.0;  ///< Bonferroni, over all measurements
};

/// Those whose adjusted p-value is below `level`, most significant first. `dispersion`: chi^2/dof
/// of what is no outlier.
[[nodiscard]] std::vector<OutlierTest> outliers(const std::vector<CheckedMeasurement>& checked,
                                                double level = 0.05, double dispersion = 1.0);

}  // namespace trussmap::estimation
