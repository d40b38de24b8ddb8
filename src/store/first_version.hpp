// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stores of the first version: what their tables were, and how they become the present ones. They
// knew legs in map axes alone, and where refinements were limited in gain; their maps go on as they
// are.
#pragma once

#include "store/database.hpp"

#include <functional>
#include <string>

namespace trussmap {

/// Makes the tables of the first version, empty.
void create_first_version(const Database& database);

/// Within a transaction. `make`: makes the present tables, empty.
void upgrade_first_version(const Database& database, const std::function<void()>& make);

}  // namespace trussmap
