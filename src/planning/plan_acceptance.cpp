// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"
#include "criticism/score_test.hpp"
#include "geometry/index.hpp"
#include "planning/instruments.hpp"
#include "planning/rivals.hpp"
#include "planning/tour_search.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/session.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

constexpr double kBeyondTour = 0.25;    // of the lambda wanted: a thorough tour shows less of it
constexpr std::size_t kMostOfMap = 30;  // landmarks
constexpr double kFastest = 0.9;        // m/s

/// The start and the nearest landmarks by routes, by their numbers in the map.
std::vector<int> places_near(const LandmarkGraph& map, int start) {
  std::vector<int> found;
  std::vector<bool> done(idx(map.landmarks()), false);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(0.0, start);
  while (!queue.empty() && found.size() < kMostOfMap) {
    const auto [way, here] = queue.top();
    queue.pop();
    if (done[idx(here)]) continue;
    done[idx(here)] = true;
    found.push_back(here);
    for (const int route : map.routes_at(here)) {
      const int to = other_end(map.route(route), here);
      queue.emplace(way + (map.landmark(to).position - map.landmark(here).position).norm(), to);
    }
  }
  return found;
}

int start_on(const LandmarkGraph& map, const std::string& name) {
  if (map.landmarks() == 0) throw std::invalid_argument("the map has no landmark");
  const std::optional<int> start = name.empty() ? std::optional(0) : map.find(name);
  if (!start || map.routes_at(*start).empty()) {
    throw std::invalid_argument("the start " + (name.empty() ? map.landmark(0).name : name) +
                                " is no landmark that a route leads to");
  }
  return *start;
}

PlanWorld world_on(const LandmarkGraph& map, const Model& model, const AcceptanceOptions& options) {
  PlanWorld world;
  const std::vector<int> places = places_near(map, start_on(map, options.start));
  std::vector<int> numbers(idx(map.landmarks()), -1);
  for (const int place : places) {
    numbers[idx(place)] = static_cast<int>(world.mesh.names.size());
    world.mesh.names.push_back(map.landmark(place).name);
    world.mesh.positions.push_back(map.landmark(place).position);
  }
  for (const int place : places) {
    world.exits.emplace_back();
    for (const int route : map.routes_at(place)) {
      const int to = numbers[idx(other_end(map.route(route), place))];
      if (to >= 0) world.exits.back().push_back(to);
    }
  }
  world.mesh.size = {static_cast<int>(places.size()), 1};
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
std::vector<PlannedEffect> practical_effects(const FitState& fit, double times) {
  const ScoreTest tests(fit);
  std::vector<PlannedEffect> effects;
  for (const Candidate& one : candidates_for(fit, tests.context())) {
    const CatalogueEntry* entry =
        one.form == Form::catalogue ? find_entry(one.effect.name) : nullptr;
    if (entry == nullptr || entry->has_parameters() || !(entry->detectable > 0.0)) continue;
    if (speaks_of_sessions(one.effect)) continue;
    PlannedEffect effect{one.effect};
    effect.size = times * entry->detectable;
    effects.push_back(std::move(effect));
  }
  std::vector<Effect> asked;
  asked.reserve(effects.size());
  for (const PlannedEffect& one : effects) asked.push_back(one.effect);
  const std::vector<Score> scores = tests.test(asked);
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
      one.threshold = chi2_quantile(1.0 - level, static_cast<double>(shapes));
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
  SearchTask task{world,
                  known_of(map, world, columns),
                  effects,
                  {},
                  asked.questions,
                  {},
                  1.0,
                  options.most_time,
                  options.most_length};
  const std::vector<double> shown = lambdas_of(task, gram_with(task, world, thorough));
  std::vector<bool> beyond;
  task.questions.clear();
  for (std::size_t k = 0; k < shown.size(); ++k) {
    beyond.push_back(shown[k] < kBeyondTour * asked.questions[k].wanted);
    if (beyond[k]) result.effects[asked.effects[k]].beyond = true;
    if (!beyond[k]) task.questions.push_back(asked.questions[k]);
  }
  const auto tell_without_drive = [&] {
    task.questions = asked.questions;
    tell_effects(asked, lambdas_of(task, gram_before(task)), beyond, result);
    return result;
  };
  if (task.questions.empty()) return tell_without_drive();
  const FoundTour found = search_tour(task);
  result.enough = found.value.least >= 1.0;
  if (found.tour.legs.empty()) return tell_without_drive();
  result.plan = plan_of(world, found.tour);
  result.length = found.value.length;
  result.duration = found.value.time;
  task.questions = asked.questions;
  tell_effects(asked, lambdas_of(task, gram_with(task, world, result.plan)), beyond, result);
  result.worth = worth_of_instruments(task, result.plan, beyond);
  return result;
}

}  // namespace trussmap
