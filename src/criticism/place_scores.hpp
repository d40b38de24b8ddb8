// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the driving near each place says of a channel, without fitting anew.
//
//   grid     nodes `cell` apart over the floor; those that the robot came near are kept
//   B        the channel's whitened column, a column per node: each row of driving is shared out
//            among the four nodes about it, bilinearly, so that a field is linear between nodes
//   G, s     B_'B_, B_'r of all channels at once (score_test.hpp); the field's values at the nodes
//            are u ~ N(-G^- s, phi G^-)
#pragma once

#include "criticism/matern_field.hpp"
#include "criticism/score_test.hpp"

#include <optional>
#include <vector>

namespace trussmap::criticism {

struct PlaceScores {
  SquareGrid grid;
  std::vector<GridNode> nodes;    ///< that the robot came near
  std::vector<bool> visited;      ///< of each: whether it was within the square about it
  Eigen::VectorXd driven;         ///< share of the way near each of them; their sum is 1
  std::vector<Channel> channels;  ///< cut by place
  std::vector<Effect> patches;    ///< what has columns of its own, after those of the channels
  Eigen::MatrixXd G;              ///< all nodes of the first channel, of the next, ...; patches
  Eigen::VectorXd s;
  double chi2 = 0.0;
  int dof = 0;

  [[nodiscard]] Eigen::Index count() const { return driven.size(); }
};

/// Of travel, turn, creep and compass, as far as these recordings can show them; nothing where the
/// robot hardly left its place. `tests`: of this fit, perhaps conditioned on what else there is.
[[nodiscard]] std::optional<PlaceScores> place_scores(const fitting::FitState& fit,
                                                      const ScoreTest& tests,
                                                      const std::vector<Effect>& patches);

}  // namespace trussmap::criticism
