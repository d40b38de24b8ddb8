// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An estimate as two cells of a table.
#pragma once

#include "trussmap/umbmark.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// The value, and "\u00b1" with its standard error; empty without one.
[[nodiscard]] std::vector<std::string> quantity_cells(const Estimate& estimate);

}  // namespace trussmap
