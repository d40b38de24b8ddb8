// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/remaining_errors.hpp"

#include "criticism/event_tests.hpp"
#include "criticism/noise_tests.hpp"
#include "criticism/refits.hpp"
#include "fit/fit_state.hpp"
#include "linalg/dense.hpp"

#include <iterator>
#include <utility>

namespace trussmap::criticism {
namespace {

/// A fit, and columns beside it that are taken as given.
struct Asked {
  ModelFit fit;
  std::vector<Effect> beside;

  [[nodiscard]] Eigen::MatrixXd nuisance(const ScoreTest& tests) const {
    Eigen::MatrixXd columns(tests.system().rows(), 0);
    for (const Score& one : tests.test(beside)) linalg::append_columns(columns, one.projected);
    return columns;
  }
};

std::vector<NoiseTest> laws_of(const Asked& asked) {
  const ScoreTest tests(*asked.fit.state);
  return test_noise_laws(*asked.fit.state, tests, asked.nuisance(tests));
}

Asked with_noise_as(const std::vector<DrivenRecording>& recordings, const Noise& stated,
                    Asked asked) {
  asked.fit = refit_under(recordings, asked.fit, stated);
  return asked;
}

}  // namespace

RemainingErrors remaining_errors(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit, const std::optional<ModelFit>& with,
                                 const ScoreTest& about, const Noise& stated,
                                 const std::vector<Effect>& missing) {
  RemainingErrors result;
  const Asked asked = with ? Asked{*with, {}} : Asked{fit, missing};
  result.fitted = asked.beside.empty();
  result.left_out = asked.fit.left_out.size();
  result.p_value = asked.fit.p_value;
  const Eigen::MatrixXd nuisance = asked.nuisance(about);
  std::vector<TestedEvent> events = test_events(*asked.fit.state, about, nuisance);
  result.events.assign(std::make_move_iterator(events.begin()),
                       std::make_move_iterator(events.end()));
  result.noise = asked.fit.model.noise == stated
                     ? test_noise_laws(*asked.fit.state, about, nuisance)
                     : laws_of(with_noise_as(recordings, stated, asked));
  return result;
}

std::vector<NoiseTest> noise_beyond(const std::vector<DrivenRecording>& recordings,
                                    const ModelFit& fit, const Noise& stated) {
  return laws_of(with_noise_as(recordings, stated, {fit, {}}));
}

}  // namespace trussmap::criticism
