// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What results of fits have in common.
#pragma once

#include <string>
#include <vector>

namespace trussmap::python {

/// The one of these names; ValueError, listing them, on another.
[[noreturn]] void no_table(const std::string& what, const std::vector<std::string>& tables);

}  // namespace trussmap::python
