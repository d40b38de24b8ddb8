// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/fit_model.hpp"

#include "drive/well_formed.hpp"
#include "estimation/measurement_rows.hpp"
#include "fit/fit_state.hpp"
#include "fit/fit_warnings.hpp"
#include "recording/time_spans.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap {
using namespace fitting;

namespace {

std::vector<FittedLandmark> landmarks_of(const FitState& fit) {
  std::vector<FittedLandmark> landmarks;
  for (std::size_t k = 0; k < fit.problem.landmarks.size(); ++k) {
    FittedLandmark one;
    one.name = fit.problem.landmarks[k];
    one.position = fit.adjustment.state.landmarks[k];
    one.covariance = fit.adjustment.landmark_covariances[k];
    for (const DrivenRecording& recording : fit.recordings) {
      for (const SurveyPoint& point : recording.survey) {
        if (point.landmark == one.name) one.survey = Vector2(point.x, point.y);
      }
    }
    landmarks.push_back(std::move(one));
  }
  return landmarks;
}

/// With how far off it is, and what the receiver thought of it.
std::string left_out_text(const FitState& fit, const estimation::Measurement& one) {
  std::string text = estimation::describe(fit.problem, one);
  const bool fix = estimation::is_position(one);
  if (!fix && !estimation::is_tie(one)) return text;
  const effects::ViewPattern view = estimation::view_of(fit.columns.border, offsets_of(fit), one);
  const estimation::Vector4 error =
      estimation::measurement_rows(fit.problem, one, fit.adjustment.state, one.value, view).error;
  text = (fix ? "fixes.csv: " : "loops.csv: ") + text + ", " +
         text::fixed_text(error.head<2>().norm(), 2) + " m off";
  if (!fix) return text + " and " + text::fixed_text(std::abs(error[2]), 3) + " rad";
  const double quality = fit.recordings[idx(one.session)].fixes[one.source].quality;
  return std::isnan(quality) ? text : text + " (quality " + text::short_text(quality) + ")";
}

}  // namespace

}  // namespace trussmap

namespace trussmap::fitting {

FitterOptions fitter_options(const FitOptions& options) {
  FitterOptions how;
  how.fit_effects = options.fit_effects;
  how.problem.survey = options.use_survey;
  how.problem.truth = options.use_truth;
  how.problem.fixes = options.use_fixes;
  how.problem.loops = options.use_loops;
  how.gate = options.gate;
  how.most_left_out = options.most_left_out;
  for (const std::vector<TimeSpan>& spans : options.excluded) {
    how.problem.left_out.push_back(recording::merged(spans));
  }
  return how;
}

std::vector<std::string> left_out_texts(const FitState& fit) {
  std::vector<std::string> texts;
  for (const int k : fit.adjustment.left_out) {
    texts.push_back(left_out_text(fit, fit.problem.measurements[idx(k)]));
  }
  return texts;
}

int estimated_coefficients(const FitState& fit) {
  return static_cast<int>(estimation::unknown_coefficients(fit.columns.border).size());
}

ModelFit model_fit(FitState state, const FitOptions& options) {
  ModelFit fit;
  fit.model = state.model;
  fit.options = options;
  fit.effects = state.effects;
  fit.landmarks = landmarks_of(state);
  fit.chi2 = state.adjustment.chi2;
  fit.dof = state.adjustment.dof;
  fit.coefficients = estimated_coefficients(state);
  fit.p_value = state.adjustment.p_value;
  fit.settled = state.settled;
  fit.left_out = left_out_texts(state);
  fit.warnings = fit_warnings(state);
  fit.state = std::make_shared<const FitState>(std::move(state));
  return fit;
}

}  // namespace trussmap::fitting

namespace trussmap {

ModelFit fit_model(const std::vector<DrivenRecording>& recordings, const Model& model,
                   const FitOptions& options) {
  drive::require_well_formed(recordings, model.robot);
  return model_fit(fit_recordings(recordings, model, fitter_options(options)), options);
}

}  // namespace trussmap

namespace trussmap::fitting {

ModelFit refit(const std::vector<DrivenRecording>& recordings, const Model& model,
               const ModelFit& near) {
  FitterOptions how = fitter_options(near.options);
  how.near = near.state.get();
  return model_fit(fit_recordings(recordings, model, how), near.options);
}

}  // namespace trussmap::fitting

namespace trussmap {

FittedMap fitted_map(const ModelFit& fit, std::size_t points) {
  FittedMap map;
  map.landmarks = fit.landmarks;
  const std::vector<SessionPath>& paths = fit.state->paths;
  std::size_t rows = 0;
  for (const SessionPath& path : paths) rows += path.ends.size();
  const std::size_t step =
      std::max<std::size_t>(1, (rows + points - 1) / std::max<std::size_t>(points, 1));
  for (const SessionPath& path : paths) {
    std::vector<Vector2> thinned{path.start.position()};
    for (std::size_t k = 0; k < path.ends.size(); ++k) {
      if (k % step == 0 || k + 1 == path.ends.size()) thinned.push_back(path.ends[k].position());
    }
    map.paths.push_back(std::move(thinned));
  }
  return map;
}

}  // namespace trussmap
