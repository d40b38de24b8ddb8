// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_system.hpp"

#include <utility>

namespace trussmap::estimation {

void RecordingSystem::add_block(int node, const Eigen::MatrixXd& block) {
  if (block.rows() == 1) normal_.add_diagonal<1>(node, block);
  if (block.rows() == 2) normal_.add_diagonal<2>(node, block);
  if (block.rows() == 3) normal_.add_diagonal<3>(node, block);
}

void RecordingSystem::add_block_between(int pair, const Eigen::MatrixXd& block) {
  const auto is = [&](Eigen::Index rows, Eigen::Index columns) {
    return block.rows() == rows && block.cols() == columns;
  };
  if (is(3, 3)) normal_.add_coupling<3, 3>(pair, block);
  if (is(3, 2)) normal_.add_coupling<3, 2>(pair, block);
  if (is(3, 1)) normal_.add_coupling<3, 1>(pair, block);
  if (is(2, 1)) normal_.add_coupling<2, 1>(pair, block);
  if (is(1, 1)) normal_.add_coupling<1, 1>(pair, block);
}

void RecordingSystem::add_curvature(std::size_t measurement, const Eigen::MatrixXd& curvature) {
  const Measurement& one = problem_.measurements[measurement];
  const std::vector<Link> links = links_of(measurement);
  std::vector<Eigen::Index> at;
  Eigen::Index next = 0;
  for (const Link& link : links) {
    at.push_back(next);
    next += link.J.cols();
  }
  const auto block = [&](std::size_t a, std::size_t b) -> Eigen::MatrixXd {
    return curvature.block(at[a], at[b], links[a].J.cols(), links[b].J.cols());
  };
  // Links are the free ones of from and to, then the states; pairs are of all of them.
  const std::size_t terms = J_[measurement].states.size();
  const std::size_t ends = links.size() - terms;
  for (std::size_t a = 0; a < links.size(); ++a) add_block(links[a].node, block(a, a));
  if (ends == 2) add_block_between(pair_[measurement], block(0, 1));
  if (terms == 0) return;
  int pair = state_pair_[measurement];
  for (std::size_t t = 0; t < terms; ++t) {
    std::size_t end = 0;
    for (const int node : {one.from, one.to}) {
      if (node < 0) continue;
      if (normal_.size(node) > 0) add_block_between(pair, block(end++, ends + t));
      ++pair;
    }
    for (std::size_t other = 0; other < t; ++other) {
      add_block_between(pair++, block(ends + other, ends + t));
    }
  }
}

}  // namespace trussmap::estimation
