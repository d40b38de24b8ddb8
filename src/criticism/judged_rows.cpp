// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/judged_rows.hpp"

#include "criticism/refits.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/error.hpp"

#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

constexpr int kMostChanges = 2;  // of the rows; each costs a search

std::optional<PreparedRecordings> rows_with(const PreparedRecordings& rows, const Model& model) {
  if (!rows.whole) return std::nullopt;
  try {
    return prepared_again(rows, model);
  } catch (const SolveError&) {  // all rows together tell less than those used
    return std::nullopt;
  }
}

bool many_more(const PreparedRecordings& now, const PreparedRecordings& again) {
  return again.sightings.used >= 2 * now.sightings.used;
}

/// The model that was judged, with all that it lacks.
Model model_with_missing(const Diagnosis& diagnosis, const ModelFit& fit) {
  Model model = diagnosis.under ? diagnosis.under->fit.model : fit.model;
  for (const Finding* one : found_by(diagnosis)) {
    model.effects.push_back(one->effect);
    if (!one->joint.empty()) model.effects.back().coefficients = one->joint;
  }
  return model;
}

JudgedRun run_by(PreparedRecordings rows, ModelFit fit, const Noise& stated,
                 const DiagnoseOptions& options) {
  JudgedRun judged{std::move(rows), std::move(fit), {}};
  judged.run = run_diagnosis(judged.rows.recordings, judged.fit, stated, options);
  judged.run.result.sightings = judged.rows.sightings;
  return judged;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::criticism {

JudgedRun judged_run(PreparedRecordings rows, ModelFit fit, const Noise& stated,
                     const DiagnoseOptions& options) {
  JudgedRun judged = run_by(std::move(rows), std::move(fit), stated, options);
  for (int change = 0; change < kMostChanges && judged.rows.could_be_more(); ++change) {
    const Diagnosis& found = judged.run.result;
    if (found.verdict != Diagnosis::Verdict::missing) break;
    std::optional<PreparedRecordings> again =
        rows_with(judged.rows, model_with_missing(found, judged.fit));
    if (!again || !many_more(judged.rows, *again)) break;
    try {
      ModelFit of_these = fit_model(again->recordings, judged.fit.model, judged.fit.options);
      judged = run_by(*std::move(again), std::move(of_these), stated, options);
    } catch (const SolveError&) {  // without what is missing more rows are too much for a fit
      break;
    }
  }
  return judged;
}

}  // namespace trussmap::criticism

namespace trussmap {

Comparison compare(const PreparedRecordings& recordings, const ModelFit& fit,
                   const CompareOptions& options) {
  Comparison result = compare(recordings.recordings, fit, options);
  result.sightings = recordings.sightings;
  return result;
}

Diagnosis diagnose(PreparedRecordings& recordings, ModelFit& fit, const DiagnoseOptions& options) {
  const Noise stated = fit.model.noise;
  JudgedRun judged = judged_run(std::move(recordings), std::move(fit), stated, options);
  recordings = std::move(judged.rows);
  fit = std::move(judged.fit);
  return std::move(judged.run.result);
}

Discovery discover(PreparedRecordings& recordings, const Model& model,
                   const DiscoverOptions& options) {
  std::optional<PreparedRecordings> other;
  std::optional<PreparedRecordings> before;
  int changes = 0;
  DiscoverOptions how = options;
  how.go_on = [&](const ModelFit& fit) {
    if (options.go_on && !options.go_on(fit)) return false;
    if (changes == kMostChanges || !recordings.could_be_more()) return true;
    other = rows_with(recordings, fit.model);
    if (other && !many_more(recordings, *other)) other.reset();
    return !other;
  };
  while (true) {
    Discovery found;
    try {
      found = discover(recordings.recordings, model, how);
    } catch (const SolveError&) {  // without what was found more rows are too much for a fit
      if (!before) throw;
      recordings = *std::exchange(before, std::nullopt);
      changes = kMostChanges;
      continue;
    }
    const bool told = found.stopped.reason == StopReason::told_to && !other;
    if (!other && !told && changes < kMostChanges) {
      other = rows_with(recordings, found.found.model);
      if (other && use_the_same(recordings, *other)) other.reset();
    }
    if (!other) {
      found.sightings = recordings.sightings;
      return found;
    }
    before = std::move(recordings);
    recordings = *std::exchange(other, std::nullopt);
    ++changes;
  }
}

}  // namespace trussmap
