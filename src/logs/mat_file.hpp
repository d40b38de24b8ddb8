// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tables of a MATLAB file of level 5 (save with -v6 or -v7; scipy.io.savemat): variables whose
// lengths are equal are columns of one table.
//
//   t, left, right                columns of these names
//   pose, N x 3                   pose(:,1), pose(:,2), pose(:,3); of 3 x N: pose(1,:), ...
//   odo.t, odo.wheels.left        table "odo" with columns t, wheels.left
//   scan(k).t, one number each    table "scan" with a column t, NaN where it is empty
//
// Texts, cells, complex and sparse numbers, objects (table, timeseries, string) and numbers that
// stand alone are passed over.
#pragma once

#include "logs/message_log.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace trussmap::logs {

struct MatColumn {
  std::string name;
  std::vector<double> values;
  bool whole = false;  ///< of a type that has no fractions
};

struct MatTable {
  std::string name;  ///< the structure's; else "N rows"
  std::vector<MatColumn> columns;

  [[nodiscard]] std::size_t rows() const { return columns.front().values.size(); }
};

struct MatFile {
  std::vector<MatTable> tables;  ///< each with two columns at least
  std::vector<PassedOver> passed_over;
};

/// Whether the name ends in .mat.
[[nodiscard]] bool is_mat_file(const std::filesystem::path& file);
/// Throws InputError with the byte where it is damaged or something else.
[[nodiscard]] MatFile read_mat_file(const std::filesystem::path& file);

/// A table as a log: FILE.mat, or FILE.mat/TABLE where it has several.
[[nodiscard]] bool is_mat_log(const std::filesystem::path& path);
[[nodiscard]] LogEnd read_mat_log(const std::filesystem::path& path, const LogVisit& visit);
/// The file alone, or one path per table.
[[nodiscard]] std::vector<std::filesystem::path> mat_logs(const std::filesystem::path& file);

}  // namespace trussmap::logs
