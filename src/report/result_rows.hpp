// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The six questions at the top of every page on a model, always the same, in this order; what is
// unknown is said to be.
#pragma once

#include "report/page.hpp"

#include <string>
#include <vector>

namespace trussmap::report {

inline constexpr const char* kMissing = "What is missing?";
inline constexpr const char* kHowLarge = "How large?";
inline constexpr const char* kHowSure = "How sure?";
inline constexpr const char* kHowFarOff = "How far off is the robot?";
inline constexpr const char* kWhatElse = "What else could it be?";
inline constexpr const char* kNext = "What to do next?";

/// Sentences; empty ones do not count.
struct ResultRows {
  std::vector<std::string> missing = {};
  std::vector<std::string> large = {};
  std::vector<std::string> sure = {};
  std::vector<std::string> off = {};
  std::vector<std::string> otherwise = {};
  std::vector<std::string> next = {};
};

/// Six questions, each with an answer at least.
[[nodiscard]] std::vector<PageAnswer> answers_of(const ResultRows& rows);

}  // namespace trussmap::report
