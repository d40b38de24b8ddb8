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

}  // namespace trussmap::app
