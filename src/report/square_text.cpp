// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/quantity_cells.hpp"
#include "trussmap/texts.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

std::string verdict(const SquareRound& round, std::size_t number) {
  const SquareClusters& clusters = round.clusters;
  const QuantityText size =
      quantity_text(clusters.largest_offset.value, clusters.largest_offset.standard_error);
  const std::string again = number > 1 ? "still " : "";
  if (!round.doubts.empty()) {
    return fmt::format("doubtful: systematic error {} m; correct by it once {} below {} settled\n",
                       size.value, round.doubts.size() == 1 ? "the warning" : "the warnings",
                       round.doubts.size() == 1 ? "is" : "are");
  }
  const std::string limit =
      fmt::format("three standard errors of a centre, {:#.2g} m", 3.0 * clusters.sem);
  return clusters.second_round_worthwhile
             ? fmt::format("{}worth correcting: systematic error {} m, more than {}\n", again,
                           size.value, limit)
             : fmt::format("nothing left to correct: systematic error {} m, within {}\n",
                           size.value, limit);
}

std::string corrections_text(const SquareRound& round, SquareMethod method, TextStyle style) {
  const SquareCorrections use = corrections_after(round, method);
  TextTable table{{Align::left, Align::right, Align::left, Align::left}, {}, false, 4};
  const auto row = [&](const char* name, const Estimate& value, const char* unit) {
    std::vector<std::string> cells = quantity_cells(value);
    table.rows.push_back({name, cells[0], cells[1], unit});
  };
  row("wheelbase", use.wheelbase, "m");
  row("left wheel's travel times", use.left_factor, "");
  row("right wheel's travel times", use.right_factor, "");
  return fmt::format("\n  {} ({}):\n{}",
                     round.doubts.empty() ? "Use from now on" : "What the runs come to as they are",
                     method == SquareMethod::exact ? "exact solution" : "the papers' formulas",
                     table_text(table, style));
}

std::string solutions_text(const SquareRound& round, TextStyle style) {
  TextTable table;
  table.columns = {Align::left, Align::right, Align::left, Align::right, Align::left};
  table.has_heading = true;
  table.rows.push_back({"", "exact", "", "formulas", ""});
  if (round.headings) {
    table.columns.insert(table.columns.end(), {Align::right, Align::left});
    table.rows.front().insert(table.rows.front().end(), {"headings", ""});
  }
  table.columns.push_back(Align::left);
  table.rows.front().push_back("unit");
  const auto row = [&](const char* name, Estimate SquareSolution::*member,
                       Estimate SquareHeadings::*by_heading, const char* unit) {
    std::vector<std::string> cells = {name};
    const auto add = [&](const Estimate& value) {
      for (const std::string& cell : quantity_cells(value)) cells.push_back(cell);
    };
    add(round.exact.*member);
    add(round.formulas.*member);
    if (round.headings) add((*round.headings).*by_heading);
    cells.emplace_back(unit);
    table.rows.push_back(std::move(cells));
  };
  row("E_d  right wheel / left wheel", &SquareSolution::diameter_ratio,
      &SquareHeadings::diameter_ratio, "");
  row("E_b  wheelbase / believed", &SquareSolution::wheelbase_ratio,
      &SquareHeadings::wheelbase_ratio, "");
  row("alpha  missing per quarter turn", &SquareSolution::alpha, &SquareHeadings::alpha, "rad");
  row("beta  turned per leg", &SquareSolution::beta, &SquareHeadings::beta, "rad");
  return "\n" + table_text(table, style);
}

std::string clusters_text(const SquareRound& round, TextStyle style) {
  TextTable table;
  table.columns = {Align::left,  Align::right, Align::right, Align::left,
                   Align::right, Align::left,  Align::right};
  table.has_heading = true;
  table.rows.push_back({"centre", "runs", "x [m]", "", "y [m]", "", "distance [m]"});
  if (round.headings) {
    table.columns.insert(table.columns.end(), {Align::right, Align::left});
    table.rows.front().insert(table.rows.front().end(), {"heading [mrad]", ""});
  }
  for (const auto& [name, mean] :
       {std::pair("cw", &round.clusters.cw), std::pair("ccw", &round.clusters.ccw)}) {
    const auto x = quantity_cells({mean->mean.x(), std::sqrt(mean->covariance(0, 0)), 0.0});
    const auto y = quantity_cells({mean->mean.y(), std::sqrt(mean->covariance(1, 1)), 0.0});
    table.rows.push_back({name, std::to_string(mean->count), x[0], x[1], y[0], y[1],
                          fmt::format("{:.4f}", mean->mean.norm())});
    if (!round.headings) continue;
    const Estimate& heading = mean == &round.clusters.cw ? round.headings->cw : round.headings->ccw;
    for (const std::string& cell :
         quantity_cells({1000.0 * heading.value, 1000.0 * heading.standard_error, 0.0})) {
      table.rows.back().push_back(cell);
    }
  }
  return "\n" + table_text(table, style);
}

/// E_s, where a straight run has measured it.
std::string scale_text(const Estimate& scale) {
  if (scale.value == 1.0 && scale.dof == 0.0) return "";
  const QuantityText text = quantity_text(scale.value, scale.standard_error);
  return fmt::format("\n  The scale of the straight run{}, E_s = {}{}, is in all three.\n",
                     scale.dof > 0.0 ? "s" : "", text.value,
                     text.error.empty() ? " (two runs or more give it a standard error)"
                                        : " \u00b1 " + text.error);
}

std::string one_way_text(const SquareRound& round) {
  const OneWayTuning one_way = tune_one_way(round.exact.errors(), round.setup, Direction::ccw);
  return fmt::format(
      "\n  Driven ccw alone, the wheelbase could be tuned until {:.3f} m became {:.3f} m; cw, "
      "{:.3f} "
      "m\n  would be left. That is why the square is driven both ways.\n",
      one_way.error_before, one_way.error_same_way, one_way.error_other_way);
}

}  // namespace

std::string_view square_verdict(const SquareRound& round) {
  if (!round.doubts.empty()) return "doubtful";
  return round.clusters.second_round_worthwhile ? "worth correcting" : "nothing left to correct";
}

std::string paths_alone_text(const std::vector<PathAlone>& paths, TextStyle style) {
  if (paths.empty()) return "";
  TextTable table;
  table.columns = {Align::left, Align::right, Align::right, Align::right, Align::right};
  table.has_heading = true;
  table.rows.push_back({"path alone", "ends off [m]", "with the wheelbase tuned [m]",
                        "a square then, cw [m]", "ccw [m]"});
  for (const PathAlone& one : paths) {
    table.rows.push_back({one.path, fmt::format("{:.3f}", one.tuned.error_before),
                          fmt::format("{:.3f}", one.tuned.error_after),
                          fmt::format("{:.3f}", one.tuned.square_cw),
                          fmt::format("{:.3f}", one.tuned.square_ccw)});
  }
  return "\n" + table_text(table, style);
}

std::string square_text(const std::vector<SquareRound>& rounds, SquareMethod method,
                        TextStyle style) {
  const bool good = rounds.back().doubts.empty() && !rounds.back().clusters.second_round_worthwhile;
  std::string out =
      verdict_text(good ? Mood::good : Mood::doubt, verdict(rounds.back(), rounds.size()), style);
  if (rounds.size() > 1) {
    TextTable table{{Align::left, Align::right, Align::left, Align::left}, {}, false, 2};
    for (std::size_t k = 0; k < rounds.size(); ++k) {
      const auto cells = quantity_cells(rounds[k].clusters.largest_offset);
      table.rows.push_back(
          {fmt::format("round {}: systematic error", k + 1), cells[0], cells[1], "m"});
    }
    out += "\n" + table_text(table, style);
  }
  const SquareRound& last = rounds.back();
  if (rounds.size() > 1 && last.clusters.sem > 0.0 && !last.clusters.second_round_worthwhile) {
    out +=
        "\n  The last round's own corrections are within its scatter; those of the rounds before\n"
        "  would do as well.\n";
  }
  out += corrections_text(last, method, style) + scale_text(rounds.front().setup.scale) +
         solutions_text(last, style) + clusters_text(last, style);
  const bool sure = last.doubts.empty() && last.clusters.second_round_worthwhile;
  if (rounds.size() == 1 && sure) out += one_way_text(last);
  return out + warnings_text(all_doubts(rounds), style);
}

}  // namespace trussmap
