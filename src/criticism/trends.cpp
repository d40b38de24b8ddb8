// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/trends.hpp"

#include "criticism/tested_candidate.hpp"
#include "drive/row_variables.hpp"
#include "drive/wheel_kinematics.hpp"
#include "effects/place_patterns.hpp"
#include "estimation/kinds/kinds.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "statistics/multiple_tests.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr const char* kTurnSense = "turn sense";
constexpr const char* kSignedTurnRate = "signed turn rate";

struct Variable {
  std::string name;
  std::vector<Shape> shapes;
};

bool varies(const fitting::FitState& fit, const std::string& covariate) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const DrivenRecording& recording : fit.recordings) {
    for (const Covariate& one : recording.drive.covariates) {
      if (one.name != covariate) continue;
      for (const double value : one.values) {
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
  }
  return most > least;
}

/// Bells on a grid over the map.
Variable place_variable(const fitting::FitState& fit) {
  constexpr int kAcross = 4;
  Vector2 low(1e300, 1e300);
  Vector2 high = -low;
  for (const fitting::SessionPath& path : fit.paths) {
    for (const Pose& pose : path.ends) {
      low = low.cwiseMin(pose.position());
      high = high.cwiseMax(pose.position());
    }
  }
  Variable place{"place", {}};
  const Vector2 step = (high - low) / kAcross;
  if (!(step.maxCoeff() > 0.0)) return place;
  const auto rounded = [&step](double value) {
    return text::rounded_within(value, step.maxCoeff());
  };
  const double radius = rounded(0.6 * step.maxCoeff());
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const Vector2 at = low + Vector2((i + 0.5) * step.x(), (j + 0.5) * step.y());
      place.shapes.emplace_back(effects::kBellPattern,
                                std::vector<ShapeParameter>{
                                    {"x", rounded(at.x())}, {"y", rounded(at.y())}, {"r", radius}});
    }
  }
  return place;
}

/// Turn rate [rad/s] that the wheels' noise does not feign: four standard deviations of the mean
/// over half a window, as shapes see it beside a change of motion.
double faintest_turn(const fitting::FitState& fit) {
  const Noise& noise = fit.model.noise;
  Noise wheels_alone;
  wheels_alone.left = noise.left;
  wheels_alone.right = noise.right;
  std::vector<double> deviations;
  for (const DrivenRecording& recording : fit.recordings) {
    const MotionRows& drive = recording.drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const double duration = drive.duration(row);
      const Robot& robot = fit.model.robot;
      const double variance =
          drive.wheels.empty()
              ? odometry::wheels_noise(drive, row, 1.0, duration, robot, wheels_alone).heading
              : odometry::row_noise(drive, row, 1.0, duration, robot, noise).heading;
      if (variance == 0.0) continue;
      const double window = std::max(duration, 0.5 * drive::kRateWindow);
      deviations.push_back(std::sqrt(variance / duration / window));
    }
  }
  if (deviations.empty()) return 0.0;
  const auto high = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() * 9 / 10);
  std::nth_element(deviations.begin(), high, deviations.end());
  return text::rounded_within(4.0 * *high, *high);
}

/// The sign of the turn rate, but 0 where the robot drives straight: there the sign would be the
/// noise's own, and go with every error that this noise makes.
Shape turn_sense(const fitting::FitState& fit) {
  return {"(sign(turn_rate-{w})+sign(turn_rate+{w}))/2", {{"w", faintest_turn(fit)}}};
}

std::vector<Variable> variables_of(const fitting::FitState& fit) {
  std::vector<Variable> variables{{"all", {"1"}},
                                  {"heading", {"sin(heading)", "cos(heading)"}},
                                  {kTurnSense, {turn_sense(fit)}},
                                  {"turn rate", {"abs(turn_rate)"}},
                                  {kSignedTurnRate, {"turn_rate"}},
                                  {"direction of travel", {"sign(speed)"}},
                                  {"speed", {"abs(speed)"}},
                                  {"acceleration", {"acceleration"}},
                                  {"t", {"t"}},
                                  {"distance", {"distance"}}};
  Variable place = place_variable(fit);
  if (!place.shapes.empty()) variables.push_back(std::move(place));
  if (fit.recordings.size() > 1) variables.push_back({"session", {"session"}});
  for (const Covariate& covariate : fit.recordings.front().drive.covariates) {
    if (drive::is_own_column(fit.model.robot, covariate.name)) continue;
    if (varies(fit, covariate.name)) variables.push_back({covariate.name, {covariate.name}});
  }
  return variables;
}

/// Of the drive, of what was measured, and of where the sensor sits.
std::vector<estimation::NamedResidual> residuals_of(const fitting::FitState& fit) {
  std::vector<estimation::NamedResidual> all{{"stretch", Channel::travel},
                                             {"orientation", Channel::creep},
                                             {"turn", Channel::turn},
                                             {"bend", Channel::difference}};
  for (const estimation::MeasurementKind* kind : estimation::kinds::all()) {
    int rows = 0;
    for (const estimation::Measurement& one : fit.problem.measurements) {
      if (one.kind == kind) rows = std::max(rows, one.rows);
    }
    if (rows == 0) continue;
    const std::vector<estimation::NamedResidual> own = kind->residuals(rows);
    all.insert(all.end(), own.begin(), own.end());
  }
  all.push_back({"sighting ahead", Channel::lever});
  all.push_back({"sighting to the left", Channel::lever_left});
  return all;
}

/// Whether the variable holds the very noise of this residual. The difference of the wheels is the
/// turn rate: where the robot weaves, its noise decides many a sign.
bool is_its_own_noise(const estimation::NamedResidual& kind, const Variable& variable) {
  return kind.channel == Channel::difference &&
         (variable.name == kTurnSense || variable.name == kSignedTurnRate);
}

/// Mean over all rows of f f', f the shapes' values: a trend of coefficients a is sqrt(a' G a) in
/// size (rms).
Eigen::MatrixXd mean_products(const std::vector<Shape>& shapes,
                              const fitting::ShapeContext& context) {
  const auto count = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, count);
  std::vector<std::vector<std::vector<double>>> values;
  values.reserve(shapes.size());
  for (const Shape& shape : shapes) {
    values.push_back(context.values(shape, fitting::ShapeContext::Instant::middle));
  }
  double rows = 0.0;
  for (std::size_t s = 0; s < context.recordings().size(); ++s) {
    const auto of = [&](Eigen::Index k) {
      const std::vector<double>& f = values[idx(k)][s];
      return Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size()));
    };
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) sums(i, j) += of(i).dot(of(j));
    }
    rows += static_cast<double>(of(0).size());
  }
  return Eigen::MatrixXd(sums.selfadjointView<Eigen::Lower>()) / std::max(1.0, rows);
}

}  // namespace

std::vector<Trend> find_trends(const fitting::FitState& fit, const ScoreTest& tests) {
  const std::vector<estimation::NamedResidual> residuals = residuals_of(fit);
  const std::vector<Variable> variables = variables_of(fit);
  // Variable by variable, so that its shapes are evaluated once; listed kind by kind.
  std::vector<std::vector<Trend>> found(residuals.size());
  for (const Variable& variable : variables) {
    std::vector<Candidate> candidates;
    std::vector<std::size_t> of;
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      if (is_its_own_noise(residuals[k], variable)) continue;
      candidates.emplace_back();
      Effect& effect = candidates.back().effect;
      effect.name = residuals[k].name + " against " + variable.name;
      effect.channel = residuals[k].channel;
      effect.shape = variable.shapes;
      of.push_back(k);
    }
    tests.forget();  // the last variable's shapes
    const Eigen::MatrixXd products = mean_products(variable.shapes, tests.context());
    visit_scores(tests, candidates, Resolution::exact, [&](std::size_t k, const Score& score) {
      if (score.dof == 0) return;
      Trend trend;
      trend.kind = residuals[of[k]].name;
      trend.against = variable.name;
      trend.effect = candidates[k].effect;
      trend.effect.coefficients = score.coefficients;
      trend.unit = facts_of(trend.effect.channel).unit;
      trend.score = score.score;
      trend.dof = score.dof;
      trend.p_value = score.p_value;
      const Eigen::Map<const Eigen::VectorXd> a(score.coefficients.data(), products.cols());
      trend.size = std::sqrt(std::max(0.0, a.dot(products * a)));
      found[of[k]].push_back(std::move(trend));
    });
  }
  std::vector<double> p_values;
  std::vector<Trend> seen;
  for (std::vector<Trend>& of_kind : found) {
    for (Trend& trend : of_kind) {
      p_values.push_back(trend.p_value);
      seen.push_back(std::move(trend));
    }
  }
  const std::vector<double> adjusted = statistics::holm(p_values);
  for (std::size_t k = 0; k < seen.size(); ++k) seen[k].p_adjusted = adjusted[k];
  // A p-value of 0 says nothing of two: what a trend explains beyond its own freedom does.
  std::stable_sort(seen.begin(), seen.end(), [](const Trend& a, const Trend& b) {
    return a.score - 2.0 * a.dof > b.score - 2.0 * b.dof;
  });
  return seen;
}

}  // namespace trussmap::criticism
