// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The search for missing effects (trussmap/diagnose.hpp): score tests of all candidates, then
// forward selection of what is significant, each conditioned on those before it.
//
//   test_all         members of families quickly, the best of each and all others in full
//   refine_families  shape parameters of the most promising
//   weigh_noise_and_events a law of noise or a single event that explains more comes first
//   select           best, or a formula that says it better (formula_search.hpp); conditioned on
//                    it the next, and so on
//   known causes     of the catalogue, that together explain what a free form does
//   best set         of all of up to four, where it is well ahead of what was found one by one
//   drop             backward elimination of what the others explain
//   masked           where nothing is significant: effects that are so only together
#pragma once

#include "criticism/event_tests.hpp"
#include "criticism/known_causes.hpp"
#include "criticism/local_dispersion.hpp"
#include "criticism/noise_tests.hpp"
#include "criticism/tested_candidate.hpp"
#include "validation/held_out_legs.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace trussmap::criticism {

struct SearchOptions {
  double level = kSignificance;  ///< of the first; the next have to be far more significant
  std::size_t most_missing = 4;
};

/// One effect that is missing.
struct MissingEffect {
  std::size_t tested = 0;  ///< place among all
  Score joint;             ///< with all that is missing added at once; without columns
};

/// The first law of noise, an amount and not a shape, that is beyond chance (p < 0.01), if it
/// explains more than any effect that is significant at this level; nullptr if not.
[[nodiscard]] const NoiseTest* leading_law(const std::vector<NoiseTest>& laws,
                                           const std::vector<Tested>& tested, double level);

class EffectSearch {
 public:
  /// Keeps references. `legs`, which may be nullptr: whose slopes the tests are to have.
  EffectSearch(const fitting::FitState& fit, const ScoreTest& tests, const SearchOptions& options,
               const validation::HeldOutLegs* legs);

  void run();

  /// Another in the place of one that is missing: its look-alike, which fits better.
  void exchange(std::size_t rank, std::size_t tested);

  [[nodiscard]] const std::vector<Tested>& tested() const { return tested_; }
  [[nodiscard]] const std::vector<MissingEffect>& missing() const {
    return missing_;
  }  ///< best first
  /// Projected columns of what is missing.
  [[nodiscard]] const Eigen::MatrixXd& nuisance() const { return nuisance_; }
  /// Projected columns of the events that had the better claim.
  [[nodiscard]] const Eigen::MatrixXd& events() const { return events_; }
  /// Whether what is missing is significant only together.
  [[nodiscard]] bool only_together() const { return only_together_; }
  [[nodiscard]] int tried() const { return tried_; }

 private:
  void test_all();
  void take(Tested& tested, const Candidate& candidate, Score& score);
  void refine_families();
  void refine(Tested& tested);
  void find_missing();
  void select(ScoreTest& left, const fitting::FitState& ground, std::vector<Tested>& still);
  void take_formula(const Tested& formula, std::vector<Tested>& still);
  /// Places of what is missing.
  [[nodiscard]] std::vector<std::size_t> missing_places() const;
  [[nodiscard]] SearchGround ground_of(const fitting::FitState& fit, const ScoreTest& left,
                                       double next_share) const;
  void take_known_causes(const fitting::FitState& ground, const ScoreTest& left);
  void take_best_set(const fitting::FitState& ground, const ScoreTest& left);
  void take_masked();
  void take_all(const std::vector<std::size_t>& places);
  void weigh_noise_and_events(ScoreTest& left, const fitting::FitState& ground,
                              std::vector<Tested>& still);
  [[nodiscard]] std::optional<TestedEvent> claiming_event(const fitting::FitState& ground,
                                                          const ScoreTest& left,
                                                          const std::vector<Tested>& still,
                                                          const Eigen::MatrixXd& nuisance) const;
  void estimate_jointly();
  void eliminate_backward();

  const fitting::FitState& fit_;
  const ScoreTest& tests_;
  SearchOptions options_;
  const validation::HeldOutLegs*
      legs_;  ///< nullptr: whose slopes nobody wants, or that cannot have any
  LocalDispersion dispersion_;
  int tried_ = 0;
  std::vector<Tested> tested_;
  std::vector<MissingEffect> missing_;
  Eigen::MatrixXd nuisance_;
  Eigen::MatrixXd events_;
  bool only_together_ = false;
};

}  // namespace trussmap::criticism
