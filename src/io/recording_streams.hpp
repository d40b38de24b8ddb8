// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a recording that other files than its folder have, too.
#pragma once

#include "trussmap/recording_files.hpp"

#include <filesystem>
#include <vector>

namespace trussmap::io {

/// landmark,x,y[,sd][,heading]. Throws InputError with file and line.
[[nodiscard]] std::vector<SurveyPoint> read_survey(const std::filesystem::path& file);

/// Of streams that are texts still. Throws InputError as read_recording() does.
[[nodiscard]] Recording recording_in(const NamedTexts& files, bool drive_alone);

}  // namespace trussmap::io
