// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a file may become, by ReadLimits (write_files.hpp) and by its own size.
#pragma once

#include <cstddef>
#include <string>

namespace trussmap {

inline constexpr std::size_t kMebibyte = std::size_t{1} << 20U;  // bytes

/// So much, or so many times its size; where no limit is set.
struct Growth {
  std::size_t mebibytes = 0;
  std::size_t times = 0;
};

/// Bytes that a file of this size may become.
[[nodiscard]] std::size_t most_grown(const Growth& growth, std::size_t size);

/// "more than 64 MiB and 200 times their size; allow more with --max-input-mib".
[[nodiscard]] std::string more_than(const Growth& growth);

}  // namespace trussmap
