// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A diagnosis beside constants that explain most (gross_constants.hpp) becomes one of the model as
// it was given.
#pragma once

#include "criticism/diagnosis.hpp"

#include <vector>

namespace trussmap::criticism {

/// The constants come first; what else is missing, and the noise, were judged beside them in `run`.
/// `fit`: of the model given.
void put_constants_first(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                         GrossConstants constants, const DiagnoseOptions& options,
                         DiagnosisRun& run);

}  // namespace trussmap::criticism
