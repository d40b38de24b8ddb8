// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How good a map was each time its routes had all been driven: of maps that were built leg by leg
// and surveyed.
#pragma once

#include "report/page.hpp"
#include "trussmap/build_map.hpp"

namespace trussmap::report {

/// sigma, rho and position error after each tour. `built` has tours.
[[nodiscard]] PageSection tours_section(const BuiltMap& built);

}  // namespace trussmap::report
