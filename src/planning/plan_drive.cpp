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
#include <stdexcept>
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

/// What is asked of a drive, of all ordered pairs of rivals.
struct AskedPairs {
  std::vector<Pair> pairs;
  std::vector<Question> questions;
};

AskedPairs ask_pairs(const RivalSubject& subject,
                     const std::vector<std::vector<Eigen::Index>>& columns,
                     const PlanOptions& options) {
  AskedPairs asked;
  for (std::size_t truth = 0; truth < subject.rivals.size(); ++truth) {
    for (std::size_t rival = 0; rival < subject.rivals.size(); ++rival) {
      if (rival == truth) continue;
      asked.pairs.push_back({truth, rival});
      asked.questions.push_back(question_of(asked.pairs.back(), subject, columns, options));
    }
  }
  return asked;
}

SearchTask task_of(const FitState& fit, const RivalSubject& subject, const PlanWorld& world,
                   const PlanOptions& options) {
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
  return task;
}

/// Pairs as the recordings leave them, and which of them a thorough tour does not tell.
std::vector<PlannedPair> pairs_before(const RivalSubject& subject, const AskedPairs& asked,
                                      const SearchTask& task) {
  const std::vector<double> before = lambdas_of(task, gram_before(task));
  const std::vector<double> thorough =
      lambdas_of(task, gram_with(task, task.world, plan_of(task.world, thorough_tour(task.world))));
  std::vector<PlannedPair> pairs;
  for (std::size_t k = 0; k < asked.pairs.size(); ++k) {
    const Question& question = asked.questions[k];
    PlannedPair pair{subject.rivals[asked.pairs[k].truth], subject.rivals[asked.pairs[k].rival]};
    pair.before = pair.after = before[k];
    pair.power_before = pair.power = power_of(question, before[k]);
    pair.beyond = thorough[k] - before[k] < kBeyond * (question.wanted - before[k]);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

PlannedDrive plan_drive(const Diagnosis& diagnosis, const PlanOptions& options) {
  check_plan_options(options);
  if (!diagnosis.under) {
    throw std::invalid_argument("a drive is planned for a diagnosis that estimated noise");
  }
  const FitState& fit = *diagnosis.under->fit.state;
  const RivalSubject subject = rivals_of(diagnosis, options);
  const PlanWorld world =
      recorded_world(fit, variables_in(subject.rivals), options.start, options.max_speed);
  SearchTask task = task_of(fit, subject, world, options);
  const AskedPairs asked = ask_pairs(subject, columns_of(task.effects), options);
  task.questions = asked.questions;
  PlannedDrive result;
  result.options = options;
  result.pairs = pairs_before(subject, asked, task);
  std::vector<bool> beyond;
  task.questions.clear();
  for (std::size_t k = 0; k < result.pairs.size(); ++k) {
    beyond.push_back(result.pairs[k].beyond);
    if (!beyond[k]) task.questions.push_back(asked.questions[k]);
  }
  if (task.questions.empty()) return result;
  const FoundTour found = search_tour(task);
  result.enough = found.value.least >= 1.0;
  task.questions = asked.questions;
  if (!found.tour.legs.empty()) {
    result.plan = plan_of(world, found.tour);
    result.length = found.value.length;
    result.duration = found.value.time;
    const std::vector<double> after = lambdas_of(task, gram_with(task, world, result.plan));
    for (std::size_t k = 0; k < after.size(); ++k) {
      result.pairs[k].after = after[k];
      result.pairs[k].power = power_of(asked.questions[k], after[k]);
    }
    result.worth = worth_of_instruments(task, result.plan, beyond);
  }
  result.power = 1.0;
  for (const PlannedPair& one : result.pairs) {
    if (!one.beyond) result.power = std::min(result.power, one.power);
  }
  return result;
}

}  // namespace trussmap
