// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_output.hpp"

#include "trussmap/wording.hpp"

#include <filesystem>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
void print_written(const Files& files) {
  const std::vector<std::filesystem::path> paths = files.paths();
  if (paths.empty()) return;
  fmt::print("\n  written: ");
  for (std::size_t k = 0; k < paths.size(); ++k) {
    fmt::print("{}{}", k == 0 ? "" : ", ", paths[k].string());
  }
  fmt::print("\n");
}

}  // namespace trussmap::app
