// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace trussmap::statistics {

/// The upper one of an even number; NaN of none.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace trussmap::statistics
