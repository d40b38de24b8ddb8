// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace trussmap::io {

/// The text with ? in place of bytes that are no UTF-8, which TOML has not.
[[nodiscard]] std::string valid_utf8(std::string text);

/// A TOML basic string, with its quotes; of valid_utf8.
[[nodiscard]] std::string toml_string(const std::string& text);

}  // namespace trussmap::io
