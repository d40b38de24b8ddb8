// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// convert: a map to YAML.
#pragma once

#include "command_line.hpp"
#include "trussmap/landmark_map.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace trussmap::app {

struct MapYamlOptions {
  std::optional<std::string> layout;  ///< nav2 if left out
  std::optional<double> tag_size;
};

/// --layout, --tag-size.
void add_map_yaml(const Command& command, MapYamlOptions& options);

/// Throws UsageError where options are given and `out` is no YAML.
void check_map_yaml(const std::filesystem::path& out, const MapYamlOptions& options);

[[nodiscard]] bool is_yaml_file(const std::filesystem::path& file);

/// Writes it, and says which landmarks it cannot hold whole.
void write_map_yaml(const LandmarkGraph& map, const std::filesystem::path& out,
                    const MapYamlOptions& options);

}  // namespace trussmap::app
