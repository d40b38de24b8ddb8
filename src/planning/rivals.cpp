// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/rivals.hpp"

#include "criticism/score_test.hpp"
#include "linalg/dense.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace trussmap::planning {
namespace {

bool is_among(const Effect& effect, const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(), [&effect](const Effect& one) {
    return one.channel == effect.channel && one.shape == effect.shape;
  });
}

/// By its name in the diagnosis, else in the catalogue.
Effect effect_named(const std::string& name, const Diagnosis& diagnosis) {
  for (const Finding& one : diagnosis.findings) {
    if (one.effect.name == name) return one.effect;
    for (const LookAlike& other : one.look_alikes) {
      if (other.effect.name == name) return other.effect;
    }
  }
  return catalogue_effect(name);
}

/// The first finding that has rivals, and these: of the catalogue, if any of those is.
std::vector<Effect> open_rivals(const Diagnosis& diagnosis) {
  for (const Finding& one : diagnosis.findings) {
    if (one.joint.empty() || closest_rival(one.look_alikes) == nullptr) continue;
    std::vector<Effect> catalogued{one.effect};
    std::vector<Effect> all{one.effect};
    for (const LookAlike& other : one.look_alikes) {
      if (other.told_apart()) continue;
      all.push_back(other.effect);
      if (find_entry(other.effect.name) != nullptr) catalogued.push_back(other.effect);
    }
    return catalogued.size() > 1 ? catalogued : all;
  }
  throw std::invalid_argument(
      "the diagnosis leaves nothing open: nothing is missing that looks like something else; "
      "expected rivals to be named");
}

/// Whether what is missing is a rival by another name: most of one's trace is the other's.
bool is_another_name(const Finding& missing, const std::vector<Effect>& rivals,
                     const criticism::ScoreTest& tests) {
  constexpr double kMostly = 0.7;
  const Eigen::MatrixXd M = tests.projected(tests.columns(missing.effect));
  const Eigen::VectorXd trace =
      M * Eigen::Map<const Eigen::VectorXd>(missing.joint.data(), M.cols());
  return std::any_of(rivals.begin(), rivals.end(), [&](const Effect& rival) {
    const Eigen::MatrixXd R = tests.projected(tests.columns(rival));
    const Eigen::VectorXd own = R.rowwise().sum();
    return (R * linalg::least_squares(R, trace)).norm() >= kMostly * trace.norm() ||
           (M * linalg::least_squares(M, own)).norm() >= kMostly * own.norm();
  });
}

}  // namespace

bool speaks_of_sessions(const Effect& effect) {
  return effect.per_session ||
         std::any_of(effect.shape.begin(), effect.shape.end(),
                     [](const Shape& shape) { return shape.speaks_of("session"); });
}

void check_plan_options(const PlanOptions& options) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(options.max_speed >= 0.0, "the highest speed must be 0 m/s or more");
  require(options.most_time > 0.0, "the longest time must be above 0 s");
  require(options.most_length > 0.0, "the greatest length must be above 0 m");
  require(options.power > 0.0 && options.power < 1.0, "the power must lie between 0 and 1");
  require(options.level > 0.0 && options.level < 1.0, "the level must lie between 0 and 1");
}

RivalSubject rivals_of(const Diagnosis& diagnosis, const PlanOptions& options) {
  const fitting::FitState& fit = *diagnosis.under->fit.state;
  RivalSubject subject;
  if (options.rivals.empty()) {
    subject.rivals = open_rivals(diagnosis);
  } else {
    for (const std::string& name : options.rivals) {
      subject.rivals.push_back(effect_named(name, diagnosis));
    }
    if (subject.rivals.size() < 2) {
      throw std::invalid_argument("one rival is named, expected two or more");
    }
  }
  std::erase_if(subject.rivals, speaks_of_sessions);
  for (const Effect& one : subject.rivals) {
    if (is_among(one, fit.model.effects)) {
      throw std::invalid_argument("the model has " + one.name +
                                  " already, expected rivals that it has not");
    }
  }
  for (const Effect& one : fit.model.effects) {
    (speaks_of_sessions(one) ? subject.own : subject.beside).push_back(one);
  }
  criticism::ScoreTest tests(fit);
  for (const Finding& one : diagnosis.findings) {
    if (one.joint.empty() || is_among(one.effect, subject.rivals)) continue;
    if (is_another_name(one, subject.rivals, tests)) continue;
    (speaks_of_sessions(one.effect) ? subject.own : subject.beside).push_back(one.effect);
    tests.condition_on(tests.columns(one.effect));
  }
  double most = 0.0;
  const std::vector<criticism::Score> scores = tests.test(subject.rivals);
  for (std::size_t k = 0; k < scores.size(); ++k) {
    if (scores[k].dof == 0) {
      throw std::invalid_argument(
          "the recordings show nothing of " + subject.rivals[k].name +
          ", so that it is not known how large it would be; expected rivals that they show");
    }
    subject.rivals[k].coefficients = scores[k].coefficients;
    subject.scores.push_back(scores[k].score);
    most = std::max(most, scores[k].score);
  }
  constexpr double kKnown = 3.0;  // score: below, sizes near 0 are as likely
  const double left = tests.residuals().squaredNorm() - most;
  subject.phi = std::max(1.0, left / std::max(1, fit.adjustment.dof));
  for (std::size_t k = 0; k < subject.scores.size(); ++k) {
    if (subject.scores[k] >= kKnown * subject.phi) continue;
    throw std::invalid_argument("the recordings hardly show " + subject.rivals[k].name +
                                ", so that its size is not known; expected rivals that they show");
  }
  return subject;
}

/// Columns of each effect, one after the other.
std::vector<std::vector<Eigen::Index>> columns_of(const std::vector<Effect>& effects) {
  std::vector<std::vector<Eigen::Index>> columns;
  Eigen::Index next = 0;
  for (const Effect& one : effects) {
    columns.emplace_back();
    for (std::size_t k = 0; k < one.shape.size(); ++k) columns.back().push_back(next++);
  }
  return columns;
}

std::vector<std::string> variables_in(const std::vector<Effect>& effects) {
  std::set<std::string> all;
  for (const Effect& one : effects) {
    for (const Shape& shape : one.shape) {
      all.insert(shape.variables().begin(), shape.variables().end());
    }
  }
  return {all.begin(), all.end()};
}

}  // namespace trussmap::planning
