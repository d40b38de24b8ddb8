// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// MCAP files, of a bag that may have several.
#pragma once

#include "logs/bag_topics.hpp"

#include <filesystem>
#include <string>

namespace trussmap::logs {

/// Where it is cut off; empty: whole. Throws InputError with `shown` for the name of the file.
[[nodiscard]] std::string read_mcap_file(const std::filesystem::path& file,
                                         const std::string& shown, BagTopics& topics);

}  // namespace trussmap::logs
