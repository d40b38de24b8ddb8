// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether a gross misfit needs a gross cause. Noise that is small beside a long drive makes a gross
// misfit of what moves the robot by a percent, too. Tests that are linear about the fit are right
// for those, and much cheaper than the fits by which gross causes are sought: the error that takes
// most of chi^2 away, the next beside it, and so on until no more is left than noise leaves; then
// one fit of all says whether they hold what the tests promise.
#pragma once

#include "trussmap/fit_model.hpp"

#include <vector>

namespace trussmap::criticism {

inline constexpr double kGrossMisfit = 10.0;  ///< chi^2/dof of the fit without
inline constexpr double kLittleLeft = 2.0;    ///< chi^2/dof of a fit that explains what is there

enum class ExplainedBy {
  nothing_small,
  few,        ///< errors, up to little: one that is no constant, of any size, or small ones
  small_ones  ///< up to nothing: at most three, none of which moves the robot by a twentieth of its
              ///< motion
};

/// `given`: a fit that leaves a gross misfit.
[[nodiscard]] ExplainedBy explained_by(const std::vector<DrivenRecording>& recordings,
                                       const ModelFit& given);

}  // namespace trussmap::criticism
