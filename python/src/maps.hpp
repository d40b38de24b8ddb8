// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmark graphs: of built maps, of builders and of stores.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"

#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>

namespace trussmap::python {

/// "elastic", "elastic-printed", "gauss-markov", "adjustment", with - or _. ValueError on another.
[[nodiscard]] Method method_named(const std::string& name);
/// As the command names it.
[[nodiscard]] std::string command_name(Method method);
/// A number, "all", "estimated" or "auto". ValueError on another.
[[nodiscard]] RefinementScope scope_of(pybind11::handle eta, bool groups);
/// "mean-error" or "variance", as the command has them. ValueError on another.
[[nodiscard]] std::optional<StiffnessLaw> law_named(const std::optional<std::string>& law);

[[nodiscard]] pybind11::list landmark_names(const LandmarkGraph& map);
/// n x 2, m.
[[nodiscard]] pybind11::array landmark_positions(const LandmarkGraph& map);
/// A dict per landmark, with what is known of it.
[[nodiscard]] pybind11::list landmark_rows(const LandmarkGraph& map);
/// A dict per route.
[[nodiscard]] pybind11::list route_rows(const LandmarkGraph& map);

}  // namespace trussmap::python
