// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The JSON of trussmap umbmark.
#pragma once

#include "trussmap/umbmark.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {

/// The last round's results; every round under `rounds`, other paths under `alone`.
[[nodiscard]] nlohmann::ordered_json umbmark_json(const std::vector<SquareRound>& rounds,
                                                  SquareMethod method,
                                                  const std::vector<PathAlone>& alone);

}  // namespace trussmap::app
