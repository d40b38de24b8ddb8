// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/path_text.hpp"

#include "trussmap/table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

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

std::string left_out_text(const std::vector<BuiltPath>& paths, bool loops) {
  std::string text;
  const TieCount count = count_of(paths, loops);
  if (count.all == 0) return text;
  text += fmt::format("  {:<28} {:>8}  of {}\n", loops ? "loops left out" : "fixes left out",
                      count.left_out, count.all);
  std::size_t shown = 0;
  for (const BuiltPath& path : paths) {
    const std::string where = paths.size() > 1 ? shortened_words(path.recording) + ", " : "";
    for (const PathTie& tie : path.ties) {
      if (tie.loop != loops || !tie.left_out || ++shown > kLeftOutShown) continue;
      if (loops) {
        text += fmt::format(
            "    {}t = {:.3f} s to {:.3f} s: {:.2f} m from where the path has the robot\n", where,
            tie.t, tie.t2, tie.misfit);
      } else {
        text += fmt::format("    {}t = {:.3f} s: {:.2f} m from where the path has the antenna\n",
                            where, tie.t, tie.misfit);
      }
    }
  }
  if (shown > kLeftOutShown) {
    text += fmt::format("    and {} more (--json lists all)\n", shown - kLeftOutShown);
  }
  return text;
}

std::string truth_text(const PathOnTruth& truth) {
  std::string text;
  text += fmt::format("\n  against the truth of {} rows, after rotation and translation:\n",
                      truth.rows);
  text += fmt::format("  {:<28} {:>8.3f} m\n", "rms error of the path", truth.rms);
  text += fmt::format("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", truth.rms_dead_reckoning);
  return text;
}

std::string path_text(const BuiltPath& path) {
  std::string text;
  text += fmt::format("  {:<28} {:>8.3f} m  (median; worst {:.3f} m, t = {:.1f} s)\n",
                      "standard error of the path", path.median_sd, path.worst_sd, path.worst_t);
  text += fmt::format("  {:<28} {:>8.3f} m  (rms, after rotation and translation)\n",
                      "dead reckoning is off by", path.rms_dead_reckoning);
  return text;
}

}  // namespace

std::string paths_headline(const std::vector<BuiltPath>& paths) {
  std::string text;
  double length = 0.0;
  for (const BuiltPath& path : paths) length += path.length;
  text += fmt::format("no landmark was sighted: the path of {:.1f} m, adjusted to its {}\n", length,
                      count_of(paths, true).all == 0    ? "fixes"
                      : count_of(paths, false).all == 0 ? "loops"
                                                        : "fixes and loops");
  return text;
}

std::string paths_text(const BuiltMap& built) {
  std::string text;
  const bool several = built.paths.size() > 1;
  if (!several) text += path_text(built.paths.front());
  text +=
      fmt::format("  {:<28} {:>8.2f}  (chi^2/dof of {} degrees of freedom; 1: as the model says)\n",
                  "dispersion of the errors", built.quality.dispersion, built.fit.dof);
  text += left_out_text(built.paths, false) + left_out_text(built.paths, true);
  for (const BuiltPath& path : built.paths) {
    if (several) {
      text += fmt::format("\n  {}, {:.1f} m:\n", shortened_words(path.recording), path.length);
      text += path_text(path);
    }
    if (path.on_truth) text += truth_text(*path.on_truth);
  }
  return text;
}

}  // namespace trussmap::report
