// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One error of the drive, far too large for tests that are linear about a fit without it: a turn
// that scrubs by a half leaves a map so twisted that neither noise nor constants can be told from
// it. So each of the catalogue's that has no place or threshold is fitted by itself; one that alone
// explains everything is the cause. Fits decide among them, and constants come before shapes.
#pragma once

#include "trussmap/fit_model.hpp"

#include <optional>
#include <vector>

namespace trussmap {

/// The given fit with it, the last of the effects; nothing where none explains all. `scale`: a
/// distance was measured.
[[nodiscard]] std::optional<ModelFit> gross_cause(const std::vector<DrivenRecording>& recordings,
                                                  const ModelFit& given, bool scale);

}  // namespace trussmap
