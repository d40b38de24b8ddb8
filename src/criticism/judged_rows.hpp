// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Diagnoses by the rows that what they find leaves independent: an effect that is missing makes
// errors of sightings last, and few of them count; once it is in, they all do.
#pragma once

#include "criticism/diagnosis.hpp"
#include "trussmap/compare.hpp"

#include <optional>

namespace trussmap::criticism {

struct JudgedRun {
  PreparedRecordings rows;
  ModelFit fit;
  DiagnosisRun run;
};

/// `fit` is of these rows; both become others where with what is missing many more count.
[[nodiscard]] JudgedRun judged_run(PreparedRecordings rows, ModelFit fit, const Noise& stated,
                                   const DiagnoseOptions& options);

}  // namespace trussmap::criticism
