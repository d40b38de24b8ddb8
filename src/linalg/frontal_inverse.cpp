// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The inverse where L has entries, from the root of the front tree down.
#include "geometry/index.hpp"
#include "linalg/front_kernels.hpp"
#include "linalg/frontal_cholesky.hpp"

#include <algorithm>
#include <stdexcept>

namespace trussmap::linalg {

template <typename Visit>
void FrontalCholesky::descend(const Visit& visit) const {
  // The inverses of a front and all above it, one after the other.
  std::vector<std::size_t> begin(parts_.size() + 1, 0);
  std::size_t most = 0;
  for (std::size_t f = parts_.size(); f-- > 0;) {
    const Part& front = parts_[f];
    if (front.parent >= 0) {
      const std::size_t above = idx(front.parent);
      begin[f] = begin[above] + area(parts_[above].rows, parts_[above].rows);
    }
    most = std::max(most, begin[f] + area(front.rows, front.rows));
  }
  const LargeArray path = large_array(most);
  std::size_t widest = 16;
  for (const Part& front : parts_) widest = std::max(widest, area(front.rows, front.width));
  const auto panel = std::make_unique_for_overwrite<double[]>(widest);
  const auto space = std::make_unique_for_overwrite<double[]>(widest);
  for (std::size_t f = parts_.size(); f-- > 0;) {
    const Part& front = parts_[f];
    double* inverse = path.get() + begin[f];
    if (front.parent >= 0) {
      const Part& above = parts_[idx(front.parent)];
      copy_rows(front, path.get() + begin[idx(front.parent)], above.rows, inverse);
    }
    std::copy_n(panels_.get() + front.panel, area(front.rows, front.width), panel.get());
    invert_front(panel.get(), front.rows, front.width, inverse, space.get());
    visit(f, inverse);
  }
}

Eigen::MatrixXd FrontalCholesky::inverse_blocks() const {
  int largest = 0;
  for (std::size_t k = 0; k + 1 < node_begin_.size(); ++k) {
    largest = std::max(largest, node_begin_[k + 1] - node_begin_[k]);
  }
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(largest, node_begin_.back());
  std::size_t node = node_begin_.size() - 1;
  descend([&](std::size_t f, const double* inverse) {
    const Part& front = parts_[f];
    while (node > 0 && node_begin_[node - 1] >= front.unknown) {
      --node;
      const int first = node_begin_[node];
      const int size = node_begin_[node + 1] - first;
      for (int c = 0; c < size; ++c) {
        const int column = first - front.unknown;
        const double* from = inverse + at(column, column + c, front.rows);
        std::copy_n(from, size, blocks.col(first + c).data());
      }
    }
  });
  return blocks;
}

FrontalInverse FrontalCholesky::inverse() const {
  return FrontalInverse(*this);
}

/// The part of the parent's inverse that belongs to the front's remaining rows.
void FrontalCholesky::copy_rows(const Part& front, const double* parent, int above,
                                double* inverse) const {
  const Run* const begin = runs_.data() + front.runs_begin;
  const Run* const end = runs_.data() + front.runs_end;
  for (const Run* columns = begin; columns != end; ++columns) {
    for (int k = 0; k < columns->length; ++k) {
      const double* from = parent + at(0, columns->to + k, above);
      double* to = inverse + at(front.width, front.width + columns->from + k, front.rows);
      for (const Run* rows = begin; rows != end; ++rows) {
        for (int r = 0; r < rows->length; ++r) to[rows->from + r] = from[rows->to + r];
      }
    }
  }
}

FrontalInverse::FrontalInverse(const FrontalCholesky& factor)
    : factor_(factor), entries_(large_array(factor.stored_)) {
  factor.descend([&](std::size_t f, const double* inverse) {
    const FrontalCholesky::Part& front = factor.parts_[f];
    std::copy_n(inverse, area(front.rows, front.width), entries_.get() + front.panel);
  });
}

Eigen::MatrixXd FrontalInverse::block(int row, int rows, int column, int columns) const {
  if (row < column) return block(column, columns, row, rows).transpose();
  const FrontalCholesky::Part& front = factor_.parts_[factor_.front_of(column)];
  int place = row - front.unknown;
  if (place >= front.width) {
    const auto begin = factor_.scalars_.begin() + front.scalars_begin;
    const auto end = begin + front.height();
    const auto found = std::lower_bound(begin, end, row);
    if (found == end || *found != row) throw std::out_of_range("nodes that nothing couples");
    place = front.width + static_cast<int>(found - begin);
  }
  const double* entries = entries_.get() + front.panel;
  Eigen::MatrixXd result(rows, columns);
  for (int c = 0; c < columns; ++c) {
    const double* from = entries + at(place, column - front.unknown + c, front.rows);
    std::copy_n(from, rows, result.col(c).data());
  }
  return result;
}

}  // namespace trussmap::linalg
