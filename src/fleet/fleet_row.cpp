// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"
#include "criticism/score_test.hpp"
#include "drive/well_formed.hpp"
#include "fit/fit_state.hpp"
#include "fleet/day.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// Change of a segment's value that ends the fit, in sds: sums of robots fitted apart are then
/// those of a fit of all to 1e-8 or so; the 1e-2 that does for a fit alone leaves 1e-5.
constexpr double kStillOffset = 1e-7;

/// Coefficients as the model states them: the same reference for every robot.
ModelFit fit_at_reference(const std::vector<DrivenRecording>& recordings, const Model& model,
                          const FitOptions& options) {
  drive::require_well_formed(recordings, model.robot);
  fitting::FitterOptions how = fitting::fitter_options(options);
  how.fit_effects = false;
  how.still_offset = kStillOffset;
  return fitting::model_fit(fitting::fit_recordings(recordings, model, how), options);
}

/// The catalogue's with nothing open: their shapes are the same for every robot.
std::vector<Effect> pooling_candidates(const fitting::FitState& fit,
                                       const criticism::ScoreTest& tests) {
  std::vector<Effect> effects;
  for (const criticism::Candidate& one : criticism::candidates_for(fit, tests.context())) {
    if (one.form == criticism::Form::catalogue && one.parameters.empty())
      effects.push_back(one.effect);
  }
  return effects;
}

/// Appends an effect's columns; M gets them as they are.
void take(FleetRow& row, std::vector<Eigen::MatrixXd>& parts, const Effect& effect,
          criticism::Score& score, bool of_model) {
  for (std::size_t k = 0; k < effect.shape.size(); ++k) {
    row.columns.push_back({of_model, effect.name, std::string(name_of(effect.channel)),
                           effect.shape[k].text(), static_cast<int>(k)});
    row.reference.push_back(of_model && k < effect.coefficients.size() ? effect.coefficients[k]
                                                                       : 0.0);
    row.prior_sd.push_back(facts_of(effect.channel).prior_sd);
    row.largest.push_back(score.largest[k]);
    row.whole.push_back(score.columns.col(static_cast<Eigen::Index>(k)).squaredNorm());
  }
  parts.push_back(std::move(score.columns));
}

}  // namespace

int day_number(const std::string& date) {
  if (const std::optional<int> day = fleet::day_in(date)) return *day;
  throw InputError("date", 0, fmt::format("is \"{}\", expected YYYY-MM-DD", date));
}

FleetRow fleet_row(const std::string& robot, const std::string& date,
                   const std::vector<DrivenRecording>& recordings, const Model& model,
                   const std::string& model_text, const FitOptions& fit, const LegOptions& legs) {
  static_cast<void>(day_number(date));
  for (const Effect& one : model.effects) {
    if (!one.per_session) continue;
    throw InputError("model", static_cast<std::size_t>(one.line),
                     fmt::format("effect \"{}\" has coefficients per session, which do not pool "
                                 "over a fleet, expected one set for all",
                                 one.name));
  }
  const ModelFit fitted = fit_at_reference(recordings, model, fit);
  const criticism::ScoreTest tests(*fitted.state);
  FleetRow row;
  row.robot = robot;
  row.date = date;
  row.model = model_text;
  row.recordings = static_cast<int>(recordings.size());
  const HeldOut held_out = predict_held_out(recordings, fitted, legs);
  row.held_out_legs = static_cast<int>(held_out.legs.size());
  row.held_out_rms = held_out.arrival_rms;
  row.held_out_stretch = held_out.stretch_error;
  row.held_out_orientation = held_out.orientation_error;

  const std::vector<Effect> candidates = pooling_candidates(*fitted.state, tests);
  std::vector<Eigen::MatrixXd> parts;
  const auto take_all = [&](const std::vector<Effect>& effects, bool of_model) {
    std::vector<criticism::Score> scores = tests.test(effects);
    for (std::size_t k = 0; k < effects.size(); ++k) {
      take(row, parts, effects[k], scores[k], of_model);
    }
  };
  take_all(fitted.model.effects, true);
  take_all(candidates, false);
  const Eigen::VectorXd r = tests.free_of_map(tests.system().residuals());
  Eigen::MatrixXd M(r.size(), static_cast<Eigen::Index>(row.columns.size()));
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : parts) {
    M.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  M = tests.free_of_map(M);
  row.g = M.transpose() * r;
  row.S = M.transpose() * M;
  row.chi2 = r.squaredNorm();
  row.dof = fitted.state->adjustment.dof;
  return row;
}

}  // namespace trussmap
