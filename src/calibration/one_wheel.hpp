// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether one wheel that is larger, or smaller, explains a ratio, a wheelbase and a scale.
#pragma once

#include "calibration/constant_values.hpp"
#include "trussmap/calibrate.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace trussmap::calibration {

/// Of two wheels that were found, and of the wheelbase, which was found as well or is as nominal;
/// with the covariance of `values`. By Wald's tests of the logarithms: the other wheel and the
/// wheelbase are as nominal (p >= 0.05), and neither is so with the other wheel in its place, nor
/// with a ratio about a mean that is as nominal (p < 0.001 each).
[[nodiscard]] std::optional<OneWheel> one_wheel(const Robot& robot,
                                                const std::vector<ConstantValue>& values,
                                                const Eigen::MatrixXd& covariance);

}  // namespace trussmap::calibration
