// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The readers, a source each, by the names of the table. Each throws InputError, with file and
// line.
#pragma once

#include "trussmap/datasets.hpp"

#include <concepts>
#include <filesystem>

namespace trussmap::datasets {

[[nodiscard]] bool is_mrclam(const std::filesystem::path& prefix);
[[nodiscard]] Dataset read_mrclam(const std::filesystem::path& prefix);

[[nodiscard]] bool is_optiodom(const std::filesystem::path& file);
[[nodiscard]] Dataset read_optiodom(const std::filesystem::path& file);

[[nodiscard]] bool is_radio_ranges(const std::filesystem::path& prefix);
[[nodiscard]] Dataset read_radio_ranges(const std::filesystem::path& prefix);

[[nodiscard]] bool is_place_loops(const std::filesystem::path& prefix);
[[nodiscard]] Dataset read_place_loops(const std::filesystem::path& prefix);

[[nodiscard]] bool is_phil(const std::filesystem::path& folder);
[[nodiscard]] Dataset read_phil(const std::filesystem::path& folder);

[[nodiscard]] bool is_steered_truck(const std::filesystem::path& prefix);
[[nodiscard]] Dataset read_steered_truck(const std::filesystem::path& prefix);

[[nodiscard]] bool is_line_robot(const std::filesystem::path& file);
[[nodiscard]] Dataset read_line_robot(const std::filesystem::path& file);

[[nodiscard]] bool is_encoder_log(const std::filesystem::path& file);
[[nodiscard]] Dataset read_encoder_log(const std::filesystem::path& file);

[[nodiscard]] bool is_graph_recording(const std::filesystem::path& file);
[[nodiscard]] Dataset read_graph_recording(const std::filesystem::path& file);

/// Rows of what a recording has, the first figures of most formats.
template <std::integral Number>
[[nodiscard]] DatasetFigure counted(const char* key, Number number, const char* words) {
  return {key, static_cast<double>(number), words};
}

}  // namespace trussmap::datasets
