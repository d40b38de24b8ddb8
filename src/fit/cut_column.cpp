// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/column_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace trussmap::fitting {
namespace {

/// What a segment has of each column that it has anything of.
struct SegmentSums {
  std::vector<int> columns;
  std::vector<estimation::Vector4> sums;

  void add(int column, const estimation::Vector4& value) {
    // Rows follow each other: their columns are the latest.
    const auto found = std::find(columns.rbegin(), columns.rend(), column);
    if (found == columns.rend()) {
      columns.push_back(column);
      sums.emplace_back(value);
    } else {
      sums[static_cast<std::size_t>(columns.rend() - found) - 1] += value;
    }
  }
};

}  // namespace

linalg::SparseMatrix ColumnBuilder::cut_column(Channel channel,
                                               const std::vector<std::vector<RowShares>>& shares,
                                               int count) const {
  assert(joint_ == 0.0 && "seconds at a time have no shares of their own");
  std::vector<Eigen::Triplet<double, int>> entries;
  std::vector<double> units;
  for (const Segment& segment : segments_) {
    units.resize(4 * (segment.end - segment.begin));
    const std::pair<Channel, double*> wanted(channel, units.data());
    work_out(segment, std::span(&wanted, 1));
    SegmentSums sums;
    for (std::size_t k = segment.begin; k < segment.end; ++k) {
      const Eigen::Map<const estimation::Vector4> unit(units.data() + 4 * (k - segment.begin));
      const RowShares& row = shares[segment.session][training_segments_[k].place];
      for (std::size_t c = 0; c < row.column.size(); ++c) {
        if (row.share[c] != 0.0) sums.add(row.column[c], row.share[c] * unit);
      }
    }
    for (std::size_t c = 0; c < sums.columns.size(); ++c) {
      const estimation::Vector4 rows = segment.W * sums.sums[c];
      for (int row = 0; row < segment.rows; ++row) {
        entries.emplace_back(static_cast<int>(segment.first_row) + row, sums.columns[c], rows[row]);
      }
    }
  }
  linalg::SparseMatrix result(rows_, count);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace trussmap::fitting
