// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/texts.hpp"

#include <fmt/format.h>

namespace trussmap {

std::string pose_graph_text(const PoseGraph& graph, const PoseGraphAdjustment& result,
                            std::optional<std::size_t> left_out, double seconds, TextStyle style) {
  std::string text = result.converged
                         ? verdict_text(Mood::good, "adjusted: converged to a minimum\n", style)
                         : verdict_text(Mood::bad, "NOT CONVERGED", style) + "\n";
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<18}{}\n", name, value);
  };
  row("chi2", fmt::format("{:.10g}", result.chi2));
  row("dof", fmt::format("{}", result.dof));
  if (result.dof > 0) row("chi2/dof", fmt::format("{:.6g}", result.chi2 / result.dof));
  row("poses", fmt::format("{}", count_poses(graph)));
  row("landmarks", fmt::format("{}", count_points(graph)));
  row("edges", fmt::format("{}", graph.edges()));
  if (left_out) row("edges left out", fmt::format("{}", *left_out));
  row("iterations", fmt::format("{}", result.iterations));
  row("gradient norm", fmt::format("{:.3g}", result.gradient_norm));
  row("started from", result.start);
  row("time", fmt::format("{:.3f} s", seconds));
  for (const std::string& warning : result.warnings) text += warning_text(warning, style);
  return text;
}

}  // namespace trussmap
