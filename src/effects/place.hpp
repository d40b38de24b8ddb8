// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Places that effects act at.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"

#include <optional>

namespace trussmap::effects {

/// Centre of an effect that acts at one place alone, m.
[[nodiscard]] std::optional<Vector2> place_of(const Effect& effect);

}  // namespace trussmap::effects
