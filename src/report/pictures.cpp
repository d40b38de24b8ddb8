// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/calibration_figures.hpp"
#include "plot/map_picture.hpp"
#include "trussmap/pages.hpp"

namespace trussmap {

std::string map_picture(const BuiltMap& built, const std::string& title) {
  return plot::draw_map(plot::picture_of(built, title));
}

std::string square_picture(const std::vector<SquareRuns>& rounds, double side) {
  return plot::draw_figure(plot::square_figure(rounds, side));
}

std::string noise_picture(const EndErrors& errors, const NoiseEstimate& estimate,
                          const std::optional<StatedNoise>& stated) {
  return plot::draw_figure(plot::noise_figure(errors, estimate, stated));
}

}  // namespace trussmap
