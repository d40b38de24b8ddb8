// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Patterns of shapes that act at a place: parameters x, y and r, in metres.
#pragma once

namespace trussmap::effects {

/// A bell about (x, y), of standard deviation r.
inline constexpr const char* kBellPattern = "exp(-((x-{x})^2+(y-{y})^2)/(2*{r}^2))";
/// 1 within a circle, else 0.
inline constexpr const char* kDiscPattern = "(1+sign({r}^2-(x-{x})^2-(y-{y})^2))/2";
/// The distance from (x, y).
inline constexpr const char* kDistancePattern = "sqrt((x-{x})^2+(y-{y})^2)";

}  // namespace trussmap::effects
