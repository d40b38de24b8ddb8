// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What trussmap umbmark prints, and its JSON.
#pragma once

#include "trussmap/umbmark.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// The last round's results; every round under `rounds`.
[[nodiscard]] nlohmann::ordered_json umbmark_json(const std::vector<SquareRound>& rounds,
                                                  SquareMethod method);

[[nodiscard]] std::string umbmark_text(const std::vector<SquareRound>& rounds, SquareMethod method);

}  // namespace trussmap::app
