// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps in whatever format the file's name says.
#pragma once

#include "trussmap/landmark_map.hpp"

#include <filesystem>
#include <string>

namespace trussmap::app {

/// True for .graphml, .g2o, .geojson and .dot.
[[nodiscard]] bool is_map_file(const std::filesystem::path& file);

/// Throws UsageError where the name says none of these.
void check_map_format(const std::filesystem::path& file);

/// `comment` stands where the format has room for one.
[[nodiscard]] std::string format_map(const LandmarkGraph& map, const std::filesystem::path& file,
                                     const std::string& comment);

/// GraphML or g2o. Throws UsageError on another name, InputError on what is in the file.
[[nodiscard]] LandmarkGraph read_map(const std::filesystem::path& file);

}  // namespace trussmap::app
