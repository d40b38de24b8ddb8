// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Runs of a calibration as tables, one row per run: end errors, absolute - calculated, in the frame
// of the start (x ahead, y to the left).
//
//   square    direction,x,y      cw or ccw; m
//   noise     x,y,heading        m, m, rad
//
// Columns in any order, others are skipped. An error longer than the whole path cannot be one.
#pragma once

#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <filesystem>
#include <string>

namespace trussmap {

/// Throws InputError with file and line: what CsvReader refuses, a direction that is neither cw nor
/// ccw, an error larger than `longest` (m), fewer than two runs in a direction.
[[nodiscard]] SquareRuns read_square_runs(const std::filesystem::path& file, double longest);

/// The same for x, y, heading; headings are brought into (-pi, pi]. Two runs or more.
[[nodiscard]] EndErrors read_end_errors(const std::filesystem::path& file, double longest);

[[nodiscard]] std::string format_square_runs(const SquareRuns& runs);
[[nodiscard]] std::string format_end_errors(const EndErrors& errors);

}  // namespace trussmap
