// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"
#include "fit/fit_state.hpp"
#include "recording/well_formed.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

constexpr double kLeastSd = 1e-5;  // m: a landmark that is held is laid as exactly as that

void require_summable(const Effect& effect) {
  const auto speaks_of_session = [](const Shape& shape) {
    const std::vector<std::string>& names = shape.variables();
    return std::find(names.begin(), names.end(), "session") != names.end();
  };
  const bool of_sessions = effect.per_session ||
                           std::any_of(effect.shape.begin(), effect.shape.end(), speaks_of_session);
  if (of_sessions || is_laid_out(effect.channel)) {
    throw std::invalid_argument(
        joined("effect ", effect.name, ": sessions that are added one after the other have no ",
               of_sessions ? "effect of their own" : "delay and no steering to fit",
               ", expected a fit of all at once"));
  }
}

bool is_known(const Measurement& one) {
  return one.kind == MeasurementKind::survey || one.kind == MeasurementKind::survey_heading;
}

/// What says where the map's axes are, and which way they point.
struct Frame {
  bool position = false;
  bool direction = false;
};

}  // namespace

class SummarisedFit::Impl {
 public:
  Impl(Model model, const SummarisedFitOptions& options)
      : options_(options), model_(std::move(model)), sessions_({options.tolerance}) {
    for (const Effect& effect : model_.effects) require_summable(effect);
  }

  void add(const Recording& recording) {
    require_well_formed(recording);
    if (recording.sightings.empty()) {
      throw InputError(recording.name, 0,
                       "sights no landmark, by which sessions are tied, expected some");
    }
    const bool first = sessions_.sessions() == 0;
    if (!first) require_joining(recording);
    FitState fit = first ? fit_first(recording) : fit_further(recording);
    SessionRows rows;
    if (first) {
      const RecordingGauge gauge = choose_gauge(fit.problem);
      rows.tells_position = !gauge.hold_landmark;
      rows.tells_direction = !gauge.hold_heading;
    }
    rows.weights = weights_without(fit.adjustment.left_out, fit.problem.measurements.size());
    rows.border = std::move(fit.columns.border);
    if (options_.fit.fit_effects) {
      for (EffectPattern& effect : rows.border) effect.held.reset();
    }
    rows.state = std::move(fit.adjustment.state);
    rows.problem = std::move(fit.problem);
    drop_known(rows);
    sessions_.add(std::move(rows), known_of(recording));
    if (first) {
      model_ = fit.model;
      frame_ = frame_of(recording);
    }
    take_coefficients();
    for (const SurveyPoint& one : recording.survey) survey_[one.landmark] = {one.x, one.y};
  }

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] SummarisedSessions& sessions() { return sessions_; }
  [[nodiscard]] const SummarisedSessions& sessions() const { return sessions_; }

  [[nodiscard]] std::vector<EffectEstimate> effects() const {
    std::vector<EffectEstimate> result;
    const Eigen::MatrixXd covariance = sessions_.coefficient_covariance();
    Eigen::Index next = 0;
    for (const Effect& effect : model_.effects) {
      EffectEstimate one{effect, std::vector<double>(effect.coefficients.size(), 0.0), {}};
      for (std::size_t k = 0; k < one.sd.size() && next < covariance.cols(); ++k, ++next) {
        one.sd[k] = std::sqrt(covariance(next, next));
      }
      result.push_back(std::move(one));
    }
    return result;
  }

  [[nodiscard]] std::vector<FittedLandmark> landmarks() const {
    std::vector<FittedLandmark> result;
    if (sessions_.sessions() == 0) return result;
    const std::vector<Matrix2> covariances = sessions_.landmark_covariances();
    for (std::size_t k = 0; k < covariances.size(); ++k) {
      FittedLandmark one{sessions_.landmarks()[k], sessions_.position(static_cast<int>(k)),
                         covariances[k]};
      const auto surveyed = survey_.find(one.name);
      if (surveyed != survey_.end()) one.survey = surveyed->second;
      result.push_back(std::move(one));
    }
    return result;
  }

 private:
  [[nodiscard]] FitState fit_first(const Recording& recording) const {
    FitterOptions how = fitter_options(options_.fit);
    how.landmark_uncertainties = false;
    how.paths = false;
    FitState fit = fit_recordings({recording}, model_, how);
    for (const EffectEstimate& one : fit.effects) {
      if (one.not_fitted.empty()) continue;
      throw SolveError(joined(recording.name, ": the first session does not show a coefficient of ",
                              one.effect.name,
                              "; begin with one that does, or fit several at once"));
    }
    return fit;
  }

  /// On the map, which counts as a survey of its uncertainty, by the coefficients found so far.
  [[nodiscard]] FitState fit_further(const Recording& recording) const {
    Recording laid = recording;
    laid.survey.clear();
    const std::vector<FittedLandmark> map = landmarks();
    for (std::size_t k = 0; k < map.size(); ++k) {
      const double sd = std::max(kLeastSd, std::sqrt(0.5 * map[k].covariance.trace()));
      SurveyPoint point{map[k].name, map[k].position.x(), map[k].position.y(), sd};
      const std::optional<double> turned = sessions_.orientation(static_cast<int>(k));
      if (turned) point.heading = *turned;
      laid.survey.push_back(std::move(point));
    }
    FitterOptions how = fitter_options(options_.fit);
    how.problem.survey = true;
    how.fit_effects = false;
    how.landmark_uncertainties = false;
    how.paths = false;
    return fit_recordings({laid}, model_, how);
  }

  /// What the recording says of the frame, as far as it is used.
  [[nodiscard]] Frame frame_of(const Recording& recording) const {
    const FitOptions& use = options_.fit;
    const bool truth = use.use_truth && !recording.truth.empty();
    const std::size_t fixes = use.use_fixes ? recording.fixes.size() : 0;
    const std::size_t surveyed = use.use_survey ? recording.survey.size() : 0;
    return {truth || fixes > 0 || surveyed > 0,
            truth || fixes > 1 || surveyed > 1 || recording.drive.has_compass()};
  }

  void require_joining(const Recording& recording) const {
    const Frame own = frame_of(recording);
    if ((own.position && !frame_.position) || (own.direction && !frame_.direction)) {
      throw SolveError(joined(recording.name, " has ",
                              own.position && !frame_.position ? "a survey, truth or fixes"
                                                               : "a direction (compass, survey)",
                              ", and the first session none: its frame would turn or shift the "
                              "map; expected such a session first"));
    }
    const auto in_map = [&](const Sighting& one) { return sessions_.has(one.landmark); };
    if (own.position || std::ranges::any_of(recording.sightings, in_map)) return;
    throw SolveError(recording.name + " stands apart: no landmark ties it to the sessions before");
  }

  [[nodiscard]] std::vector<KnownPlace> known_of(const Recording& recording) const {
    std::vector<KnownPlace> known;
    if (!options_.fit.use_survey) return known;
    for (const SurveyPoint& one : recording.survey) {
      const double sd = std::isnan(one.sd) ? model_.noise.survey : one.sd;
      known.push_back({one.landmark, {one.x, one.y}, sd, one.heading, model_.noise.yaw});
    }
    return known;
  }

  /// Survey comes last among the measurements, and no lasting noise acts on it.
  static void drop_known(SessionRows& rows) {
    std::vector<Measurement>& all = rows.problem.measurements;
    while (!all.empty() && is_known(all.back())) all.pop_back();
    rows.weights.resize(all.size());
    if (!rows.problem.noise_terms.empty()) rows.problem.noise_terms.resize(all.size());
    if (!rows.problem.within.empty()) rows.problem.within.resize(all.size());
  }

  void take_coefficients() {
    const Eigen::VectorXd values = sessions_.coefficients();
    Eigen::Index next = 0;
    for (Effect& effect : model_.effects) {
      for (double& one : effect.coefficients) {
        if (next < values.size()) one = values[next++];
      }
    }
  }

  SummarisedFitOptions options_;
  Model model_;
  SummarisedSessions sessions_;
  Frame frame_;
  std::map<std::string, Vector2> survey_;
};

SummarisedFit::SummarisedFit(const Model& model, const SummarisedFitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
SummarisedFit::~SummarisedFit() = default;
SummarisedFit::SummarisedFit(SummarisedFit&&) noexcept = default;
SummarisedFit& SummarisedFit::operator=(SummarisedFit&&) noexcept = default;

void SummarisedFit::add(const Recording& recording) {
  impl_->add(recording);
}

int SummarisedFit::sessions() const {
  return impl_->sessions().sessions();
}

Model SummarisedFit::model() const {
  return impl_->model();
}

std::vector<EffectEstimate> SummarisedFit::effects() const {
  return impl_->effects();
}

std::vector<FittedLandmark> SummarisedFit::landmarks() const {
  return impl_->landmarks();
}

double SummarisedFit::chi2() const {
  return impl_->sessions().chi2();
}

int SummarisedFit::dof() const {
  return impl_->sessions().dof();
}

int SummarisedFit::taken_anew() const {
  return impl_->sessions().taken_anew();
}

double SummarisedFit::exact_error() const {
  return impl_->sessions().exact_error();
}

}  // namespace trussmap
