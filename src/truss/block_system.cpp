// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/truss/block_system.hpp"

#include <algorithm>
#include <stdexcept>

namespace trussmap {
namespace {

/// For each node, in elimination order, the later nodes it is paired with, sorted, each once.
struct Pattern {
  std::vector<int> begin;  ///< per place, and one past the end
  std::vector<int> later;  ///< places in the order
};

Pattern pattern_of(const std::vector<NodePair>& pairs, const std::vector<int>& place, int nodes) {
  std::vector<int> begin(idx(nodes) + 1, 0);
  const auto earlier = [&](const NodePair& pair) {
    return std::min(place[idx(pair[0])], place[idx(pair[1])]);
  };
  const auto is_coupling = [&](const NodePair& pair) {
    return place[idx(pair[0])] >= 0 && place[idx(pair[1])] >= 0 && pair[0] != pair[1];
  };
  for (const NodePair& pair : pairs) {
    if (is_coupling(pair)) ++begin[idx(earlier(pair)) + 1];
  }
  for (std::size_t k = 0; k < idx(nodes); ++k) begin[k + 1] += begin[k];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  std::vector<int> later(idx(begin.back()));
  for (const NodePair& pair : pairs) {
    if (!is_coupling(pair)) continue;
    const int later_place = std::max(place[idx(pair[0])], place[idx(pair[1])]);
    later[idx(next[idx(earlier(pair))]++)] = later_place;
  }
  Pattern result;
  result.begin.push_back(0);
  for (std::size_t k = 0; k < idx(nodes); ++k) {
    const auto first = later.begin() + begin[k];
    const auto last = later.begin() + begin[k + 1];
    std::sort(first, last);
    result.later.insert(result.later.end(), first, std::unique(first, last));
    result.begin.push_back(static_cast<int>(result.later.size()));
  }
  return result;
}

}  // namespace

std::vector<int> elimination_order(int nodes, const std::vector<NodePair>& pairs) {
  if (nodes == 0) return {};
  std::vector<int> place(idx(nodes));
  for (int k = 0; k < nodes; ++k) place[idx(k)] = k;
  const Pattern pattern = pattern_of(pairs, place, nodes);
  SparseMatrix lower(nodes, nodes);
  lower.resizeNonZeros(nodes + static_cast<Eigen::Index>(pattern.later.size()));
  int at = 0;
  for (int k = 0; k < nodes; ++k) {
    lower.outerIndexPtr()[k] = at;
    lower.innerIndexPtr()[at++] = k;
    for (int q = pattern.begin[idx(k)]; q < pattern.begin[idx(k) + 1]; ++q) {
      lower.innerIndexPtr()[at++] = pattern.later[idx(q)];
    }
  }
  lower.outerIndexPtr()[nodes] = at;
  std::fill_n(lower.valuePtr(), at, 0.0);
  SparseCholesky cholesky(Ordering::amd);
  cholesky.analyse(lower);
  return cholesky.order();
}

BlockSystem::BlockSystem(const std::vector<int>& sizes, const std::vector<NodePair>& pairs,
                         const std::vector<int>& order) {
  if (order.size() != sizes.size()) {
    throw std::invalid_argument("an order of all nodes is needed");
  }
  nodes_.resize(sizes.size());
  std::vector<int> free_nodes;
  for (const int node : order) {
    const int size = sizes[idx(node)];
    if (size < 0 || size > kLargestBlock) throw std::invalid_argument("a block of 0 to 4 unknowns");
    nodes_[idx(node)].size = size;
    nodes_[idx(node)].offset = unknowns_;
    unknowns_ += size;
    if (size > 0) free_nodes.push_back(node);
  }
  lay_out(pairs, free_nodes);
  clear();
  if (unknowns_ > 0) cholesky_.analyse(matrix_);
}

void BlockSystem::lay_out(const std::vector<NodePair>& pairs, const std::vector<int>& order) {
  std::vector<int> place(nodes_.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) place[idx(order[k])] = static_cast<int>(k);
  const Pattern pattern = pattern_of(pairs, place, static_cast<int>(order.size()));

  // Heights of the blocks below each diagonal one, and where each of them begins.
  std::vector<int> row(pattern.later.size());
  std::vector<int> height(order.size(), 0);
  Eigen::Index nonzeros = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (std::size_t q = idx(pattern.begin[k]); q < idx(pattern.begin[k + 1]); ++q) {
      row[q] = height[k];
      height[k] += nodes_[idx(order[idx(pattern.later[q])])].size;
    }
    const int size = nodes_[idx(order[k])].size;
    nonzeros += size * height[k] + size * (size + 1) / 2;
  }

  matrix_.resize(unknowns_, unknowns_);
  matrix_.resizeNonZeros(nonzeros);
  diagonal_.clear();
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  int at = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    Node& node = nodes_[idx(order[k])];
    for (int c = 0; c < node.size; ++c) {
      node.column[idx(c)] = at;
      outer[node.offset + c] = at;
      diagonal_.push_back(at);
      for (int r = c; r < node.size; ++r) inner[at++] = node.offset + r;
      for (std::size_t q = idx(pattern.begin[k]); q < idx(pattern.begin[k + 1]); ++q) {
        const Node& below = nodes_[idx(order[idx(pattern.later[q])])];
        for (int r = 0; r < below.size; ++r) inner[at++] = below.offset + r;
      }
    }
  }
  outer[unknowns_] = at;

  couplings_.reserve(pairs.size());
  for (const NodePair& pair : pairs) {
    Coupling coupling;
    const int first = place[idx(pair[0])];
    const int second = place[idx(pair[1])];
    if (first >= 0 && second >= 0 && first != second) {
      const std::size_t k = idx(std::min(first, second));
      const auto begin = pattern.later.begin() + pattern.begin[k];
      const auto end = pattern.later.begin() + pattern.begin[k + 1];
      const auto found = std::lower_bound(begin, end, std::max(first, second));
      coupling.node = order[k];
      coupling.row = row[idx(found - pattern.later.begin())];
      coupling.transposed = first < second;
    }
    couplings_.push_back(coupling);
  }
}

void BlockSystem::clear() {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
}

Eigen::VectorXd BlockSystem::diagonal() const {
  Eigen::VectorXd result(unknowns_);
  for (int k = 0; k < unknowns_; ++k) result[k] = matrix_.valuePtr()[diagonal_[idx(k)]];
  return result;
}

void BlockSystem::set_diagonal(const Eigen::VectorXd& values) {
  for (int k = 0; k < unknowns_; ++k) matrix_.valuePtr()[diagonal_[idx(k)]] = values[k];
}

}  // namespace trussmap
