// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What makes a database a map store: its marks and its tables, of this version and the first.
#pragma once

#include "store/database.hpp"
#include "trussmap/map_builder.hpp"

#include <filesystem>

namespace trussmap::store {

/// Makes the present tables, with options and an empty memory in them. Within a transaction.
void create_store(const Database& database, const MapBuilderOptions& options);

/// False: there is nothing yet. Throws InputError, naming the file, where there is something else.
[[nodiscard]] bool is_store(const std::filesystem::path& file, const Database& database);

/// Of one that is_store().
[[nodiscard]] bool is_of_first_version(const Database& database);

}  // namespace trussmap::store
