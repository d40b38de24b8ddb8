// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What charts of a map have in common: the path below, the landmarks above.
#pragma once

#include "plot/chart.hpp"
#include "trussmap/fit_model.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap::plot {

/// Routes that are drawn one by one; the others are one faint net.
inline constexpr std::size_t kMostBars = 250;

using Places = std::map<std::string, Vector2>;
[[nodiscard]] Places places_of(const FittedMap& map);

/// A line that nobody can point at; NaN: a gap.
[[nodiscard]] ChartLayer net_layer(const char* name, const std::vector<Vector2>& points);

/// Axes and the path driven. `routes`: what the caption says of routes; of a map without landmarks
/// it says nothing of them.
[[nodiscard]] Chart map_chart(const std::string& id, const std::string& title, const FittedMap& map,
                              const std::string& routes);

/// With their ellipses, and where they were surveyed; those least sure where they are many.
void add_landmarks(Chart& chart, const FittedMap& map);

}  // namespace trussmap::plot
