// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tables of a fleet's store: days of robots as rows.
#pragma once

#include "store/database.hpp"
#include "trussmap/fleet.hpp"

#include <string>
#include <vector>

namespace trussmap::fleet {

/// Makes the tables, without a row.
void make_fleet_tables(const store::Database& database);

/// What people and pages are shown of a row, and what its sums are made of. Throws
/// std::invalid_argument.
void check_fleet_row(const FleetRow& row);

/// The text of the model of all rows; empty: none yet.
[[nodiscard]] std::string fleet_model_in(const store::Database& database);

/// In place of the same robot's day, if it is there.
void put_fleet_row(const store::Database& database, const FleetRow& row);

/// By robots, then days. Throws std::invalid_argument, with the row, where a cell cannot be one of
/// such a row.
[[nodiscard]] std::vector<FleetRow> fleet_rows_in(const store::Database& database);

}  // namespace trussmap::fleet
