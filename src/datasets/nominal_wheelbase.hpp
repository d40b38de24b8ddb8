// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Of data sets that state speed and turn rate alone: the drive is that of two wheels so far apart.
#pragma once

namespace trussmap::datasets {

inline constexpr double kNominalWheelbase = 1.0;  // m

}  // namespace trussmap::datasets
