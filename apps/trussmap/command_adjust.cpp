// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap adjust: the best fit of a plain pose graph.
#include "commands.hpp"
#include "distributed_adjust.hpp"
#include "graph_options.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"
#include "progress.hpp"
#include "results/json.hpp"
#include "results/pose_graphs.hpp"
#include "terminal.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct AdjustOptions {
  std::string graph;
  std::string out;
  std::string json;
  std::string start = "best";
  bool robust = false;
  double gate = RobustOptions{}.gate;
  std::string solver = "frontal";
  double tolerance = DistributedAdjustOptions{}.tolerance;
  std::string edge2 = kEdge2ByName;
};

AdjustmentOptions adjustment_options(const AdjustOptions& options, const PoseGraph& graph) {
  const auto has_estimate = [](const GraphVertex& vertex) { return vertex.estimate.has_value(); };
  if (options.start == "file" &&
      !std::all_of(graph.vertices.begin(), graph.vertices.end(), has_estimate)) {
    throw UsageError(options.graph + " has no VERTEX lines to start from, expected --start " +
                     "odometry or best");
  }
  AdjustmentOptions result;
  if (options.start == "file") result.start = StartFrom::file;
  if (options.start == "odometry") result.start = StartFrom::odometry;
  return result;
}

results::AdjustReport adjust_graph(const AdjustOptions& options, const PoseGraph& graph) {
  const AdjustmentOptions how = adjustment_options(options, graph);
  results::AdjustReport run;
  run.poses = count_poses(graph);
  run.landmarks = count_points(graph);
  run.edges = graph.edges();
  const auto begin = std::chrono::steady_clock::now();
  if (options.robust) {
    RobustAdjustment robust = adjust_robustly(graph, {how, options.gate});
    run.result = std::move(robust.adjustment);
    run.left_out.emplace();
    for (const int k : robust.left_out) {
      const PoseEdge& edge = graph.pose_edges.at(static_cast<std::size_t>(k));
      const auto id_of = [&graph](int vertex) {
        return graph.vertices.at(static_cast<std::size_t>(vertex)).id;
      };
      run.left_out->emplace_back(id_of(edge.from), id_of(edge.to));
    }
  } else {
    run.result = adjust(graph, how);
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

/// Checking takes as long as adjusting: of larger graphs only where something is wrong with them.
constexpr std::size_t kQuicklyChecked = 10000;  // edges

bool misfits(const PoseGraphAdjustment& result) {
  constexpr double kTooMuch = 2.0;  // chi^2 per degree of freedom
  return result.dof > 0 && result.chi2 > kTooMuch * result.dof;
}

void run_adjust(const AdjustOptions& options) {
  if (options.solver != "frontal") {
    run_distributed_adjust(
        {options.graph, options.out, options.json, options.solver, options.tolerance});
    return;
  }
  Progress progress({{"reading", 20}, {"checking", 20}, {"adjusting", 60}});
  progress.next();
  PoseGraph graph = read_g2o(options.graph, edge2_named(options.edge2));
  progress.next();
  const bool small = graph.edges() <= kQuicklyChecked;
  if (small) warn_of_graph_mistakes(graph, options.graph);
  progress.next();
  const results::AdjustReport run = adjust_graph(options, graph);
  if (!small && misfits(run.result)) warn_of_graph_mistakes(graph, options.graph);
  Files files;
  if (!options.out.empty()) {
    for (std::size_t v = 0; v < graph.vertices.size(); ++v) {
      graph.vertices[v].estimate = run.result.estimates[v];
    }
    files.emplace_back(options.out, format_g2o(graph));
  }
  if (!options.json.empty()) files.emplace_back(options.json, results::json_text(run));
  files.write();
  progress.end();
  const std::optional<std::size_t> left_out =
      run.left_out ? std::optional(run.left_out->size()) : std::nullopt;
  fmt::print("{}", pose_graph_text(graph, run.result, left_out, run.seconds, style_of(stdout)));
}

/// Options that belong to one solver are not given with another.
void check_solver(const Command& command, const AdjustOptions& options) {
  if (options.solver == "frontal") {
    if (command.count("--tolerance") == 0) return;
    throw UsageError("--tolerance is given without --solver petsc or mumps, to which it belongs");
  }
  if (command.count("--edge2") > 0) {
    throw UsageError(fmt::format("--edge2 is given with --solver {}, which reads no EDGE2 lines",
                                 options.solver));
  }
  for (const char* name : {"--start", "--robust"}) {
    if (command.count(name) == 0) continue;
    throw UsageError(
        fmt::format("{} is given with --solver {}, expected without: a truss has one "
                    "minimum, whatever the start, and every route counts",
                    name, options.solver));
  }
}

}  // namespace

void setup_adjust(const Command& app) {
  auto options = std::make_shared<AdjustOptions>();
  const Command command = app.add_subcommand(
      "adjust", "Adjust a pose graph: find the poses and landmarks of least chi2");
  command.add_option("GRAPH", options->graph, "Pose graph to adjust, m and rad")
      .required()
      .type_name("FILE");
  command.add_option("--out", options->out, "Write the adjusted graph as g2o").type_name("FILE");
  command.add_option("--json", options->json, "Write every figure as JSON").type_name("FILE");
  command
      .add_option("--start", options->start,
                  "Estimates to start from: the file's, those that odometry gives (the file's "
                  "are ignored), or the best of both; in each case other starts, drawn from the "
                  "measurements, are tried as well and the lowest chi2 is kept")
      .check(one_of({"best", "file", "odometry"}))
      .capture_default_str();
  command.add_flag("--robust", options->robust,
                   "Leave out loop closures that contradict the rest, and say which");
  command
      .add_option("--gate", options->gate,
                  "With --robust: leave loop closures out whose e'Omega e, against the best fit of "
                  "all others, exceeds this (squared standard deviations)")
      .check(above_zero())
      .capture_default_str();
  command
      .add_option(
          "--solver", options->solver,
          fmt::format("frontal: one machine, any graph. petsc, mumps: by all processes of mpirun "
                      "-n N trussmap adjust, landmarks and displacements (VERTEX_XY, EDGE_POINTXY) "
                      "of any number: conjugate gradients with multigrid, or an exact factor{}",
                      distributed_note()))
      .check(one_of({"frontal", "petsc", "mumps"}))
      .capture_default_str();
  command
      .add_option("--tolerance", options->tolerance,
                  "With --solver petsc or mumps: |f - K u| to be reached, against |f|")
      .check(between(1e-15, 0.1))
      .capture_default_str();
  add_edge2(command, options->edge2);
  command.footer(
      "Formats: g2o (VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_POINTXY, FIX) and TORO\n"
      "(VERTEX2, EDGE2), iSAM (ODOMETRY or EDGE2, LANDMARK), plain or .xz. Without FIX the first "
      "vertex stays where it is. What trussmap check finds is said as warnings first.");
  command.callback([options, command] {
    if (command.count("--gate") > 0 && !options->robust) {
      throw UsageError("--gate is given without --robust, to which it belongs");
    }
    check_solver(command, *options);
    run_adjust(*options);
  });
}

}  // namespace trussmap::app
