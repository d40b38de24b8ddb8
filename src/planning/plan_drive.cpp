// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/instruments.hpp"
#include "planning/recorded_world.hpp"
#include "planning/rivals.hpp"
#include "planning/tour_search.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap {
namespace {

constexpr double kBeyond = 0.25;  // of the lambda that is lacking: a thorough tour tells less of it

/// Whether any goes with what depends on all that was driven before.
bool goes_on(const std::vector<Effect>& rivals, const PlanWorld& world) {
  for (const std::string& name : variables_in(rivals)) {
    if (name == "t" || name == "distance") return true;
    for (const ColumnInTime& one : world.columns) {
      if (one.name == name && one.values.size() > 1) return true;
    }
  }
  return false;
}

struct Pair {
  std::size_t truth = 0;
  std::size_t rival = 0;
};

Question question_of(const Pair& pair, const RivalSubject& subject,
                     const std::vector<std::vector<Eigen::Index>>& columns,
                     const PlanOptions& options) {
  const std::vector<double>& sizes = subject.rivals[pair.truth].coefficients;
  Question one;
  one.columns = columns[pair.truth];
  one.others = columns[pair.rival];
  one.sizes =
      Eigen::Map<const Eigen::VectorXd>(sizes.data(), static_cast<Eigen::Index>(sizes.size()));
  one.sd_share = std::sqrt(subject.phi / std::max(subject.phi, subject.scores[pair.truth]));
  one.threshold = std::max(
      kToldApart, chi2_quantile(1.0 - options.level, static_cast<double>(one.columns.size())));
  want_power(one, options.power);
  return one;
}

}  // namespace

PlannedDrive plan_drive(const Diagnosis& diagnosis, const PlanOptions& options) {
  check_plan_options(options);
  const FitState& fit = *diagnosis.under->fit.state;
  const RivalSubject subject = rivals_of(diagnosis, options);
  const PlanWorld world =
      recorded_world(fit, variables_in(subject.rivals), options.start, options.max_speed);
  std::vector<Effect> effects = subject.rivals;
  effects.insert(effects.end(), subject.beside.begin(), subject.beside.end());
  SearchTask task{world,
                  reduced_to(information_of(fit, {effects, subject.own, true}), world.mesh.names),
                  effects,
                  subject.own,
                  {},
                  {},
                  subject.phi,
                  options.most_time,
                  options.most_length};
  task.goes_on = goes_on(subject.rivals, world);
  const auto columns = columns_of(effects);
  for (std::size_t k = subject.rivals.size(); k < columns.size(); ++k) {
    task.beside.insert(task.beside.end(), columns[k].begin(), columns[k].end());
  }
  std::vector<Pair> pairs;
  std::vector<Question> questions;
  for (std::size_t truth = 0; truth < subject.rivals.size(); ++truth) {
    for (std::size_t rival = 0; rival < subject.rivals.size(); ++rival) {
      if (rival == truth) continue;
      pairs.push_back({truth, rival});
      questions.push_back(question_of(pairs.back(), subject, columns, options));
    }
  }
  task.questions = questions;
  PlannedDrive result;
  result.options = options;
  const std::vector<double> before = lambdas_of(task, gram_before(task));
  const std::vector<double> thorough =
      lambdas_of(task, gram_with(task, world, plan_of(world, thorough_tour(world))));
  task.questions.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    PlannedPair pair{subject.rivals[pairs[k].truth], subject.rivals[pairs[k].rival]};
    pair.before = pair.after = before[k];
    pair.power_before = pair.power = power_of(questions[k], before[k]);
    pair.beyond = thorough[k] - before[k] < kBeyond * (questions[k].wanted - before[k]);
    if (!pair.beyond) task.questions.push_back(questions[k]);
    result.pairs.push_back(std::move(pair));
  }
  if (task.questions.empty()) return result;
  const FoundTour found = search_tour(task);
  result.enough = found.value.least >= 1.0;
  if (found.tour.legs.empty()) return result;
  result.plan = plan_of(world, found.tour);
  result.length = found.value.length;
  result.duration = found.value.time;
  task.questions = questions;
  const std::vector<double> after = lambdas_of(task, gram_with(task, world, result.plan));
  result.power = 1.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    result.pairs[k].after = after[k];
    result.pairs[k].power = power_of(questions[k], after[k]);
    if (!result.pairs[k].beyond) result.power = std::min(result.power, result.pairs[k].power);
  }
  std::vector<bool> beyond;
  for (const PlannedPair& one : result.pairs) beyond.push_back(one.beyond);
  result.worth = worth_of_instruments(task, result.plan, beyond);
  return result;
}

}  // namespace trussmap
