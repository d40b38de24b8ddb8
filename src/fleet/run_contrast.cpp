// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap {
namespace {

using nlohmann::json;

std::optional<double> number_in(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const auto value = found->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// chi^2 and how far off legs end, of the object that has both.
void read_errors(const json& from, RunFigures& run) {
  const std::optional<double> chi2 = number_in(from, "chi2");
  const std::optional<double> dof = number_in(from, "dof");
  if (chi2 && dof && *dof >= 1.0) {
    run.figures.push_back({"chi2/dof", "", *chi2 / *dof, 0.0, *dof});
  }
  const auto held = from.find("heldout");
  if (held == from.end() || !held->is_object()) return;
  const std::optional<double> rms = number_in(*held, "arrival_rms_m");
  const std::optional<double> legs = number_in(*held, "legs");
  if (!rms || !legs || *legs < 1.0) return;
  // Each leg ends off by two numbers.
  run.figures.push_back({"held-out legs end off", "m", *rms, 0.0, 2.0 * *legs});
}

void read_effect(const json& one, RunFigures& run) {
  const auto name = one.at("effect").get<std::string>();
  const json& shapes = one.at("shape");
  const json& sizes = one.at("coefficients");
  const json& errors = one.at("sd");
  const bool single = sizes.size() == 1;
  for (std::size_t k = 0; k < sizes.size() && k < errors.size(); ++k) {
    if (!sizes[k].is_number() || !errors[k].is_number()) continue;
    const std::string shape = k < shapes.size() ? shapes[k].get<std::string>() : "";
    run.figures.push_back({single ? "effect " + name : fmt::format("effect {}: {}", name, shape),
                           "", sizes[k].get<double>(), errors[k].get<double>(), 0.0});
  }
}

RunFigures figures_in(const json& whole) {
  RunFigures run;
  if (const auto verdict = whole.find("verdict"); verdict != whole.end() && verdict->is_string()) {
    run.verdict = verdict->get<std::string>();
  }
  const auto steps = whole.find("steps");
  const bool stepwise = steps != whole.end() && steps->is_array() && !steps->empty();
  read_errors(stepwise ? steps->back() : whole, run);
  if (const auto constants = whole.find("constants"); constants != whole.end()) {
    for (const json& one : *constants) {
      const std::optional<double> value = number_in(one, "new");
      if (!value) continue;  // not determined
      run.figures.push_back({one.at("name").get<std::string>(), one.at("unit").get<std::string>(),
                             *value, number_in(one, "sd").value_or(0.0), 0.0});
    }
  }
  if (const auto effects = whole.find("effects"); effects != whole.end()) {
    for (const json& one : *effects) read_effect(one, run);
  }
  return run;
}

std::optional<RunFigure> same_in(const RunFigures& run, const RunFigure& figure) {
  const auto found = std::ranges::find_if(run.figures, [&figure](const RunFigure& one) {
    return one.name == figure.name && one.unit == figure.unit;
  });
  return found == run.figures.end() ? std::nullopt : std::optional(*found);
}

/// That two figures are the same but for chance; nothing where one does not say how sure it is.
std::optional<double> p_value(const FigureChange& change) {
  const RunFigure& before = *change.before;
  const RunFigure& now = *change.now;
  if (before.dof > 0.0 && now.dof > 0.0) {
    // Of errors: sums of squares, each over its own degrees of freedom.
    const double power = before.unit.empty() ? 1.0 : 2.0;
    if (!(before.value > 0.0) || !(now.value > 0.0)) return std::nullopt;
    const double ratio = std::pow(now.value / before.value, power);
    const double above = statistics::fisher_p_value(ratio, now.dof, before.dof);
    const double below = statistics::fisher_p_value(1.0 / ratio, before.dof, now.dof);
    return std::min(1.0, 2.0 * std::min(above, below));
  }
  const double sd = change.change_sd();
  if (!(before.sd > 0.0) || !(now.sd > 0.0) || !std::isfinite(sd)) return std::nullopt;
  return statistics::chi2_p_value(std::pow(change.change() / sd, 2), 1);
}

}  // namespace

bool RunContrast::any_changed() const {
  return std::ranges::any_of(figures, [](const FigureChange& one) { return one.changed; });
}

std::size_t RunContrast::told() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      figures, [](const FigureChange& one) { return one.p_value.has_value(); }));
}

RunFigures read_run_figures(const std::filesystem::path& file) {
  const std::string name = file.string();
  try {
    const json whole = json::parse(read_file(file));
    RunFigures run = whole.is_object() ? figures_in(whole) : RunFigures{};
    if (!run.figures.empty()) return run;
  } catch (const json::exception&) {  // said below
  }
  throw InputError(name, 0,
                   "no run that can be compared, expected what compare, fit, diagnose, discover or "
                   "calibrate wrote with --json");
}

RunContrast contrast_runs(const RunFigures& before, const RunFigures& now, double level) {
  RunContrast result{before.verdict, now.verdict, level, {}};
  for (const RunFigure& one : before.figures) {
    FigureChange change{one.name, one.unit, one, std::nullopt, std::nullopt, false};
    change.now = same_in(now, one);
    if (change.now) change.p_value = p_value(change);
    result.figures.push_back(std::move(change));
  }
  for (const RunFigure& one : now.figures) {
    if (same_in(before, one)) continue;
    result.figures.push_back({one.name, one.unit, std::nullopt, one, std::nullopt, false});
  }
  std::vector<double> p_values;
  for (const FigureChange& one : result.figures) {
    if (one.p_value) p_values.push_back(*one.p_value);
  }
  const std::vector<double> adjusted = statistics::holm(p_values);
  auto next = adjusted.begin();
  for (FigureChange& one : result.figures) {
    if (one.p_value) one.changed = *next++ < level;
  }
  return result;
}

}  // namespace trussmap
