// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/block_system.hpp"

#include "linalg/selected_inverse.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace trussmap::linalg {

Elimination plan_elimination(int nodes, const std::vector<NodePair>& pairs) {
  if (nodes == 0) return {};
  std::vector<int> place(idx(nodes));
  for (int k = 0; k < nodes; ++k) place[idx(k)] = k;
  const BlockPattern pattern = pattern_of(pairs, place, nodes);
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
  return {cholesky.order(), cholesky.multiplications()};
}

std::vector<int> elimination_order(int nodes, const std::vector<NodePair>& pairs) {
  return plan_elimination(nodes, pairs).order;
}

BlockSystem::BlockSystem(const std::vector<int>& sizes, const std::vector<NodePair>& pairs,
                         const std::vector<int>& order, Kernel kernel)
    : kernel_(kernel) {
  if (order.size() != sizes.size()) {
    throw std::invalid_argument("an order of all nodes is needed");
  }
  std::vector<int> free_nodes;
  std::vector<int> free_sizes;
  for (const int node : order) {
    const int size = sizes[idx(node)];
    if (size < 0 || size > kLargestBlock) throw std::invalid_argument("a block of 0 to 4 unknowns");
    if (size == 0) continue;
    free_nodes.push_back(node);
    free_sizes.push_back(size);
  }
  const auto places = [&] {
    std::vector<int> place(sizes.size(), -1);
    for (std::size_t k = 0; k < free_nodes.size(); ++k)
      place[idx(free_nodes[k])] = static_cast<int>(k);
    return place;
  };
  std::vector<int> place = places();
  BlockPattern pattern = pattern_of(pairs, place, static_cast<int>(free_nodes.size()));
  if (kernel_ == Kernel::frontal) {
    FrontTree tree = plan_fronts(pattern, free_sizes);
    std::vector<int> front_by_front;
    for (const int k : tree.order) front_by_front.push_back(free_nodes[idx(k)]);
    free_nodes = std::move(front_by_front);
    place = places();
    pattern = pattern_of(pairs, place, pattern.nodes());
    for (std::size_t k = 0; k < free_nodes.size(); ++k) free_sizes[k] = sizes[idx(free_nodes[k])];
    frontal_ = FrontalCholesky(tree, free_sizes);
  }
  nodes_.resize(sizes.size());
  for (const int node : free_nodes) {
    nodes_[idx(node)].size = sizes[idx(node)];
    nodes_[idx(node)].offset = unknowns_;
    unknowns_ += sizes[idx(node)];
  }
  lay_out(pattern, pairs, free_nodes, place);
  clear();
}

void BlockSystem::lay_out(const BlockPattern& pattern, const std::vector<NodePair>& pairs,
                          const std::vector<int>& order, const std::vector<int>& place) {
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

void BlockSystem::factorise() {
  if (kernel_ == Kernel::frontal) {
    frontal_.factorise(matrix_);
  } else {
    if (!analysed_) cholmod_.analyse(matrix_);
    analysed_ = true;
    cholmod_.factorise(matrix_);
  }
}

void BlockSystem::solve_in_place(Eigen::VectorXd& x) {
  if (kernel_ == Kernel::frontal) {
    frontal_.solve_in_place(x);
  } else {
    cholmod_.solve_in_place(x);
  }
}

Eigen::MatrixXd BlockSystem::solve(const Eigen::MatrixXd& b) const {
  if (kernel_ == Kernel::cholmod) return cholmod_.solve(b);
  Eigen::MatrixXd x = b;
  if (x.cols() == 1) {
    frontal_.solve_in_place(x.col(0));
  } else {
    frontal_.solve_columns(x);
  }
  return x;
}

FrontalInverse BlockSystem::inverse() const {
  if (kernel_ != Kernel::frontal) throw std::logic_error("CHOLMOD's factor keeps no fronts");
  return frontal_.inverse();
}

Eigen::MatrixXd BlockSystem::inverse_products(const std::vector<Eigen::Triplet<double>>& b,
                                              int columns) const {
  if (kernel_ == Kernel::frontal) return frontal_.inverse_products(b, columns);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(unknowns_, columns);
  for (const Eigen::Triplet<double>& one : b) B(one.row(), one.col()) += one.value();
  return B.transpose() * cholmod_.solve(B);
}

Eigen::MatrixXd BlockSystem::inverse_blocks() const {
  if (kernel_ == Kernel::frontal) return frontal_.inverse_blocks();
  const SelectedInverse inverse(matrix_);
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(kLargestBlock, unknowns_);
  for (const Node& node : nodes_) {
    if (node.size == 0) continue;
    blocks.block(0, node.offset, node.size, node.size) =
        inverse.block(node.offset, node.size, node.offset, node.size);
  }
  return blocks;
}

double BlockSystem::log_determinant() const {
  return kernel_ == Kernel::frontal ? frontal_.log_determinant() : cholmod_.log_determinant();
}

double BlockSystem::reciprocal_condition() const {
  return kernel_ == Kernel::frontal ? frontal_.reciprocal_condition()
                                    : cholmod_.reciprocal_condition();
}

double BlockSystem::least_pivot_share() const {
  return kernel_ == Kernel::frontal ? frontal_.least_pivot_share(diagonal())
                                    : cholmod_.least_pivot_share(diagonal());
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

}  // namespace trussmap::linalg
