// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/frontal_cholesky.hpp"

#include "geometry/index.hpp"
#include "linalg/front_kernels.hpp"
#include "parallel/parallel_for.hpp"
#include "trussmap/running.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace trussmap::linalg {
namespace {

constexpr Eigen::Index kColumns = 32;  // solved at once: a front's rows stay in the cache
constexpr double kWorthThreads = 1e7;  // multiplications, some milliseconds
constexpr double kRangesPerThread = 4.0;

}  // namespace

FrontalCholesky::FrontalCholesky(const FrontTree& tree, const std::vector<int>& sizes) {
  node_begin_.reserve(sizes.size() + 1);
  int unknowns = 0;
  for (const int size : sizes) {
    node_begin_.push_back(unknowns);
    unknowns += size;
  }
  node_begin_.push_back(unknowns);
  number_rows(tree);
  list_children();
  find_runs();
  add_up_work();
}

void FrontalCholesky::number_rows(const FrontTree& tree) {
  parts_.reserve(tree.fronts.size());
  for (const Front& front : tree.fronts) {
    Part part{};
    part.panel = stored_;
    part.unknown = node_begin_[idx(front.first)];
    part.width = front.width;
    part.rows = front.width + front.height;
    part.parent = front.parent;
    part.scalars_begin = static_cast<int>(scalars_.size());
    for (int k = front.rows_begin; k < front.rows_end; ++k) {
      const std::size_t node = idx(tree.rows[idx(k)]);
      for (int u = node_begin_[node]; u < node_begin_[node + 1]; ++u) scalars_.push_back(u);
    }
    stored_ += area(part.rows, part.width);
    most_rows_ = std::max(most_rows_, part.rows);
    parts_.push_back(part);
  }
}

void FrontalCholesky::list_children() {
  std::vector<int> next(parts_.size() + 1, 0);
  for (const Part& part : parts_) {
    if (part.parent >= 0) ++next[idx(part.parent) + 1];
  }
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    parts_[f].children_begin = next[f];
    next[f + 1] += next[f];
    parts_[f].children_end = next[f + 1];
  }
  children_.resize(idx(next.back()));
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    const int parent = parts_[f].parent;
    if (parent >= 0) children_[idx(next[idx(parent)]++)] = static_cast<int>(f);
  }
}

void FrontalCholesky::find_runs() {
  std::vector<int> where(idx(node_begin_.back()));  // row of the front that an unknown stands in
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    const Part& front = parts_[f];
    for (int r = 0; r < front.height(); ++r) {
      where[idx(scalars_[idx(front.scalars_begin + r)])] = front.width + r;
    }
    for (int k = front.children_begin; k < front.children_end; ++k) {
      Part& child = parts_[idx(children_[idx(k)])];
      child.runs_begin = static_cast<int>(runs_.size());
      for (int r = 0; r < child.height(); ++r) {
        const int unknown = scalars_[idx(child.scalars_begin + r)];
        const int own = unknown - front.unknown;
        const int to = own < front.width ? own : where[idx(unknown)];
        if (r > 0 && runs_.back().to + runs_.back().length == to) {
          ++runs_.back().length;
        } else {
          runs_.push_back({r, to, 1});
        }
      }
      child.runs_end = static_cast<int>(runs_.size());
    }
  }
}

void FrontalCholesky::add_up_work() {
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    Part& front = parts_[f];
    front.subtree_begin = static_cast<int>(f);
    for (int c = 0; c < front.width; ++c) front.work += 0.5 * (front.rows - c) * (front.rows - c);
    for (int k = front.children_begin; k < front.children_end; ++k) {
      const Part& child = parts_[idx(children_[idx(k)])];
      front.work += child.work;
      front.subtree_begin = std::min(front.subtree_begin, child.subtree_begin);
    }
  }
}

/// Small enough that threads which are done early find another, neighbours together.
std::vector<FrontalCholesky::FrontRange> FrontalCholesky::independent_ranges() const {
  double all = 0.0;
  for (const Part& front : parts_) {
    if (front.parent < 0) all += front.work;
  }
  if (!parallel::is_parallel() || all < kWorthThreads) return {{0, parts_.size()}};
  const double most = all / kRangesPerThread / threads();
  std::vector<FrontRange> ranges;
  double work = 0.0;  // of the last range
  for (std::size_t f = 0; f < parts_.size(); ++f) {
    const Part& front = parts_[f];
    if (front.work > most || (front.parent >= 0 && parts_[idx(front.parent)].work <= most))
      continue;
    const std::size_t begin = idx(front.subtree_begin);
    if (!ranges.empty() && ranges.back().end == begin && work + front.work <= most) {
      ranges.back().end = f + 1;
      work += front.work;
    } else {
      ranges.push_back({begin, f + 1});
      work = front.work;
    }
  }
  return ranges;
}

void FrontalCholesky::factorise(const SparseMatrix& lower) {
  if (!panels_) panels_ = large_array(stored_);
  std::vector<Update> waiting(parts_.size());
  const std::vector<FrontRange> ranges = independent_ranges();
  parallel::parallel_for(ranges.size(),
                         [&](std::size_t k) { eliminate_range(ranges[k], lower, waiting); });
  // What is above them, one front after the other, its tiles at the same time.
  std::size_t next = 0;
  for (const FrontRange& range : ranges) {
    if (range.begin > next) eliminate_range({next, range.begin}, lower, waiting);
    next = range.end;
  }
  if (next < parts_.size()) eliminate_range({next, parts_.size()}, lower, waiting);
}

void FrontalCholesky::eliminate_range(const FrontRange& range, const SparseMatrix& lower,
                                      std::vector<Update>& waiting) {
  const auto where = std::make_unique_for_overwrite<int[]>(idx(node_begin_.back()));
  for (std::size_t f = range.begin; f < range.end; ++f) {
    const Part& front = parts_[f];
    waiting[f] = large_array(area(front.height(), front.height()));
    assemble(front, lower, waiting, where.get(), waiting[f].get());
    const int failed =
        eliminate(panels_.get() + front.panel, front.rows, front.width, waiting[f].get());
    if (failed >= 0) throw NotPositiveDefinite(front.unknown + failed);
    for (int k = front.children_begin; k < front.children_end; ++k) {
      waiting[idx(children_[idx(k)])].reset();
    }
  }
}

/// `where`: room for the row of the front that each unknown stands in.
void FrontalCholesky::assemble(const Part& front, const SparseMatrix& lower,
                               const std::vector<Update>& waiting, int* where, double* update) {
  double* panel = panels_.get() + front.panel;
  std::fill_n(panel, area(front.rows, front.width), 0.0);
  std::fill_n(update, area(front.height(), front.height()), 0.0);
  for (int r = 0; r < front.height(); ++r) {
    where[scalars_[idx(front.scalars_begin + r)]] = front.width + r;
  }
  for (int c = 0; c < front.width; ++c) {
    const int column = front.unknown + c;
    double* to = panel + at(0, c, front.rows);
    for (int k = lower.outerIndexPtr()[column]; k < lower.outerIndexPtr()[column + 1]; ++k) {
      const int row = lower.innerIndexPtr()[k];
      const int own = row - front.unknown;
      to[own < front.width ? own : where[row]] = lower.valuePtr()[k];
    }
  }
  for (int k = front.children_begin; k < front.children_end; ++k) {
    const std::size_t child = idx(children_[idx(k)]);
    add_update(parts_[child], waiting[child].get(), front, update);
  }
}

void FrontalCholesky::add_update(const Part& child, const double* from, const Part& front,
                                 double* update) {
  double* panel = panels_.get() + front.panel;
  const Run* const end = runs_.data() + child.runs_end;
  for (const Run* columns = runs_.data() + child.runs_begin; columns != end; ++columns) {
    for (int k = 0; k < columns->length; ++k) {
      const int c = columns->from + k;
      const int column = columns->to + k;
      const double* source = from + at(0, c, child.height());
      // Rows of the panel count from its top, those of the update from below the panel's square.
      double* target = column < front.width
                           ? panel + at(0, column, front.rows)
                           : update + at(0, column - front.width, front.height()) - front.width;
      for (int r = c; r < columns->from + columns->length; ++r) {
        target[columns->to + r - columns->from] += source[r];
      }
      for (const Run* rows = columns + 1; rows != end; ++rows) {
        for (int r = 0; r < rows->length; ++r) target[rows->to + r] += source[rows->from + r];
      }
    }
  }
}

void FrontalCholesky::solve_in_place(Eigen::Ref<Eigen::VectorXd> x) const {
  std::vector<double> local(idx(most_rows_));
  const auto gather = [&](const Part& front) {
    std::copy_n(x.data() + front.unknown, front.width, local.begin());
    const int* rows = scalars_.data() + front.scalars_begin;
    for (int r = 0; r < front.height(); ++r) local[idx(front.width + r)] = x[rows[r]];
  };
  for (const Part& front : parts_) {
    gather(front);
    solve_forward(panels_.get() + front.panel, front.rows, front.width, local.data());
    std::copy_n(local.begin(), front.width, x.data() + front.unknown);
    const int* rows = scalars_.data() + front.scalars_begin;
    for (int r = 0; r < front.height(); ++r) x[rows[r]] = local[idx(front.width + r)];
  }
  for (auto front = parts_.rbegin(); front != parts_.rend(); ++front) {
    gather(*front);
    solve_backward(panels_.get() + front->panel, front->rows, front->width, local.data());
    std::copy_n(local.begin(), front->width, x.data() + front->unknown);
  }
}

void FrontalCholesky::solve_columns(Eigen::MatrixXd& x) const {
  parallel::parallel_for(idx((x.cols() + kColumns - 1) / kColumns), [&](std::size_t k) {
    const Eigen::Index first = static_cast<Eigen::Index>(k) * kColumns;
    solve_some(x.middleCols(first, std::min(kColumns, x.cols() - first)));
  });
}

/// Row by row, so that a front's rows are copied whole; filled up with columns of zeros.
void FrontalCholesky::solve_some(Eigen::Ref<Eigen::MatrixXd> x) const {
  const Eigen::Index columns = x.cols();
  const auto count = static_cast<int>((columns + 7) / 8 * 8);
  std::vector<double> sides(idx(node_begin_.back()) * idx(count), 0.0);
  std::vector<double> local(idx(most_rows_) * idx(count));
  for (Eigen::Index c = 0; c < columns; ++c) {
    const double* from = x.col(c).data();
    double* to = sides.data() + c;
    for (Eigen::Index r = 0; r < x.rows(); ++r) to[r * count] = from[r];
  }
  const auto side = [&](int unknown) { return sides.data() + at(0, unknown, count); };
  const auto gather = [&](const Part& front) {
    std::copy_n(side(front.unknown), area(front.width, count), local.begin());
    double* to = local.data() + at(0, front.width, count);
    const int* rows = scalars_.data() + front.scalars_begin;
    for (int r = 0; r < front.height(); ++r)
      std::copy_n(side(rows[r]), count, to + at(0, r, count));
  };
  for (const Part& front : parts_) {
    gather(front);
    solve_forward_many(panels_.get() + front.panel, front.rows, front.width, local.data(), count);
    std::copy_n(local.begin(), area(front.width, count), side(front.unknown));
    const double* from = local.data() + at(0, front.width, count);
    const int* rows = scalars_.data() + front.scalars_begin;
    for (int r = 0; r < front.height(); ++r) {
      std::copy_n(from + at(0, r, count), count, side(rows[r]));
    }
  }
  for (auto front = parts_.rbegin(); front != parts_.rend(); ++front) {
    gather(*front);
    solve_backward_many(panels_.get() + front->panel, front->rows, front->width, local.data(),
                        count);
    std::copy_n(local.begin(), area(front->width, count), side(front->unknown));
  }
  for (Eigen::Index c = 0; c < columns; ++c) {
    double* to = x.col(c).data();
    const double* from = sides.data() + c;
    for (Eigen::Index r = 0; r < x.rows(); ++r) to[r] = from[r * count];
  }
}

std::size_t FrontalCholesky::front_of(int unknown) const {
  const auto after =
      std::upper_bound(parts_.begin(), parts_.end(), unknown,
                       [](int value, const Part& front) { return value < front.unknown; });
  return idx(after - parts_.begin()) - 1;
}

/// |L^-1 B|^2, front by front: what a front leaves for the rows above waits for its parent.
Eigen::MatrixXd FrontalCholesky::inverse_products(const std::vector<Eigen::Triplet<double>>& b,
                                                  int columns) const {
  const int count = (columns + 7) / 8 * 8;
  std::map<std::size_t, std::vector<double>> reached;  // rows x count of a front, row by row
  const auto sides_of = [&](std::size_t f) -> std::vector<double>& {
    std::vector<double>& sides = reached[f];
    if (sides.empty()) sides.assign(area(parts_[f].rows, count), 0.0);
    return sides;
  };
  for (const Eigen::Triplet<double>& one : b) {
    const std::size_t f = front_of(one.row());
    sides_of(f)[idx(at(one.col(), one.row() - parts_[f].unknown, count))] += one.value();
  }
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(count, count);
  while (!reached.empty()) {
    const auto first = reached.begin();  // whose children are all done
    const Part& front = parts_[first->first];
    std::vector<double> sides = std::move(first->second);
    reached.erase(first);
    solve_forward_many(panels_.get() + front.panel, front.rows, front.width, sides.data(), count);
    const Eigen::Map<const Eigen::MatrixXd> Y(sides.data(), count, front.width);
    products.selfadjointView<Eigen::Lower>().rankUpdate(Y);
    if (front.height() == 0) continue;
    std::vector<double>& above = sides_of(idx(front.parent));
    for (int k = front.runs_begin; k < front.runs_end; ++k) {
      const Run& run = runs_[idx(k)];
      const double* from = sides.data() + at(0, front.width + run.from, count);
      double* to = above.data() + at(0, run.to, count);
      for (std::size_t q = 0; q < area(run.length, count); ++q) to[q] += from[q];
    }
  }
  return Eigen::MatrixXd(products.selfadjointView<Eigen::Lower>()).topLeftCorner(columns, columns);
}

double FrontalCholesky::log_determinant() const {
  double sum = 0.0;
  for (const Part& front : parts_) {
    for (int c = 0; c < front.width; ++c) {
      sum += 2.0 * std::log(panels_[front.panel + idx(at(c, c, front.rows))]);
    }
  }
  return sum;
}

double FrontalCholesky::reciprocal_condition() const {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Part& front : parts_) {
    for (int c = 0; c < front.width; ++c) {
      const double pivot = panels_[front.panel + idx(at(c, c, front.rows))];
      least = std::min(least, pivot);
      most = std::max(most, pivot);
    }
  }
  return most > 0.0 ? (least / most) * (least / most) : 1.0;
}

double FrontalCholesky::least_pivot_share(const Eigen::VectorXd& diagonal) const {
  double least = 1.0;
  for (const Part& front : parts_) {
    for (int c = 0; c < front.width; ++c) {
      const double l = panels_[front.panel + idx(at(c, c, front.rows))];
      const double share = l * l / diagonal[front.unknown + c];
      if (!(share >= least)) least = std::isnan(share) ? 0.0 : share;
    }
  }
  return least;
}

}  // namespace trussmap::linalg
