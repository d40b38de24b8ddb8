// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/well_formed.hpp"
#include "estimation/student_tails.hpp"
#include "estimation/summarised_sessions.hpp"
#include "fit/fit_state.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace fitting;

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
    throw std::invalid_argument(text::joined(
        "effect ", effect.name, ": sessions that are added one after the other have no ",
        of_sessions ? "effect of their own" : "delay and no steering to fit",
        ", expected a fit of all at once"));
  }
}

void require_summable(const Model& model, double tolerance) {
  for (const Effect& effect : model.effects) require_summable(effect);
  if (std::ranges::any_of(model.noise.processes, estimation::has_used_tails)) {
    throw std::invalid_argument(
        "noise with heavy tails: sessions that are added one after the other have none, expected a "
        "fit of all at once");
  }
  if (!(tolerance > 0.0)) throw std::invalid_argument("the tolerance has to be positive");
}

/// What says where the map's axes are, and which way they point.
struct Frame {
  bool position = false;
  bool direction = false;
};

}  // namespace

class __attribute__((visibility("hidden"))) SummarisedFit::Impl {
 public:
  Impl(Model model, const SummarisedFitOptions& options)
      : options_(options), model_(std::move(model)), sessions_({options.tolerance}) {
    require_summable(model_, options.tolerance);
    if (!options.fit.excluded.empty()) {
      throw std::invalid_argument(
          "spans of time are excluded: sessions that are added one after the other are taken "
          "whole");
    }
  }

  void add(const DrivenRecording& recording) {
    drive::require_well_formed(recording, model().robot);
    if (recording.sightings.empty()) {
      throw InputError(recording.name, 0,
                       "sights no landmark, by which sessions are tied, expected some");
    }
    const bool first = sessions_.sessions() == 0;
    if (!first) require_frame(recording);
    FitState fit = first ? fit_first(recording) : fit_further(recording);
    std::map<std::string, SurveyPoint> survey = survey_;
    for (SurveyPoint point : recording.survey) {
      const auto before = survey.find(point.landmark);
      if (before != survey.end() && std::isnan(point.heading)) {
        point.heading = before->second.heading;
      }
      survey.insert_or_assign(point.landmark, point);
    }
    std::vector<std::string> left_out = left_out_;
    for (const std::string& text : left_out_texts(fit)) {
      left_out.push_back(text::joined(recording.name, ": ", text));
    }
    estimation::SessionRows rows;
    const estimation::RecordingGauge gauge = estimation::choose_gauge(fit.problem);
    rows.tells_position = !gauge.hold_landmark;
    rows.tells_direction = !gauge.hold_heading;
    const Frame frame{rows.tells_position, rows.tells_direction};
    rows.weights =
        estimation::weights_without(fit.adjustment.left_out, fit.problem.measurements.size());
    rows.border = std::move(fit.columns.border);
    if (options_.fit.fit_effects) {
      for (estimation::EffectPattern& effect : rows.border) effect.held.reset();
    }
    rows.state = std::move(fit.adjustment.state);
    rows.problem = std::move(fit.problem);
    estimation::drop_survey(rows);
    sessions_.add(std::move(rows), known_of(recording));
    if (first) {
      model_ = std::move(fit.model);
      frame_ = frame;
    }
    take_coefficients();
    survey_ = std::move(survey);
    left_out_ = std::move(left_out);
  }

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const std::vector<std::string>& left_out() const { return left_out_; }
  [[nodiscard]] estimation::SummarisedSessions& sessions() { return sessions_; }
  [[nodiscard]] const estimation::SummarisedSessions& sessions() const { return sessions_; }

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
      if (surveyed != survey_.end()) one.survey = Vector2(surveyed->second.x, surveyed->second.y);
      result.push_back(std::move(one));
    }
    return result;
  }

 private:
  [[nodiscard]] FitState fit_first(const DrivenRecording& recording) const {
    FitterOptions how = fitter_options(options_.fit);
    how.landmark_uncertainties = false;
    how.paths = false;
    FitState fit = fit_recordings({recording}, model_, how);
    for (const EffectEstimate& one : fit.effects) {
      if (one.not_fitted.empty()) continue;
      throw SolveError(
          text::joined(recording.name, ": the first session does not show a coefficient of ",
                       one.effect.name, "; begin with one that does, or fit several at once"));
    }
    return fit;
  }

  /// On the map, which counts as a survey of its uncertainty, by the coefficients found so far.
  [[nodiscard]] FitState fit_further(const DrivenRecording& recording) const {
    DrivenRecording laid = recording;
    if (!options_.fit.use_survey) laid.survey.clear();
    std::erase_if(laid.survey,
                  [&](const SurveyPoint& point) { return sessions_.has(point.landmark); });
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

  /// A further session may only give a position or a direction where the first one did: what is
  /// held in place of them would contradict it.
  void require_frame(const DrivenRecording& recording) const {
    if (frame_.position && frame_.direction) return;
    const FitOptions& use = options_.fit;
    const News surveyed = news_of_survey(recording);
    const bool position = (use.use_truth && !recording.truth.empty()) ||
                          (use.use_fixes && !recording.fixes.empty()) || surveyed.place;
    // Where the map has one known place, to turn about, a second gives a direction.
    const bool direction = position || surveyed.heading || recording.drive.has_compass();
    if (!(position && !frame_.position) && !(direction && !frame_.direction)) return;
    throw SolveError(
        text::joined(recording.name, " has ",
                     position ? "a survey, truth or fixes" : "a direction (compass, survey)",
                     ", and the first session too little of it to lay the frame: the map "
                     "would turn or shift; expected such a session first"));
  }

  /// What surveys, this one and those before, say of the map with this session, and not of the map
  /// without it.
  struct News {
    bool place = false;    ///< of a landmark that was not sighted, or not surveyed, before
    bool heading = false;  ///< likewise of one whose yaw was read
  };

  [[nodiscard]] News news_of_survey(const DrivenRecording& recording) const {
    News news;
    if (!options_.fit.use_survey) return news;
    const auto hear = [&](const SurveyPoint& point) {
      const auto sights = [&](const Sighting& one) { return one.landmark == point.landmark; };
      const auto reads = [&](const Sighting& one) { return sights(one) && !std::isnan(one.yaw); };
      const auto told = survey_.find(point.landmark);
      const bool in_map = sessions_.has(point.landmark);
      const bool turned = sessions_.has_orientation(point.landmark);
      if (in_map || std::ranges::any_of(recording.sightings, sights)) {
        news.place = news.place || !in_map || told == survey_.end();
      }
      if (std::isnan(point.heading)) return;
      if (turned || std::ranges::any_of(recording.sightings, reads)) {
        news.heading =
            news.heading || !turned || told == survey_.end() || std::isnan(told->second.heading);
      }
    };
    for (const auto& [landmark, point] : survey_) hear(point);
    std::ranges::for_each(recording.survey, hear);
    return news;
  }

  [[nodiscard]] std::vector<estimation::KnownPlace> known_of(
      const DrivenRecording& recording) const {
    std::vector<estimation::KnownPlace> known;
    if (!options_.fit.use_survey) return known;
    for (const SurveyPoint& one : recording.survey) {
      const double sd = std::isnan(one.sd) ? model_.noise.survey : one.sd;
      known.push_back({one.landmark, {one.x, one.y}, sd, one.heading, model_.noise.yaw});
    }
    return known;
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
  estimation::SummarisedSessions sessions_;
  Frame frame_;
  std::map<std::string, SurveyPoint> survey_;  ///< of all sessions, the last of each landmark
  std::vector<std::string> left_out_;
};

SummarisedFit::SummarisedFit(const Model& model, const SummarisedFitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
SummarisedFit::~SummarisedFit() = default;
SummarisedFit::SummarisedFit(SummarisedFit&&) noexcept = default;
SummarisedFit& SummarisedFit::operator=(SummarisedFit&&) noexcept = default;

void SummarisedFit::add(const DrivenRecording& recording) {
  impl_->add(recording);
}

void SummarisedFit::add(const Recording& recording) {
  impl_->add(with_wheels(recording, model().robot));
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

const std::vector<std::string>& SummarisedFit::left_out() const {
  return impl_->left_out();
}

int SummarisedFit::relinearised() const {
  return impl_->sessions().relinearised();
}

double SummarisedFit::exact_error() {
  return impl_->sessions().exact_error();
}

}  // namespace trussmap
