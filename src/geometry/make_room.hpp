// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Room in a list before anything is changed, for calls that change all or nothing.
#pragma once

#include <vector>

namespace trussmap::geometry {

/// So that the next push_back cannot fail.
template <typename Value>
void make_room(std::vector<Value>& values) {
  if (values.size() == values.capacity()) values.reserve(2 * values.size() + 2);
}

}  // namespace trussmap::geometry
