// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A store's history as rows of a database: every call of the builder, and the sessions of calls
// that were taken in as one. Where rows are read, std::invalid_argument says what a store is
// damaged that has it.
#pragma once

#include "map/builder_memory.hpp"
#include "store/database.hpp"
#include "trussmap/map_store.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace trussmap::store {

/// Makes the tables, empty.
void create_leg_tables(const Database& database);

inline constexpr const char* kPutLeg =
    "INSERT INTO legs VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
inline constexpr const char* kLegs = "SELECT * FROM legs ORDER BY number";

/// `session`: its place among the sessions, if there is one.
void put_leg(text::RowWriter& row, const map::BuilderCall& call, std::int64_t number,
             const std::optional<std::int64_t>& session);

/// A row of kLegs. `graph`: the store's landmarks; `sessions`: their number.
[[nodiscard]] StoredLeg leg_in(const text::RowReader& row, std::int64_t number,
                               const LandmarkGraph& graph, std::int64_t sessions);

/// The number of legs.
[[nodiscard]] std::int64_t legs_in(const Database& database);

/// Its place among the sessions.
[[nodiscard]] std::int64_t put_session(const Database& database, const StoredSession& session);

[[nodiscard]] std::vector<StoredSession> sessions_in(const Database& database);

}  // namespace trussmap::store
