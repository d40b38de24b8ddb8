// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/calibration_figures.hpp"

#include "geometry/units.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

std::vector<Vector2> in_millimetres(const std::vector<Eigen::Vector2d>& metres) {
  std::vector<Vector2> result;
  result.reserve(metres.size());
  for (const Eigen::Vector2d& p : metres) result.push_back(geometry::kMillimetres * p);
  return result;
}

void add_cluster(Panel& panel, const std::vector<Eigen::Vector2d>& runs, const SampleMean& mean,
                 const std::string& name, const char* colour) {
  const Vector2 centre = geometry::kMillimetres * mean.mean;
  panel.marks.push_back({MarkKind::segments, {Vector2::Zero(), centre}, colour, 1.2, true, "", {}});
  panel.marks.push_back(
      {MarkKind::dots, in_millimetres(runs), colour, 4.5, false, name + " runs", {}});
  panel.marks.push_back(
      {MarkKind::pluses, {centre}, colour, 10.0, false, name + " centre of gravity", {}});
}

Panel square_panel(const SquareRuns& runs, std::size_t round, std::size_t rounds) {
  const SquareClusters clusters = square_clusters(runs);
  const double farthest = geometry::kMillimetres * clusters.largest_offset.value;
  Panel panel;
  panel.title = fmt::format("{}systematic error {:.0f} mm",
                            rounds > 1 ? fmt::format("Round {}: ", round + 1) : "", farthest);
  panel.title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(panel.title[0])));
  panel.x_label = "x error [mm]";
  panel.y_label = "y error [mm]";
  panel.equal_aspect = true;
  panel.zero_lines = true;
  const Matrix2 circle = Matrix2::Identity();
  panel.marks.push_back({MarkKind::polyline,
                         ellipse_outline(Vector2::Zero(), circle, farthest),
                         colour::kGrey,
                         1.0,
                         true,
                         "distance of the farther centre",
                         {}});
  add_cluster(panel, runs.cw, clusters.cw, "cw", colour::kVermilion);
  add_cluster(panel, runs.ccw, clusters.ccw, "ccw", colour::kBlue);
  return panel;
}

Range widest(const Panel& panel, int axis) {
  Range range{0.0, 0.0};
  for (const Mark& mark : panel.marks) {
    for (const Vector2& p : mark.at) {
      range.low = std::min(range.low, p[axis]);
      range.high = std::max(range.high, p[axis]);
    }
  }
  const double margin = std::max(0.07 * (range.high - range.low), 1e-9);
  return {range.low - margin, range.high + margin};
}

/// One plane of Chong & Kleeman's Figure 4.
Panel noise_panel(const EndErrors& errors, const NoiseEstimate& estimate,
                  const std::optional<StatedNoise>& stated, int across, int up) {
  constexpr const char* kLabels[] = {"x error [mm]", "y error [mm]", "heading error [mrad]"};
  constexpr const char* kTitles[] = {"Along and across", "Along and heading", "Across and heading"};
  const std::vector<int> pick = {across, up};
  const double scale = geometry::kMillimetres * ellipse95_scale(2);
  const Vector2 centre = geometry::kMillimetres * Vector2(estimate.centre(pick));
  Panel panel;
  panel.title = kTitles[across + up - 1];
  panel.x_label = kLabels[across];
  panel.y_label = kLabels[up];
  panel.zero_lines = true;
  Mark runs{MarkKind::dots, {}, colour::kSky, 3.2, false, "end errors", {}};
  for (const Eigen::Vector3d& e : errors)
    runs.at.push_back(geometry::kMillimetres * Vector2(e(pick)));
  panel.marks.push_back(runs);
  panel.marks.push_back({MarkKind::polyline,
                         ellipse_outline(centre, estimate.observed(pick, pick), scale),
                         colour::kBlack,
                         1.8,
                         false,
                         "95 % ellipse of the runs",
                         {}});
  panel.marks.push_back({MarkKind::polyline,
                         ellipse_outline(centre, estimate.modelled(pick, pick), scale),
                         colour::kVermilion,
                         1.8,
                         true,
                         "95 % ellipse of the model",
                         {}});
  for (int sigma = 1; stated && sigma <= 3; ++sigma) {
    panel.marks.push_back(
        {MarkKind::polyline,
         ellipse_outline(geometry::kMillimetres * Vector2(stated->centre(pick)),
                         stated->modelled(pick, pick), geometry::kMillimetres * sigma),
         colour::kGreen,
         1.2,
         false,
         sigma == 1 ? "1, 2, 3 sigma by the k stated" : "",
         {}});
  }
  return panel;
}

}  // namespace

Figure square_figure(const std::vector<SquareRuns>& rounds, double side) {
  if (rounds.empty()) throw std::invalid_argument("a figure of a calibration needs a round");
  Figure figure;
  figure.title = "Where the robot stopped after the square";
  figure.subtitle =
      fmt::format("{:g} m \u00d7 {:g} m; error = absolute \u2212 calculated", side, side);
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    figure.panels.push_back(square_panel(rounds[k], k, rounds.size()));
  }
  const Range x = widest(figure.panels.front(), 0);
  const Range y = widest(figure.panels.front(), 1);
  for (Panel& panel : figure.panels) {
    panel.x = x;
    panel.y = y;
  }
  figure.panel_width = rounds.size() == 1 ? 560.0 : 400.0;
  figure.panel_height = rounds.size() == 1 ? 520.0 : 400.0;
  return figure;
}

Figure noise_figure(const EndErrors& errors, const NoiseEstimate& estimate,
                    const std::optional<StatedNoise>& stated) {
  Figure figure;
  figure.title = "End errors, and what the wheels' noise explains";
  figure.subtitle = fmt::format("{} runs; k left {:.2g}, right {:.2g} m^1/2", estimate.runs,
                                estimate.left.k, estimate.right.k);
  if (stated) {
    figure.subtitle +=
        fmt::format("; stated: left {:.2g}, right {:.2g}", stated->left, stated->right);
  }
  figure.panels = {noise_panel(errors, estimate, stated, 0, 1),
                   noise_panel(errors, estimate, stated, 0, 2),
                   noise_panel(errors, estimate, stated, 1, 2)};
  figure.panel_width = 340.0;
  figure.panel_height = 340.0;
  return figure;
}

}  // namespace trussmap::plot
