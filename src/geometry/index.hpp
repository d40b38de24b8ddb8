// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Joints, landmarks and rows are numbered by int; containers want size_t.
#pragma once

#include <cassert>
#include <cstddef>

namespace trussmap {

/// A number that is known not to be negative, as a container's index.
[[nodiscard]] constexpr std::size_t idx(std::ptrdiff_t number) {
  assert(number >= 0 && "an index is not negative");
  return static_cast<std::size_t>(number);
}

}  // namespace trussmap
