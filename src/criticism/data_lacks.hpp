// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What recordings lack for telling effects apart.
#pragma once

#include "trussmap/compare.hpp"

#include <vector>

namespace trussmap::criticism {

/// The gravest first.
[[nodiscard]] std::vector<DataLack> lacks_of(const std::vector<DrivenRecording>& recordings,
                                             const Robot& robot, const FitOptions& options);

}  // namespace trussmap::criticism
