// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What else explains a diagnosis' recordings as well, in a few lines and in a table.
#pragma once

#include "report/page.hpp"
#include "trussmap/diagnose.hpp"

#include <string>

namespace trussmap::report {

/// The best few sets with their probabilities, and how likely each effect is; empty where nothing
/// is missing.
[[nodiscard]] std::string sets_text(const Diagnosis& diagnosis);

/// All sets, with sizes; no rows where nothing is missing.
[[nodiscard]] PageTable sets_table(const Diagnosis& diagnosis);

/// "Part of the explanation: hard iron (or body tilt) with probability 0.99, ..."; empty likewise.
[[nodiscard]] std::string chances_note(const Diagnosis& diagnosis);

}  // namespace trussmap::report
