// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is built of recordings without landmarks, their paths, as text.
#pragma once

#include "trussmap/build_map.hpp"

#include <string>
#include <vector>

namespace trussmap::report {

[[nodiscard]] std::string paths_headline(const std::vector<BuiltPath>& paths);
/// The figures; `built` has paths.
[[nodiscard]] std::string paths_text(const BuiltMap& built);

}  // namespace trussmap::report
