// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "formula_limits.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

constexpr std::size_t kLongestFormula = 200;
constexpr int kDeepest = 12;

}  // namespace

std::string fault_of_formula(const std::string& formula) {
  if (formula.empty() || formula.size() > kLongestFormula) {
    return fmt::format("a formula has 1 to {} characters, this one {}", kLongestFormula,
                       formula.size());
  }
  int depth = 0, deepest = 0;
  for (const char c : formula) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    deepest = std::max(deepest, depth);
  }
  if (deepest <= kDeepest) return "";
  return fmt::format("the formula's brackets are {} deep, expected at most {}", deepest, kDeepest);
}

}  // namespace trussmap::app
