// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/wheel_calibration.hpp"

#include "calibration/heading_offset.hpp"
#include "calibration/restricted_likelihood.hpp"
#include "calibration/truth_alignment.hpp"
#include "estimation/recording_adjustment.hpp"
#include "odometry/effect_correction.hpp"
#include "recording/well_formed.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kUseless = 0.1;  // a standard error of a ratio that is no calibration

constexpr std::array<const char*, 3> kNames{"wheel diameter ratio", "wheelbase", "wheel scale"};
constexpr std::array<Channel, 3> kChannels{Channel::difference, Channel::turn, Channel::wheels};
constexpr std::array<const char*, 3> kSymbols{
    "E_d (right wheel / left wheel)", "E_b (wheelbase / nominal)", "E_s (true / measured travel)"};

bool is_one_of_three(const Effect& effect) {
  return std::find(kNames.begin(), kNames.end(), effect.name) != kNames.end();
}

/// Parameters: those of the three that are wanted, and the alignment of the truth.
EffectParameters parameters_of(const std::array<bool, 3>& wanted,
                               const std::vector<Recording>& recordings, const Robot& robot,
                               const WheelCalibrationOptions& options,
                               const TruthAlignment& prior) {
  EffectParameters parameters;
  for (std::size_t k = 0; k < 3; ++k) {
    if (wanted[k]) parameters.push_back(plain_effect(kChannels[k], recordings, robot));
  }
  if (!options.problem.truth) return parameters;
  for (EffectPattern& one : truth_alignment(recordings, robot, options.sessions, prior)) {
    parameters.push_back(std::move(one));
  }
  return parameters;
}

/// The model whose three effects have these coefficients; others as given.
Model with(const Model& model, const std::array<double, 3>& g) {
  Model result = model;
  std::erase_if(result.effects, is_one_of_three);
  for (std::size_t k = 0; k < 3; ++k) {
    result.effects.push_back({kNames[k], kChannels[k], {"1"}, {g[k]}, false});
  }
  return result;
}

std::array<double, 3> in_force(const Model& model) {
  std::array<double, 3> g{};
  for (const Effect& effect : model.effects) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (effect.name == kNames[k] && !effect.coefficients.empty()) g[k] = effect.coefficients[0];
    }
  }
  return g;
}

/// The recordings with the model's effects taken out, and a problem of them.
struct Fitted {
  std::vector<Recording> corrected;
  RecordingProblem problem;
  EffectParameters parameters;
  RecordingAdjustment adjustment;
};

Fitted fit(const std::vector<Recording>& recordings, const Model& model,
           const std::array<bool, 3>& wanted, const WheelCalibrationOptions& options,
           const TruthAlignment& prior) {
  Fitted result;
  result.corrected = without_effects(recordings, model);
  result.problem = make_problem(result.corrected, model, options.problem);
  result.parameters = parameters_of(wanted, result.corrected, model.robot, options, prior);
  result.adjustment = adjust(result.problem, result.parameters);
  return result;
}

/// Adds what was found on corrected rows to what was in force: gains multiply.
void refine(std::array<double, 3>& g, const std::array<bool, 3>& wanted,
            const Eigen::VectorXd& found) {
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!wanted[k]) continue;
    const double more = found[at++];
    // difference: (1 - g/2), (1 + g/2) multiply to another ratio, and a scale of second order.
    g[k] = k == 0 ? (g[k] + more) / (1.0 + 0.25 * g[k] * more) : (1.0 + g[k]) * (1.0 + more) - 1.0;
  }
}

/// k_L and k_R by the fit of the geometry, in the result and in its model.
void find_noise(const Fitted& about, const ProblemOptions& options, WheelCalibration& result) {
  const std::optional<WheelNoiseFit> found = most_likely_noise(
      about.corrected, result.model, options, about.parameters, about.adjustment.state);
  if (!found) {
    result.undetermined.emplace_back(
        "k_left and k_right: the other noise in the model hides that of the wheels");
    return;
  }
  result.noise_left = Calibrated{found->k[0], found->sd[0]};
  result.noise_right = Calibrated{found->k[1], found->sd[1]};
  result.model.noise.left = found->k[0];
  result.model.noise.right = found->k[1];
}

/// Whether anything in use measures a distance.
bool measures_distance(const std::vector<Recording>& recordings, const ProblemOptions& options) {
  return std::any_of(recordings.begin(), recordings.end(), [&options](const Recording& one) {
    return (options.survey && !one.survey.empty()) || (options.truth && !one.truth.empty()) ||
           std::any_of(one.sightings.begin(), one.sightings.end(),
                       [](const Sighting& sighting) { return !sighting.standing(); });
  });
}

/// What is missing for coefficient k, in the user's terms.
std::string why_not(std::size_t k, const std::vector<Recording>& recordings,
                    const ProblemOptions& options) {
  switch (k) {
    case 0:
      return "the drive is too short to show one wheel larger than the other; drive straight lines "
             "of several metres";
    case 1:
      return "the robot hardly turns; drive turns, both ways";
    default:
      return measures_distance(recordings, options)
                 ? "the robot hardly gets anywhere, and turns on the spot cannot tell larger "
                   "wheels "
                   "from a smaller wheelbase; drive straight lines"
                 : "nothing in use measures a distance; add a survey or truth";
  }
}

std::string undetermined_text(std::size_t k, const std::vector<Recording>& recordings,
                              const ProblemOptions& options) {
  return std::string(kSymbols[k]) + ": " + why_not(k, recordings, options);
}

/// Which of the three the motion determines: each alone, then jointly.
std::array<bool, 3> determined(const std::vector<Recording>& recordings, const Model& model,
                               const WheelCalibrationOptions& options,
                               std::vector<std::string>& undetermined) {
  // Without a measured distance the least chi^2 lies at a smaller map: its errors shrink with it.
  const bool scale = measures_distance(recordings, options.problem);
  std::array<bool, 3> wanted{true, true, scale};
  const auto can = [&](const std::array<bool, 3>& these) {
    try {
      const Fitted one = fit(recordings, model, these, options, {});
      const Eigen::Index count = std::count(these.begin(), these.end(), true);
      const Eigen::VectorXd variances = one.adjustment.coefficient_covariance.diagonal();
      return variances.head(count).maxCoeff() < kUseless * kUseless;
    } catch (const SolveError&) {
      return false;
    }
  };
  if (!scale) undetermined.push_back(undetermined_text(2, recordings, options.problem));
  if (can(wanted)) return wanted;
  // Nothing at all: let the reason through.
  static_cast<void>(fit(recordings, model, {false, false, false}, options, {}));
  wanted = {false, false, false};
  for (const std::size_t k : {0U, 1U, 2U}) {
    if (k == 2 && !scale) continue;
    std::array<bool, 3> more = wanted;
    more[k] = true;
    if (can(more)) {
      wanted = more;
    } else {
      undetermined.push_back(undetermined_text(k, recordings, options.problem));
    }
  }
  return wanted;
}

/// E_d, E_b and E_s.
std::array<double, 3> ratios(const std::array<double, 3>& g) {
  return {(1.0 + 0.5 * g[0]) / (1.0 - 0.5 * g[0]), 1.0 / (1.0 + g[1]), 1.0 + g[2]};
}

/// chi^2, and E_d, E_b and E_s with their standard errors.
void read_ratios(WheelCalibration& result, const std::array<double, 3>& g,
                 const std::array<bool, 3>& wanted, const RecordingAdjustment& adjustment) {
  result.chi2 = adjustment.chi2;
  result.dof = adjustment.dof;
  Eigen::Index at = 0;
  const auto sd = [&] {
    const double variance = adjustment.coefficient_covariance(at, at);
    ++at;
    return std::sqrt(variance);
  };
  const auto [e_d, e_b, e_s] = ratios(g);
  if (wanted[0]) {
    const double slope = 1.0 / std::pow(1.0 - 0.5 * g[0], 2);
    result.diameter_ratio = Calibrated{e_d, slope * sd()};
  }
  if (wanted[1]) result.wheelbase_ratio = Calibrated{e_b, e_b * sd()};
  if (wanted[2]) result.scale = Calibrated{e_s, e_s * sd()};
}

/// Whether a round moved no estimate by more than `kStill` of its standard error.
bool stands_still(const RecordingAdjustment& adjustment, Eigen::Index geometry) {
  constexpr double kStill = 0.1;
  const Eigen::ArrayXd steps = adjustment.coefficients.head(geometry).array().abs();
  const Eigen::ArrayXd variances = adjustment.coefficient_covariance.diagonal().head(geometry);
  return (steps <= kStill * variances.sqrt()).all();
}

/// Wheels that run backwards, or change sides: the truth is not what it is said to be.
void require_positive(const std::array<double, 3>& g, const std::array<bool, 3>& wanted,
                      const std::vector<Recording>& recordings, const Model& model,
                      const ProblemOptions& options) {
  const std::array<double, 3> all = ratios(g);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!wanted[k] || all[k] > 0.0) continue;
    const std::string why = options.truth ? describe(heading_offset(recordings, model.robot)) : "";
    throw SolveError(fmt::format(
        "not calibrated: {} would be {:.3g}, which no robot has; {}", kSymbols[k], all[k],
        why.empty() ? "are left and right exchanged, or the signs of x or y?" : why));
  }
}

}  // namespace

WheelCalibrationOptions calibration_options(const CalibrationOptions& options) {
  WheelCalibrationOptions result;
  result.problem.survey = options.survey;
  result.problem.truth = options.truth;
  result.noise = options.noise;
  return result;
}

WheelCalibration calibrate_wheels(const std::vector<Recording>& recordings, const Model& model,
                                  const CalibrationOptions& options) {
  require_well_formed(recordings);
  return calibrate_wheels(recordings, model, calibration_options(options));
}

WheelCalibration calibrate_wheels(const std::vector<Recording>& recordings, const Model& model,
                                  const WheelCalibrationOptions& options) {
  constexpr int kRounds = 4;
  constexpr double kSettled = 1e-10;
  WheelCalibration result;
  std::array<double, 3> g = in_force(model);
  result.model = with(model, g);
  const std::array<bool, 3> wanted =
      determined(recordings, result.model, options, result.undetermined);
  const Eigen::Index geometry = std::count(wanted.begin(), wanted.end(), true);
  // Noise weighs the measurements, so it is found between two fits of the geometry.
  Fitted last;
  for (const bool noise : {options.noise, false}) {
    for (int round = 0; round < kRounds; ++round) {
      last = fit(recordings, result.model, wanted, options, result.truth);
      refine(g, wanted, last.adjustment.coefficients);
      result.model = with(result.model, g);
      if (options.problem.truth) {
        const Eigen::VectorXd& all = last.adjustment.coefficients;
        result.truth = alignment_of(recordings, options.sessions, all.tail(all.size() - geometry));
      }
      const Eigen::VectorXd steps = last.adjustment.coefficients.head(geometry);
      if (geometry == 0 || steps.cwiseAbs().maxCoeff() < kSettled) break;
    }
    require_positive(g, wanted, recordings, model, options.problem);
    if (noise) find_noise(last, options.problem, result);
  }
  read_ratios(result, g, wanted, last.adjustment);
  result.settled = stands_still(last.adjustment, geometry);
  return result;
}

}  // namespace trussmap
