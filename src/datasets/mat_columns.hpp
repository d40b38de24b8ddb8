// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns of numbers from a MATLAB file of level 5 (MathWorks, "MAT-File Format", R2017a): real
// matrices with one row or one column, neither compressed nor structures. What data sets of around
// 2000 are kept in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace trussmap::datasets {

/// By name. Throws InputError with the byte where it is something else.
[[nodiscard]] std::map<std::string, std::vector<double>> read_mat_columns(
    const std::filesystem::path& file);

/// A column by its name, of `rows` numbers (0: of any), none beyond 1e12; InputError otherwise.
[[nodiscard]] const std::vector<double>& mat_column(
    const std::map<std::string, std::vector<double>>& columns, const std::string& name,
    const std::filesystem::path& file, std::size_t rows = 0);

}  // namespace trussmap::datasets
