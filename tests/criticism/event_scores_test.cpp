// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A single event's score with and without a prior, against what the algebra makes of one another.
#include "criticism/event_scores.hpp"

#include "criticism/noisy_recordings.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::event_scores_test {
using namespace criticism;
namespace {

class EventScores : public ::testing::Test {
 protected:
  [[nodiscard]] Found scored(const SingleEvent& event) const {
    return score_events(fit_, tests_.system(), projection_, {event}).front().places.front();
  }

  /// With one dummy and without a prior: one that touches several measurements (`wide`) or one.
  [[nodiscard]] SingleEvent event_of_one(bool wide) const {
    for (const SingleEvent& one : single_events(fit_, tests_, projection_)) {
      SingleEvent event{one.kind, one.name, {one.places.front()}};
      if ((event.places.front().parts.size() > 1) != wide) continue;
      event.places.front().prior_sd = {};
      for (DummyRows& part : event.places.front().parts) part.rows = part.rows.leftCols(1).eval();
      const Found found = scored(event);
      if (found.dof == 1 && found.score > 0.5) return event;
    }
    return {};
  }

  testing::NoisyDrive world_ = testing::simulate_world({true, true, false, 1, 2}, 4);
  fitting::FitState fit_ = fitting::fit_recordings(world_.recordings, world_.model);
  ScoreTest tests_{fit_};
  fitting::FitProjection projection_{fit_, fit_.problem, tests_.system(),
                                     Eigen::MatrixXd(tests_.system().rows(), 0)};
};

/// g^2/S becomes g^2/(S + phi/prior^2), the size -g/S likewise.
TEST_F(EventScores, APriorPullsTheSizeAndTakesItsShareOfTheScore) {
  const double phi = std::max(1.0, fit_.adjustment.chi2 / fit_.adjustment.dof);
  for (const bool wide : {false, true}) {
    SingleEvent event = event_of_one(wide);
    ASSERT_FALSE(event.places.empty()) << wide;
    const Found free = scored(event);
    const double S = free.score / (free.size[0] * free.size[0]);
    // The widest prior that counts is three standard errors; wide ones change nothing.
    for (const double errors : {3.01, 6.0, 1e6}) {
      const double prior = errors * std::sqrt(phi / S);
      event.places.front().prior_sd = Eigen::VectorXd::Constant(1, prior);
      const Found pulled = scored(event);
      const double share = S / (S + phi / (prior * prior));
      EXPECT_EQ(pulled.dof, 1) << wide << ' ' << errors;
      EXPECT_NEAR(pulled.score, share * free.score, 1e-9 * free.score) << wide << ' ' << errors;
      EXPECT_NEAR(pulled.size[0], share * free.size[0], 1e-9 * std::abs(free.size[0]));
    }
    event.places.front().prior_sd = Eigen::VectorXd::Constant(1, 2.99 * std::sqrt(phi / S));
    EXPECT_EQ(scored(event).dof, 0) << wide;
  }
}

}  // namespace
}  // namespace trussmap::event_scores_test
