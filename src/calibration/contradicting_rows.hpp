// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Labels misread, fixes by an echo, loops that take one place for another: what a few rows say
// against all others. Least squares let them bend the constants, so they are looked for where a
// calibration fits badly, and taken out of the recordings.
#pragma once

#include "calibration/wheel_calibration.hpp"

#include <optional>
#include <vector>

namespace trussmap::calibration {

/// Whether its errors are larger than noise makes them.
[[nodiscard]] bool is_contradicted(const WheelCalibration& found);

/// Whether what is left fits, and far better than all (none: that led nowhere).
[[nodiscard]] bool explains_more(const WheelCalibration& rest,
                                 const std::optional<WheelCalibration>& by_all);

/// What a calibration with a gate (options.gate) leaves out, from the constants of `by_all` or of
/// likely starts: of these as that leaves the least sum of squares, each row that is out counted as
/// at the gate. None where many would have to go: then it is the model that is wrong.
[[nodiscard]] std::vector<LeftOutRow> contradicting_rows(
    const std::vector<DrivenRecording>& recordings, const Model& model,
    const WheelCalibrationOptions& options, const std::optional<WheelCalibration>& by_all);

/// The recordings without them.
[[nodiscard]] std::vector<DrivenRecording> without_rows(std::vector<DrivenRecording> recordings,
                                                        const std::vector<LeftOutRow>& rows);

}  // namespace trussmap::calibration
