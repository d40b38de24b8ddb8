// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/path_picture.hpp"

#include "plot/layers.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

constexpr std::size_t kMostPoints = 4000;  // of all paths
constexpr std::size_t kMostTies = 2000;    // of each kind

/// Every so manieth, and the last.
std::vector<Vector2> fewer(const std::vector<Vector2>& path, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (path.size() + most - 1) / most);
  std::vector<Vector2> kept;
  for (std::size_t k = 0; k < path.size(); k += step) kept.push_back(path[k]);
  if ((path.size() - 1) % step != 0) kept.push_back(path.back());
  return kept;
}

std::vector<PathTie> ties_of(const std::vector<BuiltPath>& paths, bool loops, bool left_out) {
  std::vector<PathTie> all;
  for (const BuiltPath& path : paths) {
    std::copy_if(path.ties.begin(), path.ties.end(), std::back_inserter(all),
                 [&](const PathTie& one) { return one.loop == loops && one.left_out == left_out; });
  }
  std::vector<PathTie> kept;
  const std::size_t step = std::max<std::size_t>(1, (all.size() + kMostTies - 1) / kMostTies);
  for (std::size_t k = 0; k < all.size(); k += step) kept.push_back(all[k]);
  return kept;
}

std::string polyline(const std::vector<Vector2>& path, const PictureFrame& frame,
                     const char* kind) {
  std::string points;
  for (const Vector2& one : path) {
    points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", frame.x(one), frame.y(one));
  }
  return fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", kind, points);
}

void add_line(Chart& chart, const std::string& name, const std::vector<BuiltPath>& paths,
              std::vector<Vector2> BuiltPath::*which, LayerKind kind, const std::string& colour) {
  ChartLayer layer{kind, name, {{"x [m]"}, {"y [m]"}}, colour};
  for (const BuiltPath& path : paths) {
    for (const Vector2& one : fewer(path.*which, kMostPoints / paths.size() + 2)) {
      layer.columns[0].numbers.push_back(one.x());
      layer.columns[1].numbers.push_back(one.y());
    }
    for (ChartColumn& column : layer.columns) column.numbers.push_back(kAbsent);
  }
  chart.layers.push_back(std::move(layer));
}

void add_fixes(Chart& chart, const std::string& name, const std::vector<PathTie>& ties,
               const std::string& colour) {
  if (ties.empty()) return;
  ChartLayer layer{
      LayerKind::dots, name, {{"x [m]"}, {"y [m]"}, {"time [s]"}, {"off the path by [m]"}}, colour};
  for (const PathTie& tie : ties) {
    const double numbers[] = {tie.from.x(), tie.from.y(), tie.t, tie.misfit};
    for (std::size_t i = 0; i < 4; ++i) layer.columns[i].numbers.push_back(numbers[i]);
  }
  layer.size = 2.0;
  chart.layers.push_back(std::move(layer));
}

void add_loops(Chart& chart, const std::string& name, const std::vector<PathTie>& ties,
               const std::string& colour) {
  if (ties.empty()) return;
  ChartLayer layer{LayerKind::net, name, {{"x [m]"}, {"y [m]"}}, colour};
  for (const PathTie& tie : ties) {
    for (const Vector2& one : {tie.from, tie.to, Vector2(kAbsent, kAbsent)}) {
      layer.columns[0].numbers.push_back(one.x());
      layer.columns[1].numbers.push_back(one.y());
    }
  }
  chart.layers.push_back(std::move(layer));
}

}  // namespace

void include_paths(const std::vector<BuiltPath>& paths, PictureFrame& frame) {
  for (const BuiltPath& path : paths) {
    for (const Vector2& one : path.adjusted) frame.include(one);
    for (const Vector2& one : path.dead_reckoned) frame.include(one);
    for (const PathTie& tie : path.ties) frame.include(tie.from);
  }
}

std::string draw_paths(const std::vector<BuiltPath>& paths, const PictureFrame& frame) {
  std::string body;
  const std::size_t most = kMostPoints / std::max<std::size_t>(1, paths.size()) + 2;
  for (const BuiltPath& path : paths) {
    body += polyline(fewer(path.dead_reckoned, most), frame, "before");
  }
  for (const bool out : {false, true}) {
    for (const PathTie& tie : ties_of(paths, true, out)) {
      body += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n",
                          out ? "loop wrong" : "loop", frame.x(tie.from), frame.y(tie.from),
                          frame.x(tie.to), frame.y(tie.to));
    }
  }
  for (const BuiltPath& path : paths) body += polyline(fewer(path.adjusted, most), frame, "after");
  for (const bool out : {false, true}) {
    for (const PathTie& tie : ties_of(paths, false, out)) {
      body += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n",
                          out ? "fix wrong" : "fix", frame.x(tie.from), frame.y(tie.from),
                          out ? 2.5 : 1.5);
    }
  }
  return body;
}

Chart path_chart(const std::vector<BuiltPath>& paths) {
  Chart chart;
  chart.id = "path";
  chart.title = "The path, before and after";
  chart.caption =
      "Faint: dead reckoning, laid on the adjusted path by rotation and translation. A loop joins "
      "the two places of which it says how they lie to each other; what was left out contradicts "
      "the rest.";
  chart.x.title = "x [m]";
  chart.y.title = "y [m]";
  chart.equal_aspect = true;
  chart.height = 520.0;
  add_line(chart, "dead reckoning", paths, &BuiltPath::dead_reckoned, LayerKind::net, "faint");
  add_loops(chart, "loop left out", ties_of(paths, true, true), "bad");
  add_loops(chart, "loop", ties_of(paths, true, false), "3");
  add_line(chart, "adjusted", paths, &BuiltPath::adjusted, LayerKind::net, "ink");
  add_fixes(chart, "fix", ties_of(paths, false, false), "1");
  add_fixes(chart, "fix left out", ties_of(paths, false, true), "bad");
  return chart;
}

}  // namespace trussmap::plot
