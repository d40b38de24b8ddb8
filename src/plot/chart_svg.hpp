// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Charts as still pictures: what a page shows alive, for scripts and papers. 800 pixels wide, in
// the colours for paper.
#pragma once

#include "plot/chart.hpp"

#include <string>

namespace trussmap::plot {

/// The picture as SVG. Text is escaped; same input, same bytes. Throws std::invalid_argument like
/// chart_json.
[[nodiscard]] std::string draw_chart(const Chart& chart);

}  // namespace trussmap::plot
