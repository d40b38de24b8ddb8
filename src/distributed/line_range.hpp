// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The lines of a large file that begin in this process's range of its bytes.
#pragma once

#include "distributed/communicator.hpp"

#include <filesystem>
#include <string>

namespace trussmap::distributed {

struct LineRange {
  std::string text;            ///< whole lines
  std::size_t first_line = 1;  ///< number of the first of them
};

/// Ranges of equal length, in the order of the ranks. Throws InputError in all processes where the
/// file cannot be read in one of them.
[[nodiscard]] LineRange read_own_lines(const Communicator& all, const std::filesystem::path& path);

}  // namespace trussmap::distributed
