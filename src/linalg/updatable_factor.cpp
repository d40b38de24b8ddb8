// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/updatable_factor.hpp"

#include "geometry/index.hpp"
#include "linalg/sparse_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <queue>
#include <utility>

namespace trussmap::linalg {
namespace {

constexpr int kSpareRows = 4;  // of a column that grows

}  // namespace

UpdatableFactor::UpdatableFactor(int n)
    : work_(idx(n), Eigen::Vector2d::Zero()), marked_(idx(n), 0) {
  pivots_.reserve(idx(n));
  columns_.reserve(idx(n));
}

void UpdatableFactor::append_column(double pivot, const int* rows, const double* values,
                                    int count) {
  pivots_.push_back(pivot);
  columns_.push_back({rows_.size(), count, count});
  rows_.insert(rows_.end(), rows, rows + count);
  values_.insert(values_.end(), values, values + count);
  used_ += idx(count);
}

double UpdatableFactor::nonzeros() const {
  return static_cast<double>(used_ + pivots_.size());
}

int UpdatableFactor::parent_of(int column) const {
  const Column& one = columns_[idx(column)];
  return one.count > 0 ? rows_[one.begin] : -1;
}

void UpdatableFactor::reserve(int column, int count) {
  Column& one = columns_[idx(column)];
  if (count <= one.room) return;
  const int room = count + count / 4 + kSpareRows;
  const std::size_t begin = rows_.size();
  rows_.resize(begin + idx(room));
  values_.resize(begin + idx(room));
  const auto from = static_cast<std::ptrdiff_t>(one.begin);
  const auto to = static_cast<std::ptrdiff_t>(begin);
  std::copy_n(rows_.begin() + from, one.count, rows_.begin() + to);
  std::copy_n(values_.begin() + from, one.count, values_.begin() + to);
  one.begin = begin;
  one.room = room;
}

void UpdatableFactor::compact() {
  if (rows_.size() < 2 * used_ + 1024) return;
  std::vector<int> rows;
  std::vector<double> values;
  rows.reserve(used_ + used_ / 4);
  values.reserve(used_ + used_ / 4);
  for (Column& one : columns_) {
    const auto from = static_cast<std::ptrdiff_t>(one.begin);
    one.begin = rows.size();
    one.room = one.count;
    rows.insert(rows.end(), rows_.begin() + from, rows_.begin() + from + one.count);
    values.insert(values.end(), values_.begin() + from, values_.begin() + from + one.count);
  }
  rows_ = std::move(rows);
  values_ = std::move(values);
}

std::vector<int> UpdatableFactor::missing_in(int column, const std::vector<int>& rows) const {
  const Column& one = columns_[idx(column)];
  const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(one.begin);
  std::vector<int> missing;
  std::set_difference(rows.begin(), rows.end(), begin, begin + one.count,
                      std::back_inserter(missing));
  return missing;
}

void UpdatableFactor::insert(int column, const std::vector<int>& rows) {
  const int count = columns_[idx(column)].count;
  const int added = static_cast<int>(rows.size());
  reserve(column, count + added);
  Column& one = columns_[idx(column)];
  int* row = rows_.data() + one.begin;
  double* value = values_.data() + one.begin;
  // From the back, so that each is moved once.
  int from = count - 1;
  int next = added - 1;
  for (int to = count + added - 1; next >= 0; --to) {
    if (from >= 0 && row[from] > rows[idx(next)]) {
      row[to] = row[from];
      value[to] = value[from--];
    } else {
      row[to] = rows[idx(next--)];
      value[to] = 0.0;
    }
  }
  one.count += added;
  used_ += idx(added);
}

template <int Columns>
void UpdatableFactor::follow(bool add, std::vector<int> pattern) {
  double alpha[2] = {1.0, 1.0};
  int j = pattern.front();
  std::vector<int> fresh(pattern.begin() + 1, pattern.end());  // rows that may be new to column j
  while (j >= 0) {
    if (!fresh.empty()) {
      const int before = parent_of(j);
      fresh = missing_in(j, fresh);
      if (!fresh.empty()) insert(j, fresh);
      if (parent_of(j) != before) {  // which may lack all that this column has
        const int* row = rows_.data() + columns_[idx(j)].begin;
        fresh.assign(row + 1, row + columns_[idx(j)].count);
      }
    }
    const Column& column = columns_[idx(j)];
    Eigen::Vector2d& own = work_[idx(j)];
    double p[2], gamma[2];
    double d = pivots_[idx(j)];
    for (int c = 0; c < Columns; ++c) {
      p[c] = own[c];
      const double change = p[c] * p[c] / d;
      const double next = add ? alpha[c] + change : alpha[c] - change;
      if (!(next > 0.0)) throw NotPositiveDefinite(j);
      d *= next;
      gamma[c] = (add ? p[c] : -p[c]) / d;
      d /= alpha[c];
      alpha[c] = next;
    }
    pivots_[idx(j)] = d;
    own.setZero();
    const int* row = rows_.data() + column.begin;
    double* value = values_.data() + column.begin;
    for (int k = 0; k < column.count; ++k) {
      double* w = work_[idx(row[k])].data();
      double l = value[k];
      for (int c = 0; c < Columns; ++c) {
        w[c] -= p[c] * l;
        l += gamma[c] * w[c];
      }
      value[k] = l;
    }
    j = parent_of(j);
  }
}

void UpdatableFactor::change(bool add, const std::vector<std::vector<FactorEntry>>& w) {
  for (std::size_t first = 0; first < w.size(); first += 2) {
    const std::size_t count = std::min<std::size_t>(2, w.size() - first);
    std::vector<int> pattern;
    for (const FactorEntry& entry : w[first]) pattern.push_back(entry.row);
    if (pattern.empty()) continue;
    for (std::size_t c = 0; c < count; ++c) {
      for (const FactorEntry& entry : w[first + c]) {
        work_[idx(entry.row)][static_cast<Eigen::Index>(c)] = entry.value;
      }
    }
    if (count == 2) {
      follow<2>(add, std::move(pattern));
    } else {
      follow<1>(add, std::move(pattern));
    }
  }
  compact();
}

void UpdatableFactor::add_row(int place, const std::vector<FactorEntry>& column) {
  const AddedColumn added = fill_row(place, column);
  const std::vector<FactorEntry> down = fill_column(place, added);
  pivots_[idx(place)] = added.pivot;
  if (!(added.pivot > 0.0)) throw NotPositiveDefinite(place);
  if (down.empty()) {
    compact();
  } else {
    change(false, {down});
  }
}

UpdatableFactor::AddedColumn UpdatableFactor::fill_row(int place,
                                                       const std::vector<FactorEntry>& column) {
  // L11 y = a12, in the order of the columns that it reaches; what these add below the new row
  // comes with it.
  std::priority_queue<int, std::vector<int>, std::greater<>> reached;
  AddedColumn added;
  const auto reach = [&](int row) {
    if (marked_[idx(row)] != 0) return;
    marked_[idx(row)] = 1;
    if (row < place) {
      reached.push(row);
    } else {
      added.below.push_back(row);
    }
  };
  for (const FactorEntry& entry : column) {
    if (entry.row == place) {
      added.pivot = entry.value;
    } else {
      reach(entry.row);
      work_[idx(entry.row)][0] = entry.value;
    }
  }
  const std::vector<int> alone{place};
  const auto has_place = [&](int j) {
    const Column& one = columns_[idx(j)];
    const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(one.begin);
    return std::binary_search(begin, begin + one.count, place);
  };
  while (!reached.empty()) {
    const int j = reached.top();
    reached.pop();
    marked_[idx(j)] = 0;
    const double y = work_[idx(j)][0];
    work_[idx(j)][0] = 0.0;
    if (!has_place(j)) insert(j, alone);
    const Column& one = columns_[idx(j)];
    const int* row = rows_.data() + one.begin;
    double* value = values_.data() + one.begin;
    const double l = y / pivots_[idx(j)];
    for (int k = 0; k < one.count; ++k) {
      if (row[k] == place) {
        value[k] = l;
        continue;
      }
      reach(row[k]);
      work_[idx(row[k])][0] -= value[k] * y;
    }
    added.pivot -= l * y;
  }
  std::sort(added.below.begin(), added.below.end());
  return added;
}

std::vector<FactorEntry> UpdatableFactor::fill_column(int place, const AddedColumn& added) {
  const std::vector<int> missing = missing_in(place, added.below);
  if (!missing.empty()) insert(place, missing);
  std::vector<FactorEntry> down;
  const Column& own = columns_[idx(place)];
  for (int k = 0; k < own.count; ++k) {
    const int row = rows_[own.begin + idx(k)];
    const double l = work_[idx(row)][0] / added.pivot;
    values_[own.begin + idx(k)] = l;
    work_[idx(row)][0] = 0.0;
    down.push_back({row, l * std::sqrt(std::max(0.0, added.pivot))});
  }
  for (const int row : added.below) marked_[idx(row)] = 0;
  return down;
}

bool UpdatableFactor::follow_each_other(int first, int count) const {
  for (int j = first; j + 1 < first + count; ++j) {
    if (parent_of(j) != j + 1 || columns_[idx(j)].count != columns_[idx(j + 1)].count + 1) {
      return false;
    }
  }
  return true;
}

/// Columns that have their rows in common are taken together: x is looked up once for all of them.
template <int Width>
struct UpdatableFactor::Panel {
  Panel(const UpdatableFactor& factor, int first) : j(first) {
    const Column& last = factor.columns_[idx(first + Width - 1)];
    rows = factor.rows_.data() + last.begin;
    count = last.count;
    for (int c = 0; c < Width; ++c) {
      triangle[c] = factor.values_.data() + factor.columns_[idx(first + c)].begin;
      values[c] = triangle[c] + (Width - 1 - c);
    }
  }

  /// x of the columns, and what they take off the rows below.
  void forwards(const double* pivots, double* x) const {
    double own[Width];
    bool zero = true;
    for (int c = 0; c < Width; ++c) {
      own[c] = x[j + c];
      for (int b = 0; b < c; ++b) own[c] -= triangle[b][c - b - 1] * own[b];
      zero = zero && own[c] == 0.0;
    }
    if (zero) return;
    for (int k = 0; k < count; ++k) {
      double off = 0.0;
      for (int c = 0; c < Width; ++c) off += values[c][k] * own[c];
      x[rows[k]] -= off;
    }
    for (int c = 0; c < Width; ++c) x[j + c] = own[c] / pivots[j + c];
  }

  void backwards(double* x) const {
    double sums[Width] = {};
    for (int k = 0; k < count; ++k) {
      const double below = x[rows[k]];
      for (int c = 0; c < Width; ++c) sums[c] += values[c][k] * below;
    }
    for (int c = Width - 1; c >= 0; --c) {
      for (int b = c + 1; b < Width; ++b) sums[c] += triangle[c][b - c - 1] * x[j + b];
      x[j + c] -= sums[c];
    }
  }

  int j;
  int count;
  const int* rows;
  const double* triangle[Width];  ///< of each column, from its first row on
  const double* values[Width];    ///< of each column, from the first row below all of them on
};

void UpdatableFactor::solve_in_place(Eigen::VectorXd& x) const {
  const int n = static_cast<int>(pivots_.size());
  for (int j = 0; j < n;) {
    if (j + 4 <= n && follow_each_other(j, 4)) {
      Panel<4>(*this, j).forwards(pivots_.data(), x.data());
      j += 4;
    } else if (j + 2 <= n && follow_each_other(j, 2)) {
      Panel<2>(*this, j).forwards(pivots_.data(), x.data());
      j += 2;
    } else {
      Panel<1>(*this, j).forwards(pivots_.data(), x.data());
      j += 1;
    }
  }
  for (int j = n; j > 0;) {
    if (j >= 4 && follow_each_other(j - 4, 4)) {
      Panel<4>(*this, j -= 4).backwards(x.data());
    } else if (j >= 2 && follow_each_other(j - 2, 2)) {
      Panel<2>(*this, j -= 2).backwards(x.data());
    } else {
      Panel<1>(*this, j -= 1).backwards(x.data());
    }
  }
}

}  // namespace trussmap::linalg
