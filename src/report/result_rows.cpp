// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/result_rows.hpp"

#include <utility>

namespace trussmap::report {

std::vector<PageAnswer> answers_of(const ResultRows& rows) {
  const std::pair<const char*, const std::vector<std::string>&> all[] = {
      {kMissing, rows.missing}, {kHowLarge, rows.large},     {kHowSure, rows.sure},
      {kHowFarOff, rows.off},   {kWhatElse, rows.otherwise}, {kNext, rows.next}};
  std::vector<PageAnswer> answers;
  for (const auto& [question, sentences] : all) {
    const std::size_t before = answers.size();
    for (const std::string& one : sentences) {
      if (!one.empty()) answers.push_back({question, one});
    }
    if (answers.size() == before) answers.push_back({question, "Unknown."});
  }
  return answers;
}

}  // namespace trussmap::report
