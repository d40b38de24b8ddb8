// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers to bytes, the least significant first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace trussmap::logs {

/// An integer or floating-point number of any size.
template <typename T>
void put_little(std::string& out, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  out.append(raw.data(), raw.size());
}

}  // namespace trussmap::logs
