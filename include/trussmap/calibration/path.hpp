// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Test paths as text: pieces in the order driven, separated by commas.
//
//   10        straight, 10 m ahead           -10       straight, 10 m backwards
//   a90       turn on the spot by 90 degrees, counter-clockwise (a-90: clockwise)
//   3@45      an arc of length 3 m that turns by 45 degrees in all (-3@45: driven backwards)
//
// "10,-10" is Chong & Kleeman's (1997) experiment: out and back.
#pragma once

#include "trussmap/recording/test_path.hpp"

#include <string>

namespace trussmap {

/// Throws std::invalid_argument: an empty piece, text, a number that is not finite, no motion at
/// all. The message names the piece and says what was expected.
[[nodiscard]] TestPath parse_path(const std::string& text);

}  // namespace trussmap
