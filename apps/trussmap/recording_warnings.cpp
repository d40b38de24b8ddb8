// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording_warnings.hpp"

#include "terminal.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace trussmap::app {

void print_warnings(const std::vector<CheckFinding>& findings) {
  if (findings.empty()) return;
  // What progress has written goes first.
  if (can_rewrite_lines(stderr)) fmt::print(stderr, "\r\033[K");
  for (const CheckFinding& one : findings) {
    fmt::print(stderr, "{}", trussmap::warning_text(in_words(one), style_of(stderr)));
  }
}

void warn_of_mistakes(const std::vector<Recording>& recordings, const Model& model,
                      const std::string& model_file, bool to_be_fitted) {
  std::vector<CheckFinding> findings = check_read_recordings(recordings, &model, model_file);
  if (!to_be_fitted) {
    std::erase_if(findings, [](const CheckFinding& one) { return one.kind == "nothing to test"; });
  }
  print_warnings(findings);
}

}  // namespace trussmap::app
