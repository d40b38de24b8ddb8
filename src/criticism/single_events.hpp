// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What may have happened once, as dummy columns on the whitened rows of a few measurements.
#pragma once

#include "criticism/score_test.hpp"
#include "fit/fit_projection.hpp"

#include <functional>
#include <string>
#include <vector>

namespace trussmap {

struct DummyRows {
  std::size_t measurement = 0;
  Eigen::MatrixXd rows;  ///< its rows x dummies, whitened
};

/// One place where an event may have been.
struct Dummies {
  std::vector<DummyRows> parts;
  Eigen::VectorXd prior_sd = {};  ///< sd of a prior on each coefficient; empty: none
  int group = 0;                  ///< of an event's places that may be much the same
};

struct SingleEvent {
  std::string kind;
  std::string name;
  std::vector<Dummies> places;
  std::function<std::string(std::size_t place, const Eigen::VectorXd& size)> words;
};

/// All that there could be, but for measurements that the fit leaves out.
[[nodiscard]] std::vector<SingleEvent> single_events(const ModelFit& fit, const ScoreTest& tests,
                                                     const FitProjection& projection);

}  // namespace trussmap
