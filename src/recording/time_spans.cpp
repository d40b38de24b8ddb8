// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording/time_spans.hpp"

#include <algorithm>

namespace trussmap::recording {

std::vector<TimeSpan> merged(std::vector<TimeSpan> spans) {
  std::erase_if(spans, [](const TimeSpan& span) { return !(span.from < span.to); });
  std::sort(spans.begin(), spans.end(),
            [](const TimeSpan& a, const TimeSpan& b) { return a.from < b.from; });
  std::vector<TimeSpan> result;
  for (const TimeSpan& span : spans) {
    if (!result.empty() && span.from <= result.back().to) {
      result.back().to = std::max(result.back().to, span.to);
    } else {
      result.push_back(span);
    }
  }
  return result;
}

bool overlaps_any(const TimeSpan& one, const std::vector<TimeSpan>& spans) {
  return std::any_of(spans.begin(), spans.end(), [&one](const TimeSpan& span) {
    return span.from < one.to && one.from < span.to;
  });
}

}  // namespace trussmap::recording
