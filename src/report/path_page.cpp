// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/path_page.hpp"

#include "plot/path_picture.hpp"
#include "report/page.hpp"
#include "report/page_words.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

/// The fixes and loops that are furthest off among those left out.
PageTable left_out_table(const std::vector<BuiltPath>& paths) {
  constexpr std::size_t kMostRows = 60;
  struct Row {
    const BuiltPath* path;
    const PathTie* tie;
  };
  std::vector<Row> rows;
  for (const BuiltPath& path : paths) {
    for (const PathTie& tie : path.ties) {
      if (tie.left_out) rows.push_back({&path, &tie});
    }
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.tie->misfit > b.tie->misfit; });
  PageTable table;
  table.caption = rows.size() > kMostRows
                      ? fmt::format("The {} furthest off of {} left out", kMostRows, rows.size())
                      : "Left out";
  table.headings = {"what", "recording", "t [s]", "to t [s]", "off by [m]"};
  table.texts = 2;
  for (const Row& row : rows) {
    if (table.rows.size() == kMostRows) break;
    table.rows.push_back({row.tie->loop ? "loop" : "fix", row.path->recording,
                          fmt::format("{:.3f}", row.tie->t),
                          row.tie->loop ? fmt::format("{:.3f}", row.tie->t2) : "-",
                          fmt::format("{:.2f}", row.tie->misfit)});
  }
  return table;
}

void add_facts(PageContent& page, const BuiltMap& built) {
  const std::vector<BuiltPath>& paths = built.paths;
  page.facts.push_back({fmt::format("{:.3f} m", built.quality.median_sd),
                        "standard error of the path (median)", page.tone});
  double length = 0.0;
  std::size_t ties = 0;
  std::ptrdiff_t lost = 0;
  for (const BuiltPath& path : paths) {
    length += path.length;
    ties += path.ties.size();
    lost += std::count_if(path.ties.begin(), path.ties.end(),
                          [](const PathTie& one) { return one.left_out; });
    const std::string of = paths.size() > 1 ? ", " + path.recording : "";
    page.facts.push_back({fmt::format("{:.3f} m", path.rms_dead_reckoning),
                          "dead reckoning off the path (rms)" + of});
    if (!path.on_truth) continue;
    page.facts.push_back(
        {fmt::format("{:.3f} m", path.on_truth->rms), "path off the truth (rms)" + of});
    page.facts.push_back({fmt::format("{:.3f} m", path.on_truth->rms_dead_reckoning),
                          "dead reckoning off the truth (rms)" + of});
  }
  page.facts.push_back(
      {fmt::format("{:.2f}", built.quality.dispersion), "dispersion (1: as the model says)"});
  page.facts.push_back({fmt::format("{:.1f} m", length), "driven"});
  page.facts.push_back({fmt::format("{} of {}", lost, ties), "fixes and loops left out"});
}

}  // namespace

Page path_page(const BuiltMap& built, const std::string& subject) {
  PageContent page;
  page.command = "build";
  page.subject = subject;
  page.verdict = capitalised(verdict_in_words(built)) + ".";
  page.tone = built.good() ? Tone::good : Tone::bad;
  add_facts(page, built);
  if (!built.good()) page.notes.assign(built.warnings.begin() + 1, built.warnings.end());
  std::transform(page.notes.begin(), page.notes.end(), page.notes.begin(), typeset);
  page.notes.insert(page.notes.end(), built.notes.begin(), built.notes.end());
  page.sections.push_back({"The path", {ChartRow{plot::path_chart(built.paths)}}});
  PageTable table = left_out_table(built.paths);
  if (!table.rows.empty()) page.sections.push_back({"Left out", {std::move(table)}});
  return page;
}

}  // namespace trussmap::report
