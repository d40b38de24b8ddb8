// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// convert: a recording and what a second odometer recorded beside it to one recording.
#pragma once

#include "command_line.hpp"

#include <filesystem>
#include <string>

namespace trussmap::app {

struct ConvertOdometerOptions {
  std::string second;  ///< folder with drive.csv and model.toml; empty: there is none
  double every = 1.0;  ///< s
};

/// --second-odometer, --every.
void add_convert_odometer(const Command& command, ConvertOdometerOptions& options);

/// `out` is `in` with the second odometer's motions as loops.csv.
void convert_odometer(const std::filesystem::path& in, const std::filesystem::path& out,
                      const ConvertOdometerOptions& options);

}  // namespace trussmap::app
