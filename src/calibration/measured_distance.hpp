// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether recordings say how long a metre is: without, a smaller map has smaller errors.
#pragma once

#include "estimation/recording_problem.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::calibration {

/// By truth, a survey, ranges, or loops between poses that are apart by ten times what a loop is
/// good to: those of another odometer, not those of a place met again.
[[nodiscard]] bool measures_distance(const std::vector<DrivenRecording>& recordings,
                                     const estimation::ProblemOptions& options, const Noise& noise);

/// By anything but landmarks that are seen from afar.
[[nodiscard]] bool measures_distance_without_ranges(const std::vector<DrivenRecording>& recordings,
                                                    const estimation::ProblemOptions& options,
                                                    const Noise& noise);

}  // namespace trussmap::calibration
