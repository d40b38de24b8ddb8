// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/wheel_calibration.hpp"

#include "calibration/heading_offset.hpp"
#include "calibration/measured_distance.hpp"
#include "calibration/most_likely_noise.hpp"
#include "calibration/reference_alignment.hpp"
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "drive/steered_motion.hpp"
#include "effects/steering.hpp"
#include "effects/wheel_factors.hpp"
#include "estimation/recording_adjustment.hpp"
#include "fit/effect_columns.hpp"
#include "geometry/index.hpp"
#include "odometry/effect_correction.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::calibration {
namespace {

/// What is told of references: which of them are asked where they sit, what is known of them.
struct References {
  ReferencesUsed used;
  ReferenceAlignment found;
};

/// Parameters: those of the constants that are wanted, and the alignment of the references.
estimation::EffectParameters parameters_of(const Wanted& wanted,
                                           const std::vector<DrivenRecording>& recordings,
                                           const Robot& robot,
                                           const WheelCalibrationOptions& options,
                                           const References& references) {
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  estimation::EffectParameters parameters;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (wanted[k])
      parameters.push_back(estimation::plain_effect(constants[k].channel, recordings, robot));
  }
  for (estimation::EffectPattern& one :
       reference_alignment(recordings, references.used, options.sessions, references.found)) {
    parameters.push_back(std::move(one));
  }
  return parameters;
}

/// The recordings with the model's effects taken out, and a problem of them.
struct Fitted {
  std::vector<DrivenRecording> corrected;
  estimation::RecordingProblem problem;
  estimation::EffectParameters parameters;
  estimation::RecordingAdjustment adjustment;
};

/// What turning and travel are scaled by, steering's columns and the noise of its readings are.
void scale_steering(const std::vector<double>& g, const Wanted& wanted, const Robot& robot,
                    Fitted& fitted) {
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  double ahead = 1.0;
  double turned = 1.0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].channel == Channel::wheels) ahead += g[k];
    if (constants[k].channel == Channel::turn) turned += g[k];
  }
  turned *= ahead;
  std::size_t at = 0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (!wanted[k]) continue;
    estimation::EffectPattern& column = fitted.parameters[at++];
    if (!effects::is_steering(constants[k].channel)) continue;
    for (std::vector<effects::DrivePattern>& rows : column.drives) {
      for (effects::DrivePattern& row : rows) {
        row.advance *= ahead;
        row.turn *= turned;
        row.excess *= turned;
      }
    }
  }
  for (DrivenRecording& one : fitted.corrected) {
    for (WheelColumn& column : one.drive.wheels) {
      for (std::array<double, 3>& by : column.by_reading) {
        by[0] *= ahead;
        by[2] *= turned;
      }
    }
  }
}

/// `next`, or so much of the way to it as leaves the measured wheel a way ahead in every row.
std::vector<double> shortened(const std::vector<double>& g, std::vector<double> next,
                              const std::vector<DrivenRecording>& recordings, const Model& model) {
  constexpr int kHalvings = 20;
  for (int halving = 0; halving < kHalvings; ++halving) {
    if (fitting::leave_a_way(with_constants(model, next).effects, recordings, model.robot, {}))
      return next;
    for (std::size_t k = 0; k < g.size(); ++k) next[k] = 0.5 * (g[k] + next[k]);
  }
  return g;
}

/// Wheels' noise is of what they show, and moves the body by factors far from one, too. The motion
/// has them already.
void take_in_factors(const Model& model, std::vector<DrivenRecording>& corrected) {
  for (std::size_t s = 0; s < corrected.size(); ++s) {
    const std::optional<WheelFactors> factors = effects::wheel_factors(
        model.effects, model.robot, static_cast<int>(s), effects::FactorsAct::in_turn);
    if (factors && effects::difference(*factors, model.robot) > effects::kFarFactors) {
      corrected[s].drive.factors = factors;
    }
  }
}

Fitted fit(const std::vector<DrivenRecording>& recordings, const Model& model, const Wanted& wanted,
           const WheelCalibrationOptions& options, const References& references) {
  Fitted result;
  result.corrected = odometry::without_effects(recordings, model);
  result.parameters = parameters_of(wanted, result.corrected, model.robot, options, references);
  if (drive::has_steering(model.robot))
    scale_steering(in_force(model), wanted, model.robot, result);
  take_in_factors(model, result.corrected);
  result.problem = estimation::make_problem(result.corrected, model, options.problem);
  estimation::RecordingAdjustmentOptions how;
  how.gate = options.gate;
  how.most_left_out = kMostLeftOut;
  result.adjustment = estimation::adjust(result.problem, result.parameters, how);
  return result;
}

/// Whether it may well be nothing, under other noise that is stated far too large.
bool is_hidden(const WheelNoiseFit& found, const estimation::RecordingAdjustment& adjustment) {
  constexpr double kFarTooSmall = 0.5;  // chi^2/dof
  return adjustment.chi2 < kFarTooSmall * adjustment.dof &&
         (found.k.array() < found.sd.array()).all();
}

/// k_L and k_R by the fit of the geometry, in the result and in its model.
void find_noise(const Fitted& about, const estimation::ProblemOptions& options,
                WheelCalibration& result) {
  const std::optional<WheelNoiseFit> found = most_likely_noise(
      about.corrected, result.model, options, about.parameters, about.adjustment.state);
  if (!found || is_hidden(*found, about.adjustment)) {
    result.undetermined.emplace_back(
        "k_left and k_right: the other noise in the model hides that of the wheels");
    return;
  }
  result.noise_left = Calibrated{found->k[0], found->sd[0]};
  result.noise_right = Calibrated{found->k[1], found->sd[1]};
  result.model.noise.left = found->k[0];
  result.model.noise.right = found->k[1];
}

std::string undetermined_text(const SoughtConstant& one, bool scale) {
  return one.symbol + ": " + (scale ? one.missing : one.missing_without_distance);
}

bool is_asked(const SoughtConstant& one, const WheelCalibrationOptions& options) {
  return !one.seldom || std::ranges::count(options.seldom, one.channel) > 0;
}

Wanted asked_for(const std::vector<SoughtConstant>& constants, bool scale,
                 const WheelCalibrationOptions& options) {
  Wanted wanted;
  for (const SoughtConstant& one : constants) {
    wanted.push_back((scale || !shows_scale(one.channel)) && is_asked(one, options));
  }
  return wanted;
}

/// Which of them the motion determines: each alone, then jointly.
Wanted determined(const std::vector<DrivenRecording>& recordings, const Model& model,
                  const WheelCalibrationOptions& options, const ReferencesUsed& used,
                  std::vector<std::string>& undetermined) {
  const References references{used, {}};
  // Without a measured distance the least chi^2 lies at a smaller map: its errors shrink with it.
  const bool scale = measures_distance(recordings, options.problem, model.noise);
  const std::vector<SoughtConstant> constants = sought_constants(model.robot);
  Wanted wanted = asked_for(constants, scale, options);
  const auto can = [&](const Wanted& these) {
    try {
      const Fitted one = fit(recordings, model, these, options, references);
      const Eigen::VectorXd variances = one.adjustment.coefficient_covariance.diagonal();
      Eigen::Index at = 0;
      for (std::size_t k = 0; k < these.size(); ++k) {
        if (!these[k]) continue;
        if (!(std::sqrt(variances[at++]) < useless_sd(constants[k], model))) return false;
      }
      return true;
    } catch (const SolveError&) {
      return false;
    }
  };
  for (const SoughtConstant& one : constants) {
    if (scale || !shows_scale(one.channel)) continue;
    undetermined.push_back(undetermined_text(one, scale));
  }
  if (can(wanted)) return wanted;
  // Nothing at all: let the reason through.
  wanted.assign(constants.size(), false);
  static_cast<void>(fit(recordings, model, wanted, options, references));
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if ((shows_scale(constants[k].channel) && !scale) || !is_asked(constants[k], options)) continue;
    Wanted more = wanted;
    more[k] = true;
    if (can(more)) {
      wanted = more;
    } else {
      undetermined.push_back(undetermined_text(constants[k], scale));
    }
  }
  return wanted;
}

/// The determined constants as effects, with their covariance.
void keep_covariance(WheelCalibration& result, const std::vector<double>& g, const Wanted& wanted,
                     const estimation::RecordingAdjustment& adjustment) {
  const std::vector<SoughtConstant> constants = sought_constants(result.model.robot);
  std::vector<double> found;
  std::vector<double> slopes;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (!wanted[k]) continue;
    result.channels.push_back(constants[k].channel);
    found.push_back(g[k]);
    slopes.push_back(share_before_turning(constants, g, k) * constants[k].slope(g[k]));
  }
  const auto size = std::ssize(found);
  const Eigen::VectorXd slope = Eigen::VectorXd::Map(slopes.data(), size);
  result.g = Eigen::VectorXd::Map(found.data(), size);
  result.covariance = slope.asDiagonal() *
                      adjustment.coefficient_covariance.topLeftCorner(size, size) *
                      slope.asDiagonal();
}

/// chi^2, and the constants with their standard errors.
void read_constants(WheelCalibration& result, const std::vector<double>& g, const Wanted& wanted,
                    const estimation::RecordingAdjustment& adjustment) {
  result.chi2 = adjustment.chi2;
  result.dof = adjustment.dof;
  const Robot& robot = result.model.robot;
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  keep_covariance(result, g, wanted, adjustment);
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (!wanted[k]) continue;
    const double sd = share_before_turning(constants, g, k) *
                      std::sqrt(adjustment.coefficient_covariance(at, at));
    ++at;
    const Channel channel = constants[k].channel;
    const double ratio = constants[k].ratio(g[k]);
    if (robot.drive != DriveKind::differential) {
      const bool multiplies = channel == Channel::turn || channel == Channel::wheels ||
                              channel == Channel::travel || channel == Channel::sideways;
      result.constants.push_back({channel, {g[k], multiplies ? (1.0 + g[k]) * sd : sd}});
    } else if (channel == Channel::difference) {
      result.diameter_ratio = Calibrated{ratio, ratio * sd};
    } else if (channel == Channel::turn) {
      result.wheelbase_ratio = Calibrated{ratio, ratio * sd};
    } else {
      result.scale = Calibrated{ratio, ratio * sd};
    }
  }
}

/// Whether a round moved no estimate by more than `kStill` of its standard error.
bool stands_still(const estimation::RecordingAdjustment& adjustment, Eigen::Index geometry) {
  constexpr double kStill = 0.1;
  const Eigen::ArrayXd steps = adjustment.coefficients.head(geometry).array().abs();
  const Eigen::ArrayXd variances = adjustment.coefficient_covariance.diagonal().head(geometry);
  return (steps <= kStill * variances.sqrt()).all();
}

/// Wheels that run backwards, or change sides: the truth is not what it is said to be.
void require_positive(const std::vector<double>& g, const Wanted& wanted,
                      const std::vector<DrivenRecording>& recordings, const Model& model,
                      const estimation::ProblemOptions& options) {
  const std::vector<SoughtConstant> constants = sought_constants(model.robot);
  const bool truth = options.truth && std::any_of(recordings.begin(), recordings.end(),
                                                  [](const DrivenRecording& recording) {
                                                    return !recording.truth.empty();
                                                  });
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const double ratio = constants[k].ratio(g[k]);
    if (!wanted[k] || ratio > 0.0) continue;
    const std::string why = truth ? describe(heading_offset(recordings)) : "";
    throw SolveError(fmt::format(
        "not calibrated: {} would be {:.3g}, which no robot has; {}", constants[k].symbol, ratio,
        why.empty() ? "are left and right exchanged, or the signs of x or y?" : why));
  }
}

/// What the last fit says of the references.
ReferenceAlignment alignment_by(const Fitted& last, Eigen::Index geometry,
                                const std::vector<DrivenRecording>& recordings, const Robot& robot,
                                const ReferencesUsed& used,
                                const WheelCalibrationOptions& options) {
  const Eigen::Index more = last.adjustment.coefficients.size() - geometry;
  return alignment_of(recordings, robot, used, options.sessions,
                      last.adjustment.coefficients.tail(more),
                      last.adjustment.coefficient_covariance.bottomRightCorner(more, more));
}

/// The references in use, of a sensor and a scanner those alone that a fit of all constants and
/// places tells the place of: held where they are stated they tell more of the wheels.
ReferencesUsed told_in(const std::vector<DrivenRecording>& recordings, const Model& model,
                       const WheelCalibrationOptions& options) {
  ReferencesUsed used = references_in(recordings, options.problem);
  if (!used.sensor && !used.scanner) return used;
  const bool scale = measures_distance(recordings, options.problem, model.noise);
  const Wanted wanted = asked_for(sought_constants(model.robot), scale, options);
  const ReferencesUsed all = used;
  used.sensor = used.scanner = false;
  try {
    const Fitted one = fit(recordings, model, wanted, options, {all, {}});
    const auto geometry = static_cast<Eigen::Index>(std::count(wanted.begin(), wanted.end(), true));
    for (const CalibratedMounting& found :
         alignment_by(one, geometry, recordings, model.robot, all, options).mountings) {
      const bool told = found.x && found.y;
      if (found.of == "sensor") used.sensor = told;
      if (found.of == "scanner") used.scanner = told;
    }
  } catch (const SolveError&) {
    return used;
  }
  return used;
}

std::vector<LeftOutRow> left_out_by(const Fitted& last) {
  std::vector<LeftOutRow> rows;
  for (const int k : last.adjustment.left_out) {
    const estimation::Measurement& one = last.problem.measurements[idx(k)];
    rows.push_back({one.kind->facts().stream, one.session, one.source,
                    estimation::describe(last.problem, one)});
  }
  return rows;
}

}  // namespace

CalibrationByParts calibrated_by_parts(std::vector<double> g,
                                       const std::vector<DrivenRecording>& recordings,
                                       const Model& model, const WheelCalibrationOptions& options) {
  constexpr double kSettled = 1e-10;
  WheelCalibration result;
  result.model = with_constants(model, g);
  Mountings& mounted = result.model.robot.mounted;
  mounted = started_places(odometry::without_effects(recordings, result.model), model.robot);
  References references{told_in(recordings, result.model, options), {}};
  if (!references.used.scanner) mounted.scanner = model.robot.mounted.scanner;
  if (!references.used.sensor) mounted.sensor = model.robot.mounted.sensor;
  const Wanted wanted =
      determined(recordings, result.model, options, references.used, result.undetermined);
  const Eigen::Index geometry = std::count(wanted.begin(), wanted.end(), true);
  // Noise weighs the measurements, so it is found between two fits of the geometry.
  Fitted last;
  for (const bool noise : {options.noise, false}) {
    for (int round = 0; round < options.rounds; ++round) {
      last = fit(recordings, result.model, wanted, options, references);
      g = shortened(g, refined(g, wanted, model.robot, last.adjustment.coefficients), recordings,
                    result.model);
      result.model = with_constants(result.model, g);
      references.found =
          alignment_by(last, geometry, recordings, result.model.robot, references.used, options);
      mounted = with_found(mounted, references.found);
      const Eigen::VectorXd steps = last.adjustment.coefficients.head(geometry);
      if (geometry == 0 || steps.cwiseAbs().maxCoeff() < kSettled) break;
    }
    require_positive(g, wanted, recordings, model, options.problem);
    if (noise && model.robot.drive == DriveKind::differential)
      find_noise(last, options.problem, result);
  }
  result.truth = std::move(references.found.truth);
  result.fixes = std::move(references.found.fixes);
  result.mountings = std::move(references.found.mountings);
  read_constants(result, g, wanted, last.adjustment);
  result.settled = stands_still(last.adjustment, geometry);
  return {std::move(result), left_out_by(last)};
}

WheelCalibration calibrated_from(std::vector<double> g,
                                 const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const WheelCalibrationOptions& options) {
  return calibrated_by_parts(std::move(g), recordings, model, options).found;
}

}  // namespace trussmap::calibration
