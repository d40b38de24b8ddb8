// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/workbench.hpp"

#include "fit/fit_state.hpp"
#include "geometry/index.hpp"
#include "recording/time_spans.hpp"
#include "validation/leg_spans.hpp"
#include "validation/training.hpp"

#include <algorithm>
#include <iterator>
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
  step.excluded_legs = static_cast<std::size_t>(
      std::ranges::count_if(model.legs(), [](const TriedLeg& leg) { return leg.excluded; }));
}

PreparedRecordings all_of(std::vector<DrivenRecording> recordings) {
  PreparedRecordings rows;
  rows.recordings = std::move(recordings);
  return rows;
}

/// Where the drive of a recording is over, nothing can be excluded.
void clamp_to(const MotionRows& drive, std::vector<TimeSpan>& spans) {
  for (TimeSpan& span : spans) {
    span.from = std::max(span.from, drive.start());
    span.to = std::min(span.to, drive.t.back());
  }
}

}  // namespace

std::vector<std::size_t> way_to(const WorkbenchLog& log, std::size_t step) {
  std::vector<std::size_t> way{step};
  while (way.back() != 0) way.push_back(log.steps.at(way.back()).from);
  std::reverse(way.begin(), way.end());
  return way;
}

Workbench::Workbench(std::vector<DrivenRecording> recordings, const Model& model,
                     const DiagnoseOptions& options, const WorkbenchWatch& watch)
    : Workbench(all_of(std::move(recordings)), model, options, watch) {}

Workbench::Workbench(std::vector<DrivenRecording> recordings, WorkbenchLog log,
                     const DiagnoseOptions& options, const WorkbenchWatch& watch)
    : Workbench(all_of(std::move(recordings)), std::move(log), options, watch) {}

Workbench::Workbench(PreparedRecordings rows, const Model& model, const DiagnoseOptions& options,
                     const WorkbenchWatch& watch)
    : rows_(std::move(rows)),
      recordings_(
          std::make_shared<const std::vector<DrivenRecording>>(std::move(rows_.recordings))),
      options_(options) {
  options_.fit.fit_effects = true;
  WorkbenchStep given;
  given.model = model;
  given.excluded = options.fit.excluded;
  take(std::move(given), watch);
}

Workbench::Workbench(PreparedRecordings rows, WorkbenchLog log, const DiagnoseOptions& options,
                     const WorkbenchWatch& watch)
    : rows_(std::move(rows)),
      recordings_(
          std::make_shared<const std::vector<DrivenRecording>>(std::move(rows_.recordings))),
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
  DiagnoseOptions options = options_;
  options.fit.excluded = log.steps[log.at].excluded;
  if (watch.provisional && options.estimate_noise) {
    DiagnoseOptions as_stated = options;
    as_stated.estimate_noise = false;
    TriedModel first = tried(model, as_stated, watch);
    const bool fits = first.fit().p_value > options.level;
    if (fits && first.diagnosis().verdict != Diagnosis::Verdict::missing) return first;
    WorkbenchLog with = log;
    put_figures(with.steps[with.at], first);
    watch.provisional(first, with);
  }
  return tried(model, options, watch);
}

TriedModel Workbench::tried(const Model& model, const DiagnoseOptions& options,
                            const WorkbenchWatch& watch) const {
  if (!rows_.whole) return {recordings_, model, options, watch.progress};
  return {prepared_again(rows_, model), model, options, watch.progress};
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

WorkbenchStep Workbench::from_here(WorkbenchStep::Kind kind) const {
  const WorkbenchStep& here = log_.steps[log_.at];
  WorkbenchStep step;
  step.kind = kind;
  step.from = log_.at;
  step.model = here.model;
  step.excluded = here.excluded;
  return step;
}

void Workbench::add(const Effect& effect, const WorkbenchWatch& watch) {
  WorkbenchStep step = from_here(WorkbenchStep::Kind::add);
  step.effect = effect.name;
  for (const Effect& one : step.model.effects) {
    if (one.name == effect.name) {
      throw std::invalid_argument("the model has an effect \"" + effect.name +
                                  "\" already, expected another name");
    }
  }
  for (const Finding& one : now().diagnosis().findings) {
    if (one.effect.name != effect.name) continue;
    for (const LookAlike& rival : one.look_alikes) {
      if (rival.told_apart()) continue;
      step.could_be.push_back(rival.effect);
      step.could_be.back().coefficients.clear();
    }
  }
  const EffectPreview preview = now().preview(effect);
  if (preview.predicted) step.predicted_rms = preview.predicted->arrival_rms;
  step.model.effects.push_back(effect);
  step.model.effects.back().coefficients.clear();
  take(std::move(step), watch);
}

void Workbench::remove(std::size_t effect, const WorkbenchWatch& watch) {
  WorkbenchStep step = from_here(WorkbenchStep::Kind::remove);
  step.effect = step.model.effects.at(effect).name;
  step.model.effects.erase(step.model.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  take(std::move(step), watch);
}

void Workbench::rename(std::size_t step, std::string label) {
  log_.steps.at(step).label = std::move(label);
}

void Workbench::exclude(const std::vector<std::size_t>& legs, const WorkbenchWatch& watch) {
  const fitting::FitState& fit = *now().fit().state;
  std::vector<std::vector<TimeSpan>> spans = fit.used.left_out;
  spans.resize(recordings_->size());
  bool any = false;
  for (const validation::LegSpan& leg : validation::leg_spans(fit, options_.legs)) {
    if (leg.held_out || std::ranges::find(legs, leg.number) == legs.end()) continue;
    spans[idx(leg.session)].push_back(leg.time);
    any = true;
  }
  if (!any) {
    throw std::invalid_argument(
        "none of these legs can be excluded: the model is judged by those that are held out, and "
        "the others are out already");
  }
  for (std::vector<TimeSpan>& one : spans) one = recording::merged(std::move(one));
  spans = validation::recorded_spans(validation::with_unconnected(std::move(spans), fit),
                                     *recordings_, fit);
  WorkbenchStep step = from_here(WorkbenchStep::Kind::exclude);
  step.excluded.resize(spans.size());
  for (std::size_t s = 0; s < spans.size(); ++s) {
    clamp_to((*recordings_)[s].drive, spans[s]);
    std::ranges::copy(step.excluded[s], std::back_inserter(spans[s]));
    step.excluded[s] = recording::merged(std::move(spans[s]));
  }
  take(std::move(step), watch);
}

void Workbench::include_all(const WorkbenchWatch& watch) {
  WorkbenchStep step = from_here(WorkbenchStep::Kind::include);
  step.excluded = log_.steps.front().excluded;
  take(std::move(step), watch);
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
