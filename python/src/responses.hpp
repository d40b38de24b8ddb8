// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Errors against what they go with, bin by bin: the pictures that show an effect.
#pragma once

#include "trussmap/evidence.hpp"

#include <pybind11/pybind11.h>
#include <vector>

namespace trussmap::python {

/// A tuple of Response: of effects, and of trends that are nobody's effect. Those without bins are
/// left out.
[[nodiscard]] pybind11::tuple responses(const std::vector<EffectEvidence>& effects,
                                        const std::vector<TrendEvidence>& trends);

}  // namespace trussmap::python
