// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed_adjust.hpp"

#include "page_runtime.hpp"
#include "results/json.hpp"
#include "results/pose_graphs.hpp"
#include "team.hpp"
#include "terminal.hpp"
#include "trussmap/distributed.hpp"

#include <string_view>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct Run {
  DistributedAdjustment result;
  int processes = 1;
};

std::string table(const Run& run, const std::string& solver) {
  const DistributedAdjustment& r = run.result;
  std::string text = r.converged ? verdict_text(Mood::good, "adjusted: converged to the minimum\n")
                                 : verdict_text(Mood::bad, "NOT CONVERGED") + "\n";
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<18}{}\n", name, value);
  };
  row("chi2", fmt::format("{:.10g}", r.chi2));
  row("dof", fmt::format("{}", r.dof));
  if (r.dof > 0) row("chi2/dof", fmt::format("{:.6g}", r.chi2 / static_cast<double>(r.dof)));
  row("landmarks", fmt::format("{}", r.landmarks));
  row("edges", fmt::format("{}", r.routes));
  row("solver", fmt::format("{}, {} processes", solver, run.processes));
  row("iterations", fmt::format("{}", r.iterations));
  row("relative residual", fmt::format("{:.3g}", r.residual));
  if (r.complexity > 0.0) row("levels' entries", fmt::format("{:.3g} of K's", r.complexity));
  row("time",
      fmt::format("{:.3f} s: reading {:.3f}, preparing {:.3f}, solving {:.3f}, writing "
                  "{:.3f}",
                  r.seconds_reading + r.seconds_preparing + r.seconds_solving + r.seconds_writing,
                  r.seconds_reading, r.seconds_preparing, r.seconds_solving, r.seconds_writing));
  return text;
}

}  // namespace

void run_distributed_adjust(const DistributedAdjustOptions& options) {
  Run run;
  DistributedOptions how;
  if (options.solver == "mumps") how.solver = DistributedOptions::Solver::mumps;
  how.tolerance = options.tolerance;
  how.out = options.out;
  const bool first = run_together(true, [&](const Team& team) {
    run.processes = team.count();
    run.result = adjust_distributed(*team.processes(), options.graph, how);
  });
  if (!first) return;
  Files files;
  if (!options.json.empty()) {
    files.emplace_back(options.json, results::json_text(results::DistributedReport{
                                         run.result, options.solver, run.processes}));
  }
  files.write();
  fmt::print("{}", table(run, options.solver));
}

std::string distributed_note() {
  return "";
}

}  // namespace trussmap::app
