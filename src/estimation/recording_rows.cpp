// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// J and M of a recording system, measurement by measurement and as factors.
#include "estimation/recording_system.hpp"
#include "parallel/parallel_for.hpp"

#include <utility>
#include <vector>

namespace trussmap::estimation {
namespace {

constexpr std::size_t kColumnsAtOnce = 8;

}  // namespace

std::vector<RecordingSystem::Link> RecordingSystem::links_of(std::size_t k) const {
  const Measurement& one = problem_.measurements[k];
  const Whitened& J = J_[k];
  std::vector<Link> links;
  for (const auto& [node, rows] : {std::pair(one.from, &J.from), std::pair(one.to, &J.to)}) {
    if (node < 0 || normal_.size(node) == 0) continue;
    links.push_back({node, rows->leftCols(normal_.size(node))});
  }
  for (std::size_t t = 0; t < J.states.size(); ++t) {
    links.push_back({state_node(problem_.noise_terms[k][t].state), J.states[t]});
  }
  return links;
}

std::vector<RecordingSystem::NodeRows> RecordingSystem::node_rows(std::size_t measurement) const {
  const int rows = problem_.measurements[measurement].rows;
  std::vector<NodeRows> result;
  for (const Link& link : links_of(measurement)) {
    result.push_back({link.node, link.J.topRows(rows)});
  }
  return result;
}

Eigen::MatrixXd RecordingSystem::transposed_times(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(normal_.unknowns(), rows.cols());
  parallel::parallel_ranges(
      idx(rows.cols()), kColumnsAtOnce, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin);
        const auto columns = static_cast<Eigen::Index>(end - begin);
        add_transposed_times(rows.middleCols(first, columns), result.middleCols(first, columns));
      });
  return result;
}

void RecordingSystem::add_transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                           Eigen::Ref<Eigen::MatrixXd> result) const {
  for (std::size_t k = 0; k < J_.size(); ++k) {
    const Measurement& one = problem_.measurements[k];
    const auto part = rows.middleRows(first_row_[k], one.rows);
    for (const auto& [node, J] : {std::pair(one.from, &J_[k].from), std::pair(one.to, &J_[k].to)}) {
      if (node < 0 || normal_.size(node) == 0) continue;
      const int size = normal_.size(node);
      result.middleRows(normal_.offset(node), size).noalias() +=
          J->topLeftCorner(one.rows, size).transpose().lazyProduct(part);
    }
    for (std::size_t t = 0; t < J_[k].states.size(); ++t) {
      const int at = normal_.offset(state_node(problem_.noise_terms[k][t].state));
      result.row(at) += J_[k].states[t].head(one.rows).transpose() * part;
    }
  }
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    const auto part = rows.row(state_row(k));
    result.row(normal_.offset(state_node(static_cast<int>(k)))) += part / state.sd;
    if (state.previous < 0) continue;
    result.row(normal_.offset(state_node(state.previous))) -= state.keep / state.sd * part;
  }
}

linalg::SparseMatrix RecordingSystem::rows_by_nodes() const {
  std::vector<Eigen::Triplet<double, int>> entries;
  for (std::size_t k = 0; k < J_.size(); ++k) {
    const int rows = problem_.measurements[k].rows;
    for (const Link& link : links_of(k)) {
      const int at = normal_.offset(link.node);
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < link.J.cols(); ++column) {
          entries.emplace_back(first_row_[k] + row, at + column, link.J(row, column));
        }
      }
    }
  }
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    const int own = normal_.offset(state_node(static_cast<int>(k)));
    entries.emplace_back(state_row(k), own, 1.0 / state.sd);
    if (state.previous < 0) continue;
    entries.emplace_back(state_row(k), normal_.offset(state_node(state.previous)),
                         -state.keep / state.sd);
  }
  linalg::SparseMatrix J(rows_, normal_.unknowns());
  J.setFromTriplets(entries.begin(), entries.end());
  return J;
}

Eigen::MatrixXd RecordingSystem::times(const Eigen::MatrixXd& nodes) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows_, nodes.cols());
  subtract_times(nodes, result);
  result = -result;
  return result;
}

void RecordingSystem::subtract_times(const Eigen::MatrixXd& nodes, Eigen::MatrixXd& rows) const {
  parallel::parallel_ranges(
      idx(rows.cols()), kColumnsAtOnce, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin);
        const auto columns = static_cast<Eigen::Index>(end - begin);
        subtract_some(nodes.middleCols(first, columns), rows.middleCols(first, columns));
      });
}

void RecordingSystem::subtract_some(const Eigen::Ref<const Eigen::MatrixXd>& nodes,
                                    Eigen::Ref<Eigen::MatrixXd> rows) const {
  for (std::size_t k = 0; k < J_.size(); ++k) {
    const Measurement& one = problem_.measurements[k];
    auto part = rows.middleRows(first_row_[k], one.rows);
    for (const auto& [node, J] : {std::pair(one.from, &J_[k].from), std::pair(one.to, &J_[k].to)}) {
      if (node < 0 || normal_.size(node) == 0) continue;
      const int size = normal_.size(node);
      part.noalias() -= J->topLeftCorner(one.rows, size)
                            .lazyProduct(nodes.middleRows(normal_.offset(node), size));
    }
    for (std::size_t t = 0; t < J_[k].states.size(); ++t) {
      const int at = normal_.offset(state_node(problem_.noise_terms[k][t].state));
      part -= J_[k].states[t].head(one.rows) * nodes.row(at);
    }
  }
  for (std::size_t k = 0; k < problem_.noise_states.size(); ++k) {
    const NoiseState& state = problem_.noise_states[k];
    auto part = rows.row(state_row(k));
    part -= nodes.row(normal_.offset(state_node(static_cast<int>(k)))) / state.sd;
    if (state.previous < 0) continue;
    part += state.keep / state.sd * nodes.row(normal_.offset(state_node(state.previous)));
  }
}

Eigen::MatrixXd RecordingSystem::free_of_nodes(Eigen::MatrixXd columns) const {
  if (columns.cols() > 0) subtract_times(solve_nodes(transposed_times(columns)), columns);
  return columns;
}

Eigen::MatrixXd RecordingSystem::transposed_rows(std::size_t measurement) const {
  const Measurement& one = problem_.measurements[measurement];
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(normal_.unknowns() + M_.cols(), one.rows);
  for (const Link& link : links_of(measurement)) {
    result.middleRows(normal_.offset(link.node), link.J.cols()) =
        link.J.topRows(one.rows).transpose();
  }
  result.bottomRows(M_.cols()) = M_.middleRows(first_row_[measurement], one.rows).transpose();
  return result;
}

}  // namespace trussmap::estimation
