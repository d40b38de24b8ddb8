// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "path_output.hpp"

#include <algorithm>
#include <cstddef>

namespace trussmap::app {
namespace {

using Json = nlohmann::ordered_json;

/// How many fixes, or loops.
std::ptrdiff_t ties_of(const BuiltPath& path, bool loops) {
  return std::ranges::count(path.ties, loops, &PathTie::loop);
}

}  // namespace

nlohmann::ordered_json paths_json(const std::vector<BuiltPath>& paths) {
  Json result = Json::array();
  for (const BuiltPath& path : paths) {
    Json left_out = Json::array();
    for (const PathTie& tie : path.ties) {
      if (!tie.left_out) continue;
      Json one = {{"kind", tie.loop ? "loop" : "fix"}, {"t", tie.t}};
      if (tie.loop) one["t2"] = tie.t2;
      one["misfit_m"] = tie.misfit;
      left_out.push_back(std::move(one));
    }
    Json one = {
        {"recording", path.recording},   {"length_m", path.length},
        {"median_sd_m", path.median_sd}, {"worst_sd_m", path.worst_sd},
        {"worst_t", path.worst_t},       {"dead_reckoning_off_rms_m", path.rms_dead_reckoning},
        {"fixes", ties_of(path, false)}, {"loops", ties_of(path, true)},
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
