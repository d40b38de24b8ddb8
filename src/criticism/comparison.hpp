// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model set against measurements: is it consistent, where does it fail, and with what does its
// error grow?
//
//   verdict    chi^2 of the fit, against the noise that the model states
//   held out   legs that no fit has seen (held_out.hpp)
//   worst      legs and routes by the energy locked in them; forces in the bars
//   trends     residual of a kind against a variable, as score tests (score_test.hpp): a trend of
//              stretch with payload is the effect travel x payload
//   sources    sum of squared residuals over redundancy, per source of noise: 1 if its standard
//              deviation is right, its square root the factor by which it is too small
#pragma once

#include "criticism/score_test.hpp"
#include "estimation/data_snooping.hpp"
#include "validation/held_out.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct LegMisfit {
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
  std::string source;
  double factor = 1.0;  ///< by which its stated standard deviation is too small
  double sd = 0.0;      ///< of the factor
  double redundancy = 0.0;
};

/// A measurement that the others contradict (data_snooping.hpp).
struct Outlier {
  std::string what;  ///< "standing on landmark 12 at t = 3.500 s"
  double statistic = 0.0;
  int dof = 0;
  double p_adjusted = 1.0;  ///< Bonferroni, over all measurements
};

struct Comparison {
  bool consistent = true;
  double chi2 = 0.0;
  int dof = 0;
  double p_value = 1.0;
  std::size_t legs = 0;
  std::size_t landmarks = 0;
  [[nodiscard]] double misfit() const { return chi2 / (dof > 1 ? dof : 1); }  ///< 1 is right
  HeldOut held_out;
  std::vector<LegMisfit> worst;  ///< all legs, worst first
  std::vector<RouteMisfit> routes;
  std::vector<LandmarkMisfit> worst_landmarks;
  std::vector<Trend> trends;  ///< strongest first
  std::vector<SourceCalibration> sources;
  std::vector<Outlier> outliers;  ///< most significant first
  std::vector<std::string> advice;
  std::vector<std::string> warnings;
};

struct ComparisonOptions {
  ProblemOptions problem;
  LegOptions legs;
  std::optional<double> gate;
  double level = 0.05;  ///< chance of a false "misfit"
};

/// Throws like fit_model.
[[nodiscard]] Comparison compare(const std::vector<Recording>& recordings, const Model& model,
                                 const ComparisonOptions& options = {});

/// The fit that compare() judges: coefficients as the model has them.
[[nodiscard]] ModelFit fit_to_compare(const std::vector<Recording>& recordings, const Model& model,
                                      const ComparisonOptions& options = {});

/// The same where the fit is there already; `tests` are of this fit.
[[nodiscard]] Comparison compare(const std::vector<Recording>& recordings, const Model& model,
                                 const ComparisonOptions& options, const ModelFit& fit,
                                 const ScoreTest& tests);

/// Variables that trends are sought against: the built-in ones that vary, and every covariate.
[[nodiscard]] std::vector<Trend> find_trends(const ModelFit& fit, const ScoreTest& tests);

/// What these data lack for telling effects apart, and what that costs.
[[nodiscard]] std::vector<std::string> advice_on(const std::vector<Recording>& recordings,
                                                 const Model& model, const ProblemOptions& options);

/// Holm's adjustment for as many tests, order kept.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace trussmap
