// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "driven.hpp"

namespace trussmap::testing {

/// Rows of 0.1 s, from t = 10 s on, in which two wheels that are so far apart travel so far (m).
inline void add_rows(MotionRows& drive, int rows, double left, double right, double wheelbase) {
  for (int k = 0; k < rows; ++k) {
    drive.t.push_back(10.0 + 0.1 * static_cast<double>(drive.rows() + 1));
    add_travels(drive, left, right, wheelbase);
  }
}

}  // namespace trussmap::testing
