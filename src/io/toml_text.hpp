// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace trussmap {

/// A TOML basic string, with its quotes.
[[nodiscard]] std::string toml_string(const std::string& text);

}  // namespace trussmap
