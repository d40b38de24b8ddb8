// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// convert: a recording of ours to a bag.
#pragma once

#include "command_line.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace trussmap::app {

struct ConvertRecordingOptions {
  std::string model;  ///< empty: the folder's model.toml
  double wheel_radius = 0.05;
  std::optional<double> epoch;
};

/// --model, --wheel-radius, --epoch.
void add_convert_recording(const Command& command, ConvertRecordingOptions& options);

/// Whether a folder becomes an .mcap.
[[nodiscard]] bool is_recording_to_bag(const std::filesystem::path& in,
                                       const std::filesystem::path& out);

/// `map`: where the map.toml goes that reads it back, if anywhere.
void convert_recording(const std::filesystem::path& in, const std::filesystem::path& out,
                       const std::filesystem::path& map, const ConvertRecordingOptions& options);

}  // namespace trussmap::app
