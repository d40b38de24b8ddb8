// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "path_output.hpp"

#include "terminal.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t kLeftOutShown = 10;

/// How many fixes, or loops, and how many of them were left out.
struct TieCount {
  std::size_t all = 0;
  std::size_t left_out = 0;
};

TieCount count_of(const std::vector<BuiltPath>& paths, bool loops) {
  TieCount count;
  for (const BuiltPath& path : paths) {
    for (const PathTie& tie : path.ties) {
      if (tie.loop != loops) continue;
      ++count.all;
      if (tie.left_out) ++count.left_out;
    }
  }
  return count;
}

void print_left_out(const std::vector<BuiltPath>& paths, bool loops) {
  const TieCount count = count_of(paths, loops);
  if (count.all == 0) return;
  fmt::print("  {:<28} {:>8}  of {}\n", loops ? "loops left out" : "fixes left out", count.left_out,
             count.all);
  std::size_t shown = 0;
  for (const BuiltPath& path : paths) {
    const std::string where = paths.size() > 1 ? shortened_words(path.recording) + ", " : "";
    for (const PathTie& tie : path.ties) {
      if (tie.loop != loops || !tie.left_out || ++shown > kLeftOutShown) continue;
      if (loops) {
        fmt::print("    {}t = {:.3f} s to {:.3f} s: {:.2f} m from where the path has the robot\n",
                   where, tie.t, tie.t2, tie.misfit);
      } else {
        fmt::print("    {}t = {:.3f} s: {:.2f} m from where the path has the antenna\n", where,
                   tie.t, tie.misfit);
      }
    }
  }
  if (shown > kLeftOutShown) {
    fmt::print("    and {} more (--json lists all)\n", shown - kLeftOutShown);
  }
}

void print_truth(const PathOnTruth& truth) {
  fmt::print("\n  against the truth of {} rows, after rotation and translation:\n", truth.rows);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms error of the path", truth.rms);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", truth.rms_dead_reckoning);
}

void print_path(const BuiltPath& path) {
  fmt::print("  {:<28} {:>8.3f} m  (median; worst {:.3f} m, t = {:.1f} s)\n",
             "standard error of the path", path.median_sd, path.worst_sd, path.worst_t);
  fmt::print("  {:<28} {:>8.3f} m  (rms, after rotation and translation)\n",
             "dead reckoning is off by", path.rms_dead_reckoning);
}

}  // namespace

nlohmann::ordered_json paths_json(const std::vector<BuiltPath>& paths) {
  json result = json::array();
  for (const BuiltPath& path : paths) {
    json left_out = json::array();
    for (const PathTie& tie : path.ties) {
      if (!tie.left_out) continue;
      json one = {{"kind", tie.loop ? "loop" : "fix"}, {"t", tie.t}};
      if (tie.loop) one["t2"] = tie.t2;
      one["misfit_m"] = tie.misfit;
      left_out.push_back(std::move(one));
    }
    json one = {{"recording", path.recording},
                {"length_m", path.length},
                {"median_sd_m", path.median_sd},
                {"worst_sd_m", path.worst_sd},
                {"worst_t", path.worst_t},
                {"dead_reckoning_off_rms_m", path.rms_dead_reckoning},
                {"fixes", count_of({path}, false).all},
                {"loops", count_of({path}, true).all},
                {"left_out", left_out}};
    if (path.on_truth) {
      one["truth"] = {{"rows", path.on_truth->rows},
                      {"rms_m", path.on_truth->rms},
                      {"rms_dead_reckoning_m", path.on_truth->rms_dead_reckoning}};
    }
    result.push_back(std::move(one));
  }
  return result;
}

void print_paths_built(const std::vector<BuiltPath>& paths) {
  double length = 0.0;
  for (const BuiltPath& path : paths) length += path.length;
  fmt::print("no landmark was sighted: the path of {:.1f} m, adjusted to its {}\n", length,
             count_of(paths, true).all == 0    ? "fixes"
             : count_of(paths, false).all == 0 ? "loops"
                                               : "fixes and loops");
}

void print_paths(const BuiltMap& built) {
  const bool several = built.paths.size() > 1;
  if (!several) print_path(built.paths.front());
  fmt::print("  {:<28} {:>8.2f}  (chi^2/dof of {} degrees of freedom; 1: as the model says)\n",
             "dispersion of the errors", built.quality.dispersion, built.fit.dof);
  print_left_out(built.paths, false);
  print_left_out(built.paths, true);
  for (const BuiltPath& path : built.paths) {
    if (several) {
      fmt::print("\n  {}, {:.1f} m:\n", shortened_words(path.recording), path.length);
      print_path(path);
    }
    if (path.on_truth) print_truth(*path.on_truth);
  }
}

}  // namespace trussmap::app
