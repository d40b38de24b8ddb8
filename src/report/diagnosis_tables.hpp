// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables of a diagnosis, for the pages of diagnose and discover.
#pragma once

#include "report/page.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"

#include <string>
#include <vector>

namespace trussmap::report {

/// A diagnosis with what its findings do in the recordings.
struct SizedDiagnosis {
  const Diagnosis& diagnosis;
  const std::vector<FindingSize>& sizes;  ///< one per finding
};

/// For each part of the robot and its world, the best change. `found`: effects that a search has
/// added before this diagnosis, listed with their parts.
[[nodiscard]] PageTable parts_table(const SizedDiagnosis& sized,
                                    const std::vector<EffectEvidence>& found = {});

/// Every source of noise, where it is other than stated; else no rows.
[[nodiscard]] PageTable noise_table(const Diagnosis& diagnosis);

/// What these recordings cannot tell from the first finding; no rows where nothing looks the same.
[[nodiscard]] PageTable rivals_table(const SizedDiagnosis& sized);

/// All that was tried, noise and single events, what cannot be seen and why, advice, warnings.
[[nodiscard]] PageSection tried_section(const SizedDiagnosis& sized);

/// "Larger effects would have been seen: wheelbase from 0.21 %, ...": well-known ones. Empty where
/// none would have been.
[[nodiscard]] std::string seen_from_note(const SizedDiagnosis& sized);

}  // namespace trussmap::report
