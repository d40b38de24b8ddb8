// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stores of the first version: what their tables were, and how they become the present ones. They
// knew legs in map axes alone, and where refinements were limited in gain; their maps go on as they
// are.
#pragma once

#include "store/database.hpp"

namespace trussmap::store {

/// Makes the tables of the first version, empty.
void create_first_version(const Database& database);

/// To the present tables. Within a transaction.
void upgrade_first_version(const Database& database);

}  // namespace trussmap::store
