// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A recording as a folder of CSV streams: drive.csv, sightings.csv, survey.csv, truth.csv (their
// columns: recording.hpp; angles in rad, lengths in m, times in s).
#pragma once

#include "trussmap/recording/recording.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace trussmap {

/// Reads a folder, strictly: InputError with file and line for whatever is wrong, nothing is
/// guessed. sightings.csv may be absent only where there is a truth.csv.
[[nodiscard]] Recording read_recording(const std::filesystem::path& folder);

/// Writes the streams that the recording has (a drive always; sightings unless there is truth and
/// no sighting) and removes the others that an earlier recording left in the folder. `comment`, if
/// any, becomes # lines at the top of drive.csv; `beside` are further files, by name and content,
/// written with them. The folder is made where it is missing. Numbers read back exactly.
void write_recording(const std::filesystem::path& folder, const Recording& recording,
                     const std::string& comment = "",
                     const std::vector<std::pair<std::string, std::string>>& beside = {});

}  // namespace trussmap
