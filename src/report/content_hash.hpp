// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The name by which a content security policy allows a script or a style sheet (CSP level 3):
// sha256- and SHA-256 (FIPS 180-4) of its text in base64.
#pragma once

#include <string>
#include <string_view>

namespace trussmap::report {

/// Of a text without \r, which a browser reads as \n.
[[nodiscard]] std::string content_hash(std::string_view text);

}  // namespace trussmap::report
