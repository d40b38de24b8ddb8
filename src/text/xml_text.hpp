// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Text on its way into XML: maps (GraphML) and pictures (SVG).
#pragma once

#include <string>

namespace trussmap::text {

/// Text for XML content and attributes.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace trussmap::text
