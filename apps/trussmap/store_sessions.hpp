// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// build --store: recordings added to a map that is kept in a file.
#pragma once

#include "trussmap/build_map.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::app {

struct StoreSessions {
  std::vector<std::string> recordings;
  std::string model;
  std::string store;
  std::optional<Method> method = {};  ///< where given
  bool scope_given = false;           ///< that of `build`, its law included
  BuildMapOptions build = {};
  std::string out = {};
  std::string csv = {};
  std::string json_file = {};
};

/// Prints a line for each recording once it is kept.
void add_sessions(const StoreSessions& options);

}  // namespace trussmap::app
