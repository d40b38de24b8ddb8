// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The simplest shapes, made without a parser: who only builds maps links none.
#pragma once

#include "trussmap/shape.hpp"

#include <string>

namespace trussmap::effects {

/// "1".
[[nodiscard]] Shape constant_shape();

/// "sin(heading)", "cos(heading)" for the variable heading.
[[nodiscard]] Shape sine_of(const std::string& variable);
[[nodiscard]] Shape cosine_of(const std::string& variable);

}  // namespace trussmap::effects
