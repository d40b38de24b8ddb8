// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What else a finding could be: candidates whose columns can show its trace as well.
#pragma once

#include "criticism/tested_candidate.hpp"
#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <vector>

namespace trussmap {

/// Of tested[at] among the others; the most alike first, at most twelve.
[[nodiscard]] std::vector<LookAlike> look_alikes_of(std::size_t at,
                                                    const std::vector<Tested>& tested,
                                                    const ScoreTest& tests);

[[nodiscard]] bool is_among(const Effect& effect, const std::vector<LookAlike>& rivals);

}  // namespace trussmap
