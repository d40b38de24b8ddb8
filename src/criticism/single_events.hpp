// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What may have happened once, as dummy columns on the whitened rows of a few measurements.
#pragma once

#include "criticism/score_test.hpp"
#include "fit/fit_projection.hpp"
#include "trussmap/diagnose.hpp"

#include <string>
#include <vector>

namespace trussmap::criticism {

struct DummyRows {
  std::size_t measurement = 0;
  Eigen::MatrixXd rows;  ///< its rows x dummies, whitened
};

/// One place where an event may have been.
struct Dummies {
  std::vector<DummyRows> parts;
  Eigen::VectorXd prior_sd = {};  ///< sd of a prior on each coefficient; empty: none
  int group = 0;                  ///< of an event's places that may be much the same
  EventChange change = EventChange::motion;
  MovedWhen when = {};
};

struct SingleEvent {
  EventKind kind = EventKind::leg;
  std::string name;
  std::vector<Dummies> places;
};

/// All that there could be, but for measurements that the fit leaves out.
[[nodiscard]] std::vector<SingleEvent> single_events(const fitting::FitState& fit,
                                                     const ScoreTest& tests,
                                                     const fitting::FitProjection& projection);

}  // namespace trussmap::criticism
