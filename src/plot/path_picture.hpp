// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths as they are drawn, in a picture (SVG) and in a chart: dead reckoning grey, the adjusted
// path black, fixes and loops beside it, those left out in red. What is too much to draw is thinned
// out.
#pragma once

#include "plot/chart.hpp"
#include "plot/picture_frame.hpp"
#include "trussmap/build_map.hpp"

#include <string>
#include <vector>

namespace trussmap::plot {

void include_paths(const std::vector<BuiltPath>& paths, PictureFrame& frame);

/// Elements of the picture, with the classes before, after, fix, loop and wrong.
[[nodiscard]] std::string draw_paths(const std::vector<BuiltPath>& paths,
                                     const PictureFrame& frame);

[[nodiscard]] Chart path_chart(const std::vector<BuiltPath>& paths);

}  // namespace trussmap::plot
