// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a file may become, by ReadLimits (write_files.hpp) and by its own size.
#pragma once

#include "trussmap/error.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace trussmap::io {

inline constexpr std::size_t kMebibyte = std::size_t{1} << 20U;  // bytes

/// So much, or so many times its size; where no limit is set.
struct Growth {
  std::size_t mebibytes = 0;
  std::size_t times = 0;
};

/// Bytes that a file of this size may become.
[[nodiscard]] std::size_t most_grown(const Growth& growth, std::size_t size);

/// Bytes of a file as it is that are read; of a pipe or device, which need not end, so many at most
/// where no limit is set.
[[nodiscard]] std::size_t most_read(const std::filesystem::path& file);

/// Of one that gave more: "is more than 1024 MiB; allow more with --max-input-mib".
[[nodiscard]] InputError too_long(const std::string& name, std::size_t most);

/// "more than 64 MiB and 200 times their size; allow more with --max-input-mib".
[[nodiscard]] std::string more_than(const Growth& growth);

}  // namespace trussmap::io
