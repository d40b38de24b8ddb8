// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// A model set against measurements: is it consistent, where does it fail, and with what does its
// error grow?
//
//   held out   legs that no fit has seen (held_out.hpp)
//   worst      legs and routes by the energy locked in them; forces in the bars
//   trends     residual of a kind against a variable, as score tests: a trend of stretch with
//              payload is the effect travel x payload
//   sources    sum of squared residuals over redundancy, per source of noise: 1 if its standard
//              deviation is right, its square root the factor by which it is too small
//
// One rule for compare, diagnose and discover, so that none contradicts another on the same fit.
// A model is consistent with the recordings at a level a where
//
//   misfit    neither chi^2 as a whole nor the strongest trend is significant: 2 min(p) >= a
//   effects   and no effect is missing: none of those that diagnose tries is significant at a
//
// Each of the two raises a false alarm in a share a of recordings at most. compare asks the second
// only where the first is answered.
#pragma once

#include "trussmap/fit_model.hpp"
#include "trussmap/gate.hpp"
#include "trussmap/held_out.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap {

// ----------------------------------------
// Recordings as compare, fit, diagnose and discover take them: what of them counts as independent
// measurements.
//
//   recordings, model --prepare_recordings--> recordings, notes on what is left out and why
//
//   frames   where sightings come in dense frames, one frame in so long as their errors last
//            (lasting_errors, fit_model.hpp); of very many sightings, so few that they are
//            kEnoughSightings, or one frame in a second
//   survey   points that contradict a map made of such frames without the survey
//
// Both are of the model: an effect that it lacks makes errors last, and they no longer do once it
// is in. So they are judged again for a model with other effects (prepared_again); whoever judges
// the same model judges it by the same rows.

/// The gate of gate.hpp, kModelGate, as long as few measurements are beyond it. `gate` in standard
/// deviations; 0: none.
[[nodiscard]] FitOptions gated_fit(double gate = kModelGate);

/// Sightings, of dense frames: of more, every fit takes longer, and the wheels between the frames
/// tell the rest.
inline constexpr std::size_t kEnoughSightings = 12000;

/// What of recordings' sightings a model is judged by.
struct UsedSightings {
  std::size_t used = 0;
  std::size_t all = 0;
  double every = 0.0;  ///< s, of which one frame is used; 0: all are

  [[nodiscard]] bool thinned() const { return used < all; }
};

struct PreparedRecordings {
  std::vector<DrivenRecording> recordings;
  std::vector<std::string> notes;  ///< what of the recordings is not used, and why
  UsedSightings sightings;
  /// What a model may use; nullptr where no model is asked what to use.
  std::shared_ptr<const std::vector<DrivenRecording>> whole = nullptr;
  std::size_t recorded = 0;  ///< sightings that there are
  double pace = 0.0;         ///< s, of which `whole` has one frame; 0: it has all
  FitOptions fit;            ///< by which that is judged

  /// Whether with another model there could be more than are used.
  [[nodiscard]] bool could_be_more() const;
};

/// Thinned out. `every`: s between frames of sightings; 0: all;
/// absent: as long as their errors are found to last, and few enough. Throws like fit_model.
[[nodiscard]] PreparedRecordings prepare_recordings(std::vector<DrivenRecording> recordings,
                                                    const Model& model, const FitOptions& fit,
                                                    std::optional<double> every = {});
[[nodiscard]] inline PreparedRecordings prepare_recordings(std::vector<Recording> recordings,
                                                           const Model& model,
                                                           const FitOptions& fit,
                                                           std::optional<double> every = {}) {
  return prepare_recordings(with_wheels(std::move(recordings), model.robot), model, fit, every);
}

/// The same recordings as another model of the same robot has them; where no model is asked, as
/// they are. Throws like fit_model.
[[nodiscard]] PreparedRecordings prepared_again(const PreparedRecordings& prepared,
                                                const Model& model);

/// Whether the same is used of both, which are of the same recordings.
[[nodiscard]] bool use_the_same(const PreparedRecordings& one, const PreparedRecordings& other);

// ----------------------------------------
// Comparison.

/// Level of significance wherever none is given.
inline constexpr double kSignificance = 0.05;

struct LegMisfit {
  std::size_t leg = 0;  ///< its number among all legs, as LegPrediction's
  std::string from;
  std::string to;
  double t = 0.0;                  ///< s, at its end
  double chi2 = 0.0;               ///< of its segments
  int dof = 0;                     ///< values among them
  double stretch_error = 0.0;      ///< (s - s0)/s0, signed: + is measured too long
  double orientation_error = 0.0;  ///< rad, signed
};

struct RouteMisfit {
  std::string from;
  std::string to;
  int traversals = 0;
  double chi2 = 0.0;
  double force = 0.0;              ///< in the bar, along it, 1/m: gradient of chi^2/2; + is tension
  double stretch_error = 0.0;      ///< mean, signed
  double orientation_error = 0.0;  ///< mean, signed, rad
};

struct LandmarkMisfit {
  std::string landmark;
  int sightings = 0;
  double chi2 = 0.0;  ///< of its sightings and survey
};

struct Trend {
  std::string kind;     ///< stretch, orientation, turn, compass, sighting
  std::string against;  ///< heading, speed, payload_kg, ...; "all" for a constant
  Effect effect;        ///< the trend as an effect, with its estimated coefficients
  double score = 0.0;   ///< chi^2 that it explains
  int dof = 0;
  double p_value = 1.0;
  double p_adjusted = 1.0;  ///< Holm, over all trends
  double size = 0.0;        ///< rms of g over rows or events, unit of the channel
  std::string unit;
};

struct SourceCalibration {
  std::string source;   ///< "wheels", "compass", "sighting", ...: the model's [noise]
  double factor = 1.0;  ///< by which its stated standard deviation is too small
  double sd = 0.0;      ///< of the factor
  double redundancy = 0.0;
};

/// Standardised residuals of one source of noise: a sample of the standard normal distribution
/// where the source is as noisy as stated.
struct SourceResiduals {
  std::string source;
  std::vector<double> standardised;  ///< ascending; what is not checked is not among them
};

/// A measurement that the others contradict.
struct Outlier {
  std::string what;  ///< "standing on landmark 12 at t = 3.500 s"
  double statistic = 0.0;
  int dof = 0;
  double p_adjusted = 1.0;  ///< Bonferroni, over all measurements
};

/// What recordings lack for telling effects apart.
enum class Lack {
  positions,        ///< neither survey nor truth
  compass,          ///< neither compass nor truth
  headings,         ///< `count` of 8 directions are driven
  turning_sense,    ///< `share` of all turning is to one side
  leg_lengths,      ///< all legs are about equally long
  speeds,           ///< one speed
  spin_rates,       ///< turns on the spot at one rate
  rests,            ///< the robot hardly ever stands
  covariate_range,  ///< `name` never changes
  revisits          ///< `count` of `total` landmarks are visited once
};

struct DataLack {
  Lack what = Lack::positions;
  int count = 0;
  int total = 0;
  double share = 0.0;
  bool to_the_left = false;
  std::string name = {};
};

struct CompareOptions {
  FitOptions fit = {};  ///< coefficients are held as the model has them, whatever it says
  LegOptions legs = {};
  double level = kSignificance;  ///< chance of a false "misfit", see above
};

inline constexpr int kFewestTests = 5;  ///< degrees of freedom that make a test

/// What speaks against a model.
enum class Objection { none, chi2, trend, effect, noise, change, place };

struct Comparison {
  Objection objection = Objection::none;
  std::string missing;   ///< the effect that speaks against it
  std::string changing;  ///< or that effect of the model whose coefficient changes while driving
  double chi2 = 0.0;
  int dof = 0;
  int coefficients = 0;          ///< estimated in this fit, each at the cost of a degree of freedom
  double p_value = 1.0;          ///< of chi^2 as a whole
  double level = kSignificance;  ///< by which it was judged
  UsedSightings sightings;       ///< of prepared recordings
  std::size_t legs = 0;
  std::size_t landmarks = 0;
  HeldOut held_out;
  std::vector<LegMisfit> worst;  ///< all legs, worst first
  std::vector<RouteMisfit> routes;
  std::vector<LandmarkMisfit> worst_landmarks;
  std::vector<Trend> trends;  ///< strongest first
  std::vector<SourceCalibration> sources;
  std::vector<SourceResiduals> residuals;
  std::vector<Outlier> outliers;  ///< most significant first
  std::vector<DataLack> lacks;
  std::vector<std::string> warnings;

  [[nodiscard]] bool consistent() const { return objection == Objection::none; }

  /// Whether a trend speaks against the model. None does where the model is consistent: the verdict
  /// asks two questions, chi^2 and trends, and takes half of the level for each.
  [[nodiscard]] bool tells(const Trend& trend) const {
    return trend.p_adjusted < level && !consistent();
  }

  /// Whether measurements are left over that could contradict a model: without, being consistent
  /// says nothing.
  [[nodiscard]] bool tested() const { return dof >= kFewestTests; }
  [[nodiscard]] double misfit() const { return chi2 / (dof > 1 ? dof : 1); }  ///< 1 is right
};

/// Throws like fit_model.
[[nodiscard]] Comparison compare(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const CompareOptions& options = {});
[[nodiscard]] inline Comparison compare(const std::vector<Recording>& recordings,
                                        const Model& model, const CompareOptions& options = {}) {
  return compare(with_wheels(recordings, model.robot), model, options);
}

/// The same where the fit of these recordings is there already, with coefficients held or not.
[[nodiscard]] Comparison compare(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit, const CompareOptions& options = {});
[[nodiscard]] inline Comparison compare(const std::vector<Recording>& recordings,
                                        const ModelFit& fit, const CompareOptions& options = {}) {
  return compare(with_wheels(recordings, fit.model.robot), fit, options);
}

/// The same of recordings as that fit's model has them.
[[nodiscard]] Comparison compare(const PreparedRecordings& recordings, const ModelFit& fit,
                                 const CompareOptions& options = {});

/// A model's effects fitted, beside the same robot without them.
struct EffectGain {
  ModelFit without;
  ModelFit with;
  HeldOut held_out_without;
  HeldOut held_out_with;
  double predicted_decrease = 0.0;  ///< of chi^2, by the score test before the fit
};

/// `without` is a fit of the model without effects. Throws like fit_model.
[[nodiscard]] EffectGain gain_of_effects(const std::vector<DrivenRecording>& recordings,
                                         const ModelFit& without, const ModelFit& with,
                                         const LegOptions& legs = {});

}  // namespace trussmap
