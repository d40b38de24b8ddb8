// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What tables of runs have in common, however the ends were measured.
#pragma once

#include "io/csv.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <filesystem>
#include <string>

namespace trussmap::io {

/// Throws InputError on an error longer than the whole path (m).
void require_shorter(const CsvReader& table, const std::string& name, double value, double longest);

/// cw; false: ccw. Throws InputError on anything else.
[[nodiscard]] bool turns_right(const CsvReader& table, int column);

/// Throws InputError on fewer than two runs in a direction.
void require_both_ways(const SquareRuns& runs, const std::filesystem::path& file);

/// Throws InputError on fewer than two runs, and where all are equal.
void require_scatter(const EndErrors& errors, const std::filesystem::path& file);

}  // namespace trussmap::io
