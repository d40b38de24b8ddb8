// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Limits of a step towards equilibrium, which is halved until the energy has fallen.
#pragma once

namespace trussmap::truss {

inline constexpr int kMostHalvings = 10;
inline constexpr double kNoRise = 1e-14;  // of the energy

}  // namespace trussmap::truss
