// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How the tables of a store were made: whoever wrote the file may have put statements into it, and
// these would run with every call.
#pragma once

#include "store/database.hpp"

#include <string>
#include <vector>

namespace trussmap::store {

/// The statements that made these tables, their indices and views of their names, and all triggers,
/// in a fixed order; blanks and ends of lines do not count.
[[nodiscard]] std::vector<std::string> schema_of(const Database& database,
                                                 const std::vector<std::string>& tables);

}  // namespace trussmap::store
