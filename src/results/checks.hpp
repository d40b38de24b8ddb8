// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What check writes.
#pragma once

#include "results/described.hpp"
#include "trussmap/check.hpp"

#include <vector>

namespace trussmap::results {

template <>
inline constexpr auto kDescribed<CheckFinding> =
    described(field("file", &CheckFinding::file, "its name"),
              field("column", &CheckFinding::column, "several with commas"),
              field("kind", &CheckFinding::kind, "of mistake"),
              field("evidence", &CheckFinding::evidence, "in words"),
              field("remedy", &CheckFinding::remedy, "in words"));

/// What check says.
struct CheckReport {
  std::vector<CheckFinding> findings;
};
template <>
inline constexpr auto kDescribed<CheckReport> = described(field("findings", &CheckReport::findings,
                                                                "empty where nothing is found"));

}  // namespace trussmap::results
