// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An adjustment of what is laid of a session so far.
#pragma once

#include "estimation/laid_session.hpp"

namespace trussmap::estimation {

struct AdjustedStretch {
  LaidSession laid;
  double lost = 0.0;  ///< share of the sightings that are beyond the gate
};

/// Adjusts the first `count` poses, the landmarks they see and the coefficients, roughly.
[[nodiscard]] AdjustedStretch adjust_stretch(const SessionToLay& session, LaidSession laid,
                                             int count);

}  // namespace trussmap::estimation
