// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One error of the drive that is no constant, far too large for tests that are linear about a fit
// without it: a turn that scrubs by a half leaves a map so twisted that neither noise nor constants
// can be told from it. Where constants leave much, too, each error of the catalogue that has no
// place or threshold is fitted by itself; of those that alone explain what is there the one that
// fits best is the cause. First of all wrong signs are tried: wheels exchanged, one that counts
// backwards, or all. Where without the compass nothing is off it is none of the drive's.
#pragma once

#include "trussmap/fit_model.hpp"

#include <optional>
#include <vector>

namespace trussmap::criticism {

/// The given fit with it, the last of the effects; nothing where none explains it. `scale`: a
/// distance was measured.
[[nodiscard]] std::optional<ModelFit> gross_cause(const std::vector<DrivenRecording>& recordings,
                                                  const ModelFit& given, bool scale);

}  // namespace trussmap::criticism
