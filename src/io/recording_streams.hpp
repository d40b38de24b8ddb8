// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a recording that other files than its folder have, too.
#pragma once

#include "trussmap/recording.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace trussmap {

/// landmark,x,y[,sd][,heading]. Throws InputError with file and line.
[[nodiscard]] std::vector<SurveyPoint> read_survey(const std::filesystem::path& file);

/// A letter, then letters, digits and _, and no name that shapes or columns have.
[[nodiscard]] bool is_covariate_name(std::string_view name);

}  // namespace trussmap
