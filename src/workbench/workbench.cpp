// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/workbench.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

constexpr std::size_t kKept = 4;
constexpr std::size_t kLegsOfSmallRecordings = 1000;  // beyond, a model takes much memory

void check(const WorkbenchLog& log) {
  if (log.steps.empty() || log.at >= log.steps.size()) {
    throw std::invalid_argument("a workbench's log needs its steps, and to be at one of them");
  }
  for (std::size_t k = 0; k < log.steps.size(); ++k) {
    if (k == 0 ? log.steps[k].from != 0 : log.steps[k].from >= k) {
      throw std::invalid_argument("step " + std::to_string(k) +
                                  " of a workbench's log comes from none before it");
    }
  }
}

void put_figures(WorkbenchStep& step, const TriedModel& model) {
  const HeldOut& held_out = model.diagnosis().held_out;
  step.arrival_rms = held_out.arrival_rms;
  step.expected_rms = held_out.expected_rms;
  step.chi2 = model.fit().chi2;
  step.dof = model.fit().dof;
}

}  // namespace

std::vector<std::size_t> way_to(const WorkbenchLog& log, std::size_t step) {
  std::vector<std::size_t> way{step};
  while (way.back() != 0) way.push_back(log.steps.at(way.back()).from);
  std::reverse(way.begin(), way.end());
  return way;
}

Workbench::Workbench(std::vector<Recording> recordings, const Model& model,
                     const DiagnoseOptions& options, const WorkbenchWatch& watch)
    : recordings_(std::make_shared<const std::vector<Recording>>(std::move(recordings))),
      options_(options) {
  options_.fit.fit_effects = true;
  WorkbenchStep given;
  given.model = model;
  take(std::move(given), watch);
}

Workbench::Workbench(std::vector<Recording> recordings, WorkbenchLog log,
                     const DiagnoseOptions& options, const WorkbenchWatch& watch)
    : recordings_(std::make_shared<const std::vector<Recording>>(std::move(recordings))),
      options_(options),
      log_(std::move(log)) {
  check(log_);
  options_.fit.fit_effects = true;
  now_ = tried(log_, watch);
  kept_.emplace_back(log_.at, *now_);
}

/// The model at which this log is. By stated noise first, where somebody watches: what takes most
/// of the time is to estimate the noise, where there is more of it than stated.
TriedModel Workbench::tried(const WorkbenchLog& log, const WorkbenchWatch& watch) const {
  const Model& model = log.steps[log.at].model;
  if (watch.provisional && options_.estimate_noise) {
    DiagnoseOptions as_stated = options_;
    as_stated.estimate_noise = false;
    TriedModel first(recordings_, model, as_stated, watch.progress);
    const bool fits = first.fit().p_value > kSignificance;
    if (fits && first.diagnosis().verdict != Diagnosis::Verdict::missing) return first;
    WorkbenchLog with = log;
    put_figures(with.steps[with.at], first);
    watch.provisional(first, with);
  }
  return {recordings_, model, options_, watch.progress};
}

/// Nothing is changed until the model has been tried.
void Workbench::take(WorkbenchStep step, const WorkbenchWatch& watch) {
  WorkbenchLog log = log_;
  log.steps.push_back(std::move(step));
  log.at = log.steps.size() - 1;
  TriedModel model = tried(log, watch);
  put_figures(log.steps.back(), model);
  const std::size_t most = model.comparison().legs > kLegsOfSmallRecordings ? 1 : kKept;
  kept_.emplace_back(log.at, model);
  if (kept_.size() > most) kept_.erase(kept_.begin());
  log_ = std::move(log);
  now_ = std::move(model);
}

void Workbench::add(const Effect& effect, const WorkbenchWatch& watch) {
  WorkbenchStep step;
  step.kind = WorkbenchStep::Kind::add;
  step.effect = effect.name;
  step.from = log_.at;
  step.model = log_.steps[log_.at].model;
  for (const Effect& one : step.model.effects) {
    if (one.name == effect.name) {
      throw std::invalid_argument("the model has an effect \"" + effect.name +
                                  "\" already, expected another name");
    }
  }
  const EffectPreview preview = now().preview(effect);
  if (preview.predicted) step.predicted_rms = preview.predicted->arrival_rms;
  step.model.effects.push_back(effect);
  step.model.effects.back().coefficients.clear();
  take(std::move(step), watch);
}

void Workbench::remove(std::size_t effect, const WorkbenchWatch& watch) {
  WorkbenchStep step;
  step.kind = WorkbenchStep::Kind::remove;
  step.from = log_.at;
  step.model = log_.steps[log_.at].model;
  step.effect = step.model.effects.at(effect).name;
  step.model.effects.erase(step.model.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  take(std::move(step), watch);
}

void Workbench::rename(std::size_t step, std::string label) {
  log_.steps.at(step).label = std::move(label);
}

void Workbench::go_to(std::size_t step, const WorkbenchWatch& watch) {
  WorkbenchLog log = log_;
  static_cast<void>(log.steps.at(step));
  log.at = step;
  const auto kept = std::find_if(kept_.begin(), kept_.end(),
                                 [step](const auto& one) { return one.first == step; });
  now_ = kept != kept_.end() ? kept->second : tried(log, watch);
  log_ = std::move(log);
}

}  // namespace trussmap
