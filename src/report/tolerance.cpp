// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/page.hpp"
#include "report/page_words.hpp"

#include <fmt/format.h>

namespace trussmap {

std::string in_words(const Tolerance& tolerance) {
  const bool passed = tolerance.passed();
  return fmt::format(
      "{}: legs end {:.4g} mm off (root mean square of {} held out), {} of {:.4g} mm",
      passed ? "passed" : "failed", 1e3 * tolerance.arrival_rms, tolerance.legs,
      passed ? "within the tolerance" : "beyond the tolerance", 1e3 * tolerance.most);
}

Page with_tolerance(const Page& page, const Tolerance& tolerance) {
  report::PageContent content = page.content();
  content.answers.insert(content.answers.begin(), {"Is it within the tolerance?",
                                                   report::capitalised(in_words(tolerance)) + "."});
  if (!tolerance.passed()) content.tone = report::Tone::bad;
  return content;
}

}  // namespace trussmap
