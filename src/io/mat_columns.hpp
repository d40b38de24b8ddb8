// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns of numbers from a MATLAB file of level 5 (MathWorks, "MAT-File Format", R2017a): real
// matrices with one row or one column, neither compressed nor structures. What data sets of around
// 2000 are kept in.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace trussmap {

/// By name. Throws InputError with the byte where it is something else.
[[nodiscard]] std::map<std::string, std::vector<double>> read_mat_columns(
    const std::filesystem::path& file);

}  // namespace trussmap
