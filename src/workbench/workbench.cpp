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

}  // namespace

std::vector<std::size_t> way_to(const WorkbenchLog& log, std::size_t step) {
  std::vector<std::size_t> way{step};
  while (way.back() != 0) way.push_back(log.steps.at(way.back()).from);
  std::reverse(way.begin(), way.end());
  return way;
}

Workbench::Workbench(std::vector<Recording> recordings, const Model& model,
                     const DiagnoseOptions& options, const Progress& progress)
    : recordings_(std::make_shared<const std::vector<Recording>>(std::move(recordings))),
      options_(options) {
  options_.fit.fit_effects = true;
  WorkbenchStep given;
  given.model = model;
  take(std::move(given), progress);
}

Workbench::Workbench(std::vector<Recording> recordings, WorkbenchLog log,
                     const DiagnoseOptions& options, const Progress& progress)
    : recordings_(std::make_shared<const std::vector<Recording>>(std::move(recordings))),
      options_(options),
      log_(std::move(log)) {
  check(log_);
  options_.fit.fit_effects = true;
  now_ = tried(log_.steps[log_.at].model, progress);
  kept_.emplace_back(log_.at, *now_);
}

TriedModel Workbench::tried(const Model& model, const Progress& progress) const {
  return {recordings_, model, options_, progress};
}

/// Nothing is changed until the model has been tried.
void Workbench::take(WorkbenchStep step, const Progress& progress) {
  TriedModel model = tried(step.model, progress);
  const HeldOut& held_out = model.diagnosis().held_out;
  step.arrival_rms = held_out.arrival_rms;
  step.expected_rms = held_out.expected_rms;
  step.chi2 = model.fit().chi2;
  step.dof = model.fit().dof;
  const std::size_t most = model.comparison().legs > kLegsOfSmallRecordings ? 1 : kKept;
  log_.steps.push_back(std::move(step));
  log_.at = log_.steps.size() - 1;
  kept_.emplace_back(log_.at, model);
  if (kept_.size() > most) kept_.erase(kept_.begin());
  now_ = std::move(model);
}

void Workbench::add(const Effect& effect, const Progress& progress) {
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
  take(std::move(step), progress);
}

void Workbench::remove(std::size_t effect, const Progress& progress) {
  WorkbenchStep step;
  step.kind = WorkbenchStep::Kind::remove;
  step.from = log_.at;
  step.model = log_.steps[log_.at].model;
  step.effect = step.model.effects.at(effect).name;
  step.model.effects.erase(step.model.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  take(std::move(step), progress);
}

void Workbench::go_to(std::size_t step, const Progress& progress) {
  const Model& model = log_.steps.at(step).model;
  const auto kept = std::find_if(kept_.begin(), kept_.end(),
                                 [step](const auto& one) { return one.first == step; });
  now_ = kept != kept_.end() ? kept->second : tried(model, progress);
  log_.at = step;
}

}  // namespace trussmap
