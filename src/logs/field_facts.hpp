// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is known of a field, value by value, in the order in which they are added.
#pragma once

#include "trussmap/log_files.hpp"

#include <string>

namespace trussmap::logs {

/// One that is not finite is none.
void add_number(double value, LogFieldFacts& facts);
/// `before`: the text that was added before, which this one becomes; an empty one is none.
void add_text(const std::string& text, LogFieldFacts& facts, std::string& before);

}  // namespace trussmap::logs
