// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/texts.hpp"

#include <fmt/format.h>

namespace trussmap {

std::string check_text(const std::vector<CheckFinding>& findings, TextStyle style) {
  if (findings.empty()) {
    return verdict_text(Mood::good, "nothing found: no column contradicts another", style) + "\n";
  }
  std::string text;
  for (const CheckFinding& one : findings) {
    text += shortened_words(fmt::format("{}, {}: {}: {}\n    {}\n", one.file,
                                        one.column.empty() ? "all" : one.column, one.kind,
                                        one.evidence, one.remedy));
  }
  return text;
}

}  // namespace trussmap
