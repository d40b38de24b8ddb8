// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows of a fleet (fleet.hpp) in a database: one per robot and day, all of one model.
//
// Programs that add at the same time wait for each other; none loses a row. Merged stores hold the
// same whatever the order of the shards.
#pragma once

#include "trussmap/fleet.hpp"

#include <filesystem>
#include <vector>

namespace trussmap {

/// Makes the store where it is not there. Throws InputError where it is no fleet store, has another
/// model, or has that robot's day already (unless `replace`).
void add_to_fleet(const std::filesystem::path& file, const FleetRow& row, bool replace = false);

/// By robot and date. Throws InputError where it is none, or is damaged.
[[nodiscard]] std::vector<FleetRow> read_fleet(const std::filesystem::path& file);

/// All rows of the shards, written as a new store whole or not at all (one that is there is
/// replaced). A row may be in several shards if it is the same in all; else InputError, as where
/// models differ. Returns how many rows there are.
std::size_t merge_fleets(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& shards);

}  // namespace trussmap
