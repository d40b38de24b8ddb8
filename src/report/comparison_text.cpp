// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "text/number_text.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string size_text(const Trend& trend) {
  if (trend.unit.empty()) return fmt::format("{:.2g} %", 100.0 * trend.size);
  if (trend.unit == "rad") return fmt::format("{:.2g} deg", trend.size * geometry::kDegrees);
  if (trend.unit == "m") return fmt::format("{:.2g} mm", 1e3 * trend.size);
  return fmt::format("{:.2g} {}", trend.size, trend.unit);
}

std::string signed_percent(double value) {
  return text::signed_fixed_text(100.0 * value, 2);
}
std::string signed_mrad(double value) {
  return text::signed_fixed_text(1e3 * value, 1);
}

std::string trends_text(const Comparison& result, TextStyle style) {
  std::string text;
  constexpr std::size_t kMost = 6;
  TextTable table{
      {Align::left, Align::left, Align::right, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"residual of", "goes with", "explains chi2", "size (rms)", "p, adjusted"});
  for (const Trend& trend : result.trends) {
    if (!result.tells(trend) || table.rows.size() > kMost) continue;
    table.rows.push_back({trend.kind, trend.against == "all" ? "everything alike" : trend.against,
                          fmt::format("{:.1f}", trend.score), size_text(trend),
                          probability_text(trend.p_adjusted)});
  }
  if (table.rows.size() == 1) {
    text += fmt::format("\nNo residual has a trend, of {} looked for.\n", result.trends.size());
    return text;
  }
  text += fmt::format("\nWhere the residuals go (of {} trends looked for)\n{}",
                      result.trends.size(), table_text(table, style));
  return text;
}

std::string worst_text(const Comparison& result, std::size_t count, TextStyle style) {
  std::string text;
  TextTable legs{
      {Align::left, Align::right, Align::right, Align::right, Align::right}, {}, true, 2};
  legs.rows.push_back({"leg", "t [s]", "chi2 (values)", "stretch [%]", "turned [mrad]"});
  for (std::size_t k = 0; k < std::min(count, result.worst.size()); ++k) {
    const LegMisfit& leg = result.worst[k];
    legs.rows.push_back({leg.from.empty() ? "-" : leg.from + " - " + leg.to,
                         fmt::format("{:.1f}", leg.t),
                         fmt::format("{:.1f} ({})", leg.chi2, leg.dof),
                         signed_percent(leg.stretch_error), signed_mrad(leg.orientation_error)});
  }
  if (legs.rows.size() > 1) text += fmt::format("\nWorst legs\n{}", table_text(legs, style));
  TextTable routes{
      {Align::left, Align::right, Align::right, Align::right, Align::right, Align::right},
      {},
      true,
      2};
  routes.rows.push_back(
      {"route", "driven", "chi2", "bar force [1/m]", "stretch [%]", "turned [mrad]"});
  for (std::size_t k = 0; k < std::min(count, result.routes.size()); ++k) {
    const RouteMisfit& route = result.routes[k];
    routes.rows.push_back({route.from + " - " + route.to, fmt::format("{}", route.traversals),
                           fmt::format("{:.1f}", route.chi2), fmt::format("{:+.0f}", route.force),
                           signed_percent(route.stretch_error),
                           signed_mrad(route.orientation_error)});
  }
  if (routes.rows.size() > 1)
    text += fmt::format("\nMost strained routes\n{}", table_text(routes, style));
  return text;
}

std::string sources_text(const Comparison& result, const Noise& noise, TextStyle style) {
  std::string text;
  constexpr double kSure = 3.0;
  constexpr double kLikely = 2.0;
  TextTable table{{Align::left, Align::right, Align::left}, {}, true, 2};
  table.rows.push_back({"noise of", "true/stated", "verdict"});
  for (const SourceCalibration& one : result.sources) {
    const double off = (one.factor - 1.0) / one.sd;
    table.rows.push_back({one.source, fmt::format("{:.2f} +- {:.2f}", one.factor, one.sd),
                          off > kSure      ? "stated too small, or an effect is missing"
                          : off < -kSure   ? "stated too large"
                          : off > kLikely  ? "perhaps stated too small"
                          : off < -kLikely ? "perhaps stated too large"
                                           : "as stated"});
  }
  for (const NoiseProcess& one : noise.processes) {
    table.rows.push_back({fmt::format("{}, {}", name_of(one.channel), name_of(one.process)), "-",
                          "taken as stated (fit --noise estimates it)"});
  }
  if (table.rows.size() > 1) text += fmt::format("\nNoise\n{}", table_text(table, style));
  return text;
}

std::string outliers_text(const Comparison& result, std::size_t count, TextStyle style) {
  std::string text;
  TextTable table{{Align::left, Align::right, Align::right}, {}, true, 2};
  table.rows.push_back({"contradicted by all others", "chi2 (values)", "p, adjusted"});
  for (std::size_t k = 0; k < std::min(count, result.outliers.size()); ++k) {
    const Outlier& one = result.outliers[k];
    table.rows.push_back({one.what, fmt::format("{:.1f} ({})", one.statistic, one.dof),
                          probability_text(one.p_adjusted)});
  }
  if (table.rows.size() > 1) text += fmt::format("\nOutliers\n{}", table_text(table, style));
  return text;
}

}  // namespace

std::string comparison_text(const Comparison& result, const Noise& stated,
                            const std::vector<NoiseBudget>& budget, std::size_t worst,
                            TextStyle style) {
  std::string text;
  const Mood mood = !result.consistent() ? Mood::bad : result.tested() ? Mood::good : Mood::doubt;
  text += fmt::format("{}\n", verdict_text(mood, verdict_in_words(result), style));
  text += fmt::format("  {}, p {}; {} legs, {} landmarks\n  {}\n",
                      fit_in_words(result.chi2, result.dof, result.coefficients),
                      probability_text(result.p_value), result.legs, result.landmarks,
                      in_words(result.held_out));
  text += trends_text(result, style);
  if (!result.consistent()) text += worst_text(result, worst, style);
  text += outliers_text(result, worst, style) + sources_text(result, stated, style);
  if (!result.lacks.empty()) text += "\nWhat these data lack\n";
  for (const std::string& line : in_words(result.lacks)) text += fmt::format("  {}\n", line);
  for (const std::string& warning : result.warnings) text += warning_text(warning, style);
  return text + budget_text(budget, style);
}

}  // namespace trussmap
