// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Text that came from a file, for a reader's eye: nothing in it may command a terminal, turn the
// direction of what follows, or break the line.
#pragma once

#include <string_view>

namespace trussmap::text {

/// Whether escaped_controls (table.hpp) leaves it as it is; XML can hold it then.
[[nodiscard]] bool is_plain_text(std::string_view text);

}  // namespace trussmap::text
