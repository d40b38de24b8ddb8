// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a recording that other files than its folder have, too.
#pragma once

#include "trussmap/recording.hpp"

#include <filesystem>
#include <vector>

namespace trussmap {

/// landmark,x,y[,sd][,heading]. Throws InputError with file and line.
[[nodiscard]] std::vector<SurveyPoint> read_survey(const std::filesystem::path& file);

}  // namespace trussmap
