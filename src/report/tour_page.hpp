// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of the elastic paper's experiment: errors per tour and per method.
#pragma once

#include "report/page.hpp"
#include "trussmap/tour_experiment.hpp"

#include <string>

namespace trussmap {

/// Bands are 95 % intervals of the means over the seeds.
[[nodiscard]] Page tour_page(const TourResult& result, int seeds, const std::string& subject);

}  // namespace trussmap
