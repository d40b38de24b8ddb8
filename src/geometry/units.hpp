// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What metres and radians are multiplied by to be read.
#pragma once

#include <numbers>

namespace trussmap::geometry {

constexpr double kDegrees = 180.0 / std::numbers::pi;  // in a radian
constexpr double kDegree = std::numbers::pi / 180.0;   // rad
constexpr double kMillimetres = 1000.0;                // in a metre
constexpr double kFullTurn = 2.0 * std::numbers::pi;   // rad
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

}  // namespace trussmap::geometry
