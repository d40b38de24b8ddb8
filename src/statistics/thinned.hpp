// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fewer of many, evenly: what costs too much to look at whole.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace trussmap::statistics {

/// In their order; all where they are no more than `most`.
template <typename Value>
[[nodiscard]] std::vector<Value> thinned(std::vector<Value> values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<Value> result;
  result.reserve(most);
  for (std::size_t k = 0; k < most; ++k) result.push_back(values[k * values.size() / most]);
  return result;
}

}  // namespace trussmap::statistics
