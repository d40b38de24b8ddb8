// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Formulas that come from a page: short and shallow ones alone reach the parser.
#pragma once

#include <string>

namespace trussmap::app {

/// Too long, or brackets nested too deeply, in words; empty where there is nothing to say.
[[nodiscard]] std::string fault_of_formula(const std::string& formula);

}  // namespace trussmap::app
