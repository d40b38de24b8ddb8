// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap adjust: the best fit of a plain pose graph.
#include "trussmap/adjustment/pose_graph_adjustment.hpp"
#include "trussmap/io/atomic_file.hpp"
#include "trussmap/io/g2o.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"

namespace trussmap::app {
namespace {

struct AdjustOptions {
  std::string graph;
  std::string out;
  std::string json;
  StartFrom start = StartFrom::best;
};

/// Everything that the table and the JSON file say.
struct Run {
  PoseGraphAdjustment result;
  int poses = 0;
  int landmarks = 0;
  std::size_t edges = 0;
  double seconds = 0.0;
};

std::string table(const Run& run) {
  const PoseGraphAdjustment& r = run.result;
  std::string text = r.converged ? "adjusted: converged to a minimum\n" : "NOT CONVERGED\n";
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<18}{}\n", name, value);
  };
  row("chi2", fmt::format("{:.10g}", r.chi2));
  row("dof", fmt::format("{}", r.dof));
  if (r.dof > 0) row("chi2/dof", fmt::format("{:.6g}", r.chi2 / r.dof));
  row("poses", fmt::format("{}", run.poses));
  row("landmarks", fmt::format("{}", run.landmarks));
  row("edges", fmt::format("{}", run.edges));
  row("iterations", fmt::format("{}", r.iterations));
  row("gradient norm", fmt::format("{:.3g}", r.gradient_norm));
  row("started from", r.start);
  row("time", fmt::format("{:.3f} s", run.seconds));
  for (const std::string& warning : r.warnings) text += "warning: " + warning + "\n";
  return text;
}

nlohmann::ordered_json json(const Run& run) {
  const PoseGraphAdjustment& r = run.result;
  return {{"chi2", r.chi2},
          {"dof", r.dof},
          {"iterations", r.iterations},
          {"gradient_norm", r.gradient_norm},
          {"poses", run.poses},
          {"landmarks", run.landmarks},
          {"edges", run.edges},
          {"converged", r.converged},
          {"start", r.start},
          {"seconds", run.seconds},
          {"warnings", r.warnings}};
}

void run_adjust(const AdjustOptions& options) {
  PoseGraph graph = read_g2o(options.graph);
  const auto has_estimate = [](const GraphVertex& vertex) { return vertex.estimate.has_value(); };
  if (options.start == StartFrom::file &&
      !std::all_of(graph.vertices.begin(), graph.vertices.end(), has_estimate)) {
    throw UsageError(options.graph + " has no VERTEX lines to start from, expected --start " +
                     "odometry or best");
  }
  AdjustmentOptions adjustment;
  adjustment.start = options.start;
  const auto begin = std::chrono::steady_clock::now();
  Run run;
  run.result = adjust(graph, adjustment);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.poses = count_poses(graph);
  run.landmarks = count_points(graph);
  run.edges = graph.edges();
  if (!options.out.empty()) {
    for (std::size_t v = 0; v < graph.vertices.size(); ++v) {
      graph.vertices[v].estimate = run.result.estimates[v];
    }
    write_g2o(graph, options.out);
  }
  if (!options.json.empty()) write_file(options.json, json(run).dump(2) + "\n");
  fmt::print("{}", table(run));
}

}  // namespace

void setup_adjust(CLI::App& app) {
  auto options = std::make_shared<AdjustOptions>();
  CLI::App* command = app.add_subcommand(
      "adjust",
      "Find the poses and landmarks of least chi2 for a pose graph.\n"
      "Reads g2o (VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_POINTXY, FIX) and TORO "
      "(VERTEX2, EDGE2) files, plain or .xz; metres and radians.");
  command->add_option("GRAPH", options->graph, "the pose graph to adjust")->required();
  command->add_option("--out", options->out, "write the adjusted graph to this g2o file");
  command->add_option("--json", options->json, "write the result to this file as JSON");
  const std::map<std::string, StartFrom> starts{
      {"best", StartFrom::best}, {"file", StartFrom::file}, {"odometry", StartFrom::odometry}};
  command
      ->add_option("--start", options->start,
                   "what to start from: file (the file's estimates, then check against starts "
                   "drawn from the measurements), odometry (the measurements alone), best (both, "
                   "as needed)")
      ->transform(CLI::CheckedTransformer(starts, CLI::ignore_case))
      ->default_str("best");
  command->callback([options] { run_adjust(*options); });
}

}  // namespace trussmap::app
