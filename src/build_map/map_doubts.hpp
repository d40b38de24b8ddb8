// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What speaks against a map, in words.
#pragma once

#include "trussmap/build_map.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// Numbers that no wheeled robot has (other units, mostly), and a map that is torn: whose routes
/// contradict what was measured of them.
[[nodiscard]] std::vector<std::string> doubts_of(const BuiltMap& built,
                                                 const std::vector<Recording>& recordings,
                                                 const Model& model);

}  // namespace trussmap
