// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Shapes that together follow any smooth curve: bells side by side.
#pragma once

#include "criticism/driven_variables.hpp"
#include "trussmap/shape.hpp"

#include <vector>

namespace trussmap::criticism {

/// Four over nearly all values of a variable; none where these are all but the same.
[[nodiscard]] std::vector<Shape> bells_over(const Spread& u);

/// All over the floor that was driven on, five along its longer side; none where there is none.
[[nodiscard]] std::vector<Shape> bells_over(const Area& area);

}  // namespace trussmap::criticism
