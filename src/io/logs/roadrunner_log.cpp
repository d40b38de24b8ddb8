// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/message_log.hpp"
#include "trussmap/error.hpp"

namespace trussmap {

bool is_roadrunner_log(const std::filesystem::path& file) {
  static_cast<void>(file);
  return false;
}

LogEnd read_roadrunner_log(const std::filesystem::path& file, const LogVisit& visit) {
  static_cast<void>(visit);
  throw InputError(file.string(), 0, "cannot be read yet");
}

}  // namespace trussmap
