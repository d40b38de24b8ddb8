// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/drive_for_questions.hpp"
#include "planning/recorded_world.hpp"
#include "planning/rivals.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace planning;

namespace {

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
      kToldApart,
      statistics::chi2_quantile(1.0 - options.level, static_cast<double>(one.columns.size())));
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

SearchTask task_of(const fitting::FitState& fit, const RivalSubject& subject,
                   const PlanWorld& world, const PlanOptions& options) {
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

/// Pairs as the recordings leave them.
std::vector<PlannedPair> pairs_before(const RivalSubject& subject, const AskedPairs& asked,
                                      const std::vector<double>& before,
                                      const std::vector<bool>& beyond) {
  std::vector<PlannedPair> pairs;
  for (std::size_t k = 0; k < asked.pairs.size(); ++k) {
    PlannedPair pair{subject.rivals[asked.pairs[k].truth], subject.rivals[asked.pairs[k].rival]};
    pair.before = pair.after = before[k];
    pair.power_before = pair.power = power_of(asked.questions[k], before[k]);
    pair.beyond = beyond[k];
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
  const fitting::FitState& fit = *diagnosis.under->fit.state;
  const RivalSubject subject = rivals_of(diagnosis, options);
  const PlanWorld world =
      recorded_world(fit, variables_in(subject.rivals), options.start, options.max_speed);
  SearchTask task = task_of(fit, subject, world, options);
  const AskedPairs asked = ask_pairs(subject, columns_of(task.effects), options);
  task.questions = asked.questions;
  const std::vector<double> before = lambdas_of(task, gram_before(task));
  const std::vector<bool> beyond = beyond_drives(task, before);
  PlannedDrive result;
  result.options = options;
  result.pairs = pairs_before(subject, asked, before, beyond);
  if (std::find(beyond.begin(), beyond.end(), false) == beyond.end()) return result;
  const std::vector<double> after = drive_for(task, beyond, result);
  result.power = 1.0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    PlannedPair& pair = result.pairs[k];
    pair.after = after[k];
    pair.power = power_of(asked.questions[k], after[k]);
    if (!pair.beyond) result.power = std::min(result.power, pair.power);
  }
  return result;
}

}  // namespace trussmap
