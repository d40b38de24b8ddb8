// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/wheel_calibration.hpp"

#include "estimation/recording_start.hpp"
#include "estimation/recording_system.hpp"
#include "odometry/effect_correction.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <boost/math/tools/minima.hpp>

namespace trussmap {
namespace {

constexpr double kUseless = 0.1;  // a standard error of a ratio that is no calibration

constexpr std::array<const char*, 3> kNames{"wheel diameter ratio", "wheelbase", "wheel scale"};
constexpr std::array<Channel, 3> kChannels{Channel::difference, Channel::turn, Channel::wheels};

bool is_one_of_three(const Effect& effect) {
  return std::find(kNames.begin(), kNames.end(), effect.name) != kNames.end();
}

/// A border of those of the three that are looked for, and of how the truth sits on the drive.
EffectParameters border_of(const std::array<bool, 3>& wanted,
                           const std::vector<Recording>& recordings, const Robot& robot,
                           const WheelCalibrationOptions& options, const TruthAlignment& believed) {
  EffectParameters border;
  for (std::size_t k = 0; k < 3; ++k) {
    if (wanted[k]) border.push_back(plain_effect(kChannels[k], recordings, robot));
  }
  if (!options.problem.truth) return border;
  for (EffectPattern& one : truth_alignment(recordings, robot, options.sessions, believed)) {
    border.push_back(std::move(one));
  }
  return border;
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
  EffectParameters border;
  RecordingAdjustment adjustment;
};

Fitted fit(const std::vector<Recording>& recordings, const Model& model,
           const std::array<bool, 3>& wanted, const WheelCalibrationOptions& options,
           const TruthAlignment& believed) {
  Fitted result;
  result.corrected = without_effects(recordings, model);
  result.problem = make_problem(result.corrected, model, options.problem);
  result.border = border_of(wanted, result.corrected, model.robot, options, believed);
  result.adjustment = adjust(result.problem, result.border);
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

/// -2 log of the restricted likelihood, but for constants.
double restricted_loss(const std::vector<Recording>& corrected, Model model, double left,
                       double right, const Fitted& about, const ProblemOptions& options) {
  model.noise.left = left;
  model.noise.right = right;
  const RecordingProblem problem = make_problem(corrected, model, options);
  const RecordingAdjustment best = adjust_from(about.adjustment.state, problem, about.border);
  double loss = best.chi2;
  for (const Measurement& one : problem.measurements) {
    for (int k = 0; k < one.rows; ++k) loss -= 2.0 * std::log(std::abs(one.whitener(k, k)));
  }
  RecordingSystem system(problem, about.border);
  system.linearise(best.state, best.coefficients);
  system.factorise();
  return loss + system.log_determinant();
}

/// Minimum over log k_L and log k_R, by turns along their sum and their difference, and the
/// curvature there.
void find_noise(const Fitted& about, const ProblemOptions& options, WheelCalibration& result) {
  constexpr double kReach = 2.5;  // in log k: a factor of 12 either way
  constexpr int kBits = 9;
  const Model& model = result.model;
  Vector2 log_k(std::log(model.noise.left), std::log(model.noise.right));
  const auto loss = [&](const Vector2& at) {
    return restricted_loss(about.corrected, model, std::exp(at[0]), std::exp(at[1]), about,
                           options);
  };
  double reach = kReach;
  for (int round = 0; round < 3; ++round) {
    for (const Vector2& way : {Vector2(1.0, 1.0), Vector2(1.0, -1.0)}) {
      const double step =
          boost::math::tools::brent_find_minima([&](double by) { return loss(log_k + by * way); },
                                                -reach, reach, kBits)
              .first;
      log_k += step * way;
    }
    reach *= 0.3;
  }
  constexpr double h = 0.15;
  const double middle = loss(log_k);
  Matrix2 curvature = Matrix2::Zero();
  for (int k = 0; k < 2; ++k) {
    curvature(k, k) =
        (loss(log_k + h * Vector2::Unit(k)) + loss(log_k - h * Vector2::Unit(k)) - 2.0 * middle) /
        (h * h);
  }
  const Vector2 both(h, h);
  const double diagonal = (loss(log_k + both) + loss(log_k - both) - 2.0 * middle) / (h * h);
  curvature(0, 1) = curvature(1, 0) = 0.5 * (diagonal - curvature(0, 0) - curvature(1, 1));
  // The loss is -2 log L: its curvature is twice the information.
  const Matrix2 covariance = (0.5 * curvature).inverse();
  if (curvature(0, 0) <= 0.0 || curvature.determinant() <= 0.0) {
    result.undetermined.emplace_back(
        "k_left and k_right: the other noise in the model hides that of the wheels");
    return;
  }
  const Vector2 k = log_k.array().exp();
  result.noise_left = Calibrated{k[0], k[0] * std::sqrt(covariance(0, 0))};
  result.noise_right = Calibrated{k[1], k[1] * std::sqrt(covariance(1, 1))};
  result.model.noise.left = k[0];
  result.model.noise.right = k[1];
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
      return "E_d (right wheel / left wheel): the drive is too short to show one wheel larger than "
             "the other; drive straight lines of several metres";
    case 1:
      return "E_b (wheelbase / nominal): the robot hardly turns; drive turns, both ways";
    default:
      return measures_distance(recordings, options)
                 ? "E_s (true / measured travel): the robot hardly gets anywhere, and turns on "
                   "the spot cannot tell larger wheels from a smaller wheelbase; drive "
                   "straight lines"
                 : "E_s (true / measured travel): nothing in use measures a distance; add a "
                   "survey or truth";
  }
}

/// Which of the three the motion determines: each alone, then together.
std::array<bool, 3> determined(const std::vector<Recording>& recordings, const Model& model,
                               const WheelCalibrationOptions& options,
                               std::vector<std::string>& undetermined) {
  // By the letter a smaller map would do better: its errors are smaller, too.
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
  if (!scale) undetermined.push_back(why_not(2, recordings, options.problem));
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
      undetermined.push_back(why_not(k, recordings, options.problem));
    }
  }
  return wanted;
}

}  // namespace

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
    if (noise) find_noise(last, options.problem, result);
  }
  result.chi2 = last.adjustment.chi2;
  result.dof = last.adjustment.dof;
  Eigen::Index at = 0;
  const auto sd = [&] {
    const double variance = last.adjustment.coefficient_covariance(at, at);
    ++at;
    return std::sqrt(variance);
  };
  if (wanted[0]) {
    const double slope = 1.0 / std::pow(1.0 - 0.5 * g[0], 2);
    result.diameter_ratio = Calibrated{(1.0 + 0.5 * g[0]) / (1.0 - 0.5 * g[0]), slope * sd()};
  }
  if (wanted[1]) {
    const double ratio = 1.0 / (1.0 + g[1]);
    result.wheelbase_ratio = Calibrated{ratio, ratio * sd()};
  }
  if (wanted[2]) result.scale = Calibrated{1.0 + g[2], (1.0 + g[2]) * sd()};
  return result;
}

}  // namespace trussmap
