// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far the other wheels go before one that stands still is doubted, and what a turn between two
// readings may be.
#pragma once

namespace trussmap::check {

inline constexpr double kStillTurns = 30.0;   // wheelbases: five turns about the wheel
inline constexpr double kStillTravel = 10.0;  // m
inline constexpr double kUntold = 2.5;  // rad from reading to reading: whole turns are not told

}  // namespace trussmap::check
