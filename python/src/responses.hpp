// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Errors against what they go with, bin by bin: the pictures that show an effect.
#pragma once

#include "calls.hpp"
#include "trussmap/evidence.hpp"

#include <pybind11/pybind11.h>
#include <vector>

namespace trussmap::python {

/// A tuple of Response: of effects, and of trends that are nobody's effect. Those without bins are
/// left out.
[[nodiscard]] pybind11::tuple responses(const std::vector<EffectEvidence>& effects,
                                        const std::vector<TrendEvidence>& trends);

/// The property `responses` of a result, whose `evidence` touches no Python.
template <typename Result, typename Evidence>
void show_responses(pybind11::class_<Result>& type, const Evidence& (*evidence)(const Result&),
                    const char* about) {
  type.def_property_readonly(
      "responses",
      [evidence](const Result& self) {
        const Evidence& drawn = *unlocked([&] { return &evidence(self); });
        std::vector<EffectEvidence> effects;
        std::vector<TrendEvidence> trends;
        if constexpr (requires { drawn.effects; }) effects = drawn.effects;
        if constexpr (requires { drawn.trends; }) trends = drawn.trends;
        return responses(effects, trends);
      },
      about);
}

}  // namespace trussmap::python
