// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a leg of a planned drive may be told to do, by a file or by code.
#pragma once

namespace trussmap::recording {

inline constexpr double kMostTurn = 1000.0;   // rad on the spot
inline constexpr double kLongestStop = 1e5;   // s
inline constexpr double kSharpestBend = 1.0;  // rad on the way

}  // namespace trussmap::recording
