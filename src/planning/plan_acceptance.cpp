// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"
#include "criticism/score_test.hpp"
#include "geometry/index.hpp"
#include "planning/drive_for_questions.hpp"
#include "planning/rivals.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace planning;

namespace {

constexpr double kFastest = 0.9;  // m/s

int start_on(const LandmarkGraph& map, const std::string& name) {
  if (map.landmarks() == 0) throw std::invalid_argument("the map has no landmark");
  const std::optional<int> start = name.empty() ? std::optional(0) : map.find(name);
  if (!start || map.routes_at(*start).empty()) {
    throw std::invalid_argument("the start " + (name.empty() ? map.landmark(0).name : name) +
                                " is no landmark that a route leads to");
  }
  return *start;
}

RouteNetwork routes_of(const LandmarkGraph& map) {
  RouteNetwork routes;
  for (int place = 0; place < map.landmarks(); ++place) {
    routes.names.push_back(map.landmark(place).name);
    routes.positions.push_back(map.landmark(place).position);
    routes.exits.emplace_back();
    for (const int route : map.routes_at(place)) {
      routes.exits.back().push_back(other_end(map.route(route), place));
    }
  }
  return routes;
}

PlanWorld world_on(const LandmarkGraph& map, const Model& model, const AcceptanceOptions& options) {
  PlanWorld world;
  lay_near(start_on(map, options.start), routes_of(map), world);
  world.model = model;
  world.model.effects.clear();
  world.robot.geometry = model.robot;
  world.robot.noise = kNoiseFree;
  world.robot.compass = options.compass;
  world.robot.gyro = options.gyro;
  const double limit = options.max_speed > 0.0 ? options.max_speed : kFastest;
  const double slow = std::min(options.slowest, limit);
  world.speeds = {slow, 0.5 * (slow + limit), limit};
  world.turn_rates = {0.3, 1.0};
  for (const auto& [name, value] :
       {std::pair("payload_kg", 0.0), std::pair("lights", 0.0), std::pair("temperature_C", 20.0)}) {
    world.columns.push_back({name, {0.0}, {value}});
  }
  return world;
}

/// What is known of the landmarks before the drive.
DriveInformation known_of(const LandmarkGraph& map, const PlanWorld& world, Eigen::Index columns) {
  DriveInformation known{world.mesh.names, {}};
  const Eigen::Index size = known.first_column() + columns;
  known.H = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < known.landmarks.size(); ++k) {
    const Landmark& one = map.landmark(*map.find(known.landmarks[k]));
    const double sd = world.model.noise.survey;
    const Matrix2 covariance = one.covariance.value_or(Matrix2::Identity() * sd * sd);
    const Eigen::Index at = 2 * static_cast<Eigen::Index>(k);
    if (covariance.determinant() > 0.0) known.H.block<2, 2>(at, at) = covariance.inverse();
  }
  return known;
}

/// Effects of the catalogue that such a drive may show, with the practical size of each shape.
std::vector<PlannedEffect> practical_effects(const fitting::FitState& fit, double times) {
  const criticism::ScoreTest tests(fit);
  std::vector<PlannedEffect> effects;
  for (const criticism::Candidate& one : criticism::candidates_for(fit, tests.context())) {
    const CatalogueEntry* entry =
        one.form == criticism::Form::catalogue ? find_entry(one.effect.name) : nullptr;
    if (entry == nullptr || entry->has_parameters() || !(entry->detectable > 0.0)) continue;
    if (speaks_of_sessions(one.effect)) continue;
    PlannedEffect effect{one.effect};
    effect.size = times * entry->detectable;
    effects.push_back(std::move(effect));
  }
  std::vector<Effect> asked;
  asked.reserve(effects.size());
  for (const PlannedEffect& one : effects) asked.push_back(one.effect);
  const std::vector<criticism::Score> scores = tests.test(asked);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    for (const double largest : scores[k].largest) {
      effects[k].effect.coefficients.push_back(largest > 0.0 ? effects[k].size / largest : 0.0);
    }
  }
  return effects;
}

/// A question per shape of each effect, and whose it is.
struct Asked {
  std::vector<Question> questions;
  std::vector<std::size_t> effects;
};

Asked questions_of(const std::vector<PlannedEffect>& effects,
                   const std::vector<std::vector<Eigen::Index>>& columns,
                   const AcceptanceOptions& options) {
  Asked asked;
  const double level =
      options.level / static_cast<double>(std::max<std::size_t>(1, effects.size()));
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const auto shapes = static_cast<Eigen::Index>(columns[k].size());
    for (Eigen::Index shape = 0; shape < shapes; ++shape) {
      Question one;
      one.columns = columns[k];
      one.sizes = Eigen::VectorXd::Zero(shapes);
      one.sizes[shape] = effects[k].effect.coefficients[idx(shape)];
      one.threshold = statistics::chi2_quantile(1.0 - level, static_cast<double>(shapes));
      want_power(one, options.power);
      asked.questions.push_back(std::move(one));
      asked.effects.push_back(k);
    }
  }
  return asked;
}

/// Of each effect the shape that is seen worst.
void tell_effects(const Asked& asked, const std::vector<double>& lambdas,
                  const std::vector<bool>& beyond, PlannedDrive& result) {
  for (PlannedEffect& one : result.effects) one.power = 1.0;
  result.power = 1.0;
  for (std::size_t k = 0; k < lambdas.size(); ++k) {
    PlannedEffect& one = result.effects[asked.effects[k]];
    const double power = power_of(asked.questions[k], lambdas[k]);
    if (power <= one.power) {
      one.power = power;
      one.lambda = lambdas[k];
    }
    if (!beyond[k]) result.power = std::min(result.power, power);
  }
}

}  // namespace

PlannedDrive plan_acceptance(const LandmarkGraph& map, const Model& model,
                             const AcceptanceOptions& options) {
  check_plan_options(options);
  if (!(options.size > 0.0)) throw std::invalid_argument("the practical size must be above 0");
  const PlanWorld world = world_on(map, model, options);
  const DrivePlan thorough = plan_of(world, thorough_tour(world));
  PlannedDrive result;
  result.options = static_cast<const PlanOptions&>(options);
  result.effects = practical_effects(planned_fit(world, thorough), options.size);
  std::vector<Effect> effects;
  for (const PlannedEffect& one : result.effects) effects.push_back(one.effect);
  const Asked asked = questions_of(result.effects, columns_of(effects), options);
  Eigen::Index columns = 0;
  for (const Effect& one : effects) columns += static_cast<Eigen::Index>(one.shape.size());
  const SearchTask task{world,
                        known_of(map, world, columns),
                        effects,
                        {},
                        asked.questions,
                        {},
                        1.0,
                        options.most_time,
                        options.most_length};
  const std::vector<bool> beyond = beyond_drives(task, lambdas_of(task, gram_before(task)));
  for (std::size_t k = 0; k < beyond.size(); ++k) {
    if (beyond[k]) result.effects[asked.effects[k]].beyond = true;
  }
  tell_effects(asked, drive_for(task, beyond, result), beyond, result);
  return result;
}

}  // namespace trussmap
