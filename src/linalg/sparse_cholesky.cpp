// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/sparse_cholesky.hpp"

#include "geometry/index.hpp"
#include "linalg/updatable_factor.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <cholmod.h>

namespace trussmap::linalg {
namespace {

// CHOLMOD's view of an Eigen matrix; it only reads through the pointers.
cholmod_sparse view_of(const SparseMatrix& matrix, int stype) {
  cholmod_sparse view{};
  view.nrow = static_cast<size_t>(matrix.rows());
  view.ncol = static_cast<size_t>(matrix.cols());
  view.nzmax = static_cast<size_t>(matrix.nonZeros());
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = stype;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense view_of(const double* values, Eigen::Index rows, Eigen::Index columns) {
  cholmod_dense view{};
  view.nrow = static_cast<size_t>(rows);
  view.ncol = static_cast<size_t>(columns);
  view.nzmax = view.nrow * view.ncol;
  view.d = view.nrow;
  view.x = const_cast<double*>(values);
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace

struct SparseCholesky::Cholmod {
  explicit Cholmod(Ordering ordering) {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
#ifndef TRUSSMAP_GPL  // that module is under the GPL
    common.supernodal = CHOLMOD_SIMPLICIAL;
#endif
    if (ordering == Ordering::automatic) return;
    common.nmethods = 1;
    common.method[0].ordering = ordering == Ordering::amd     ? CHOLMOD_AMD
                                : ordering == Ordering::metis ? CHOLMOD_METIS
                                                              : CHOLMOD_NATURAL;
    if (ordering == Ordering::fixed) common.postorder = 0;
  }
  ~Cholmod() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&forward, &common);
    cholmod_free_dense(&backward, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void check(const char* step) const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < CHOLMOD_OK) {
      throw std::runtime_error(std::string("CHOLMOD failed to ") + step + " (status " +
                               std::to_string(common.status) + ")");
    }
  }

  /// The factor as one that can be changed, made where it is not there yet.
  [[nodiscard]] UpdatableFactor& changing() {
    if (changed) return *changed;
    if (factor->is_super != 0 || factor->is_ll != 0) {
      cholmod_change_factor(CHOLMOD_REAL, 0, 0, 1, 1, factor, &common);
      check("make the factor one that can be updated");
    }
    const auto n = static_cast<int>(factor->n);
    const auto* permutation = static_cast<const int*>(factor->Perm);
    place.resize(factor->n);
    for (int k = 0; k < n; ++k) place[idx(permutation[k])] = k;
    // Each column: its pivot d_j first, then L below it.
    const auto* begin = static_cast<const int*>(factor->p);
    const auto* count = static_cast<const int*>(factor->nz);
    const auto* row = static_cast<const int*>(factor->i);
    const auto* value = static_cast<const double*>(factor->x);
    changed.emplace(n);
    for (int j = 0; j < n; ++j) {
      const int first = begin[j];
      changed->append_column(value[first], row + first + 1, value + first + 1, count[j] - 1);
    }
    return *changed;
  }

  /// A column of a sparse matrix, in the order of the factor.
  [[nodiscard]] std::vector<FactorEntry> in_factor_order(const SparseMatrix& matrix,
                                                         Eigen::Index column) const {
    std::vector<FactorEntry> entries;
    for (SparseMatrix::InnerIterator at(matrix, column); at; ++at) {
      entries.push_back({place[idx(static_cast<int>(at.row()))], at.value()});
    }
    std::sort(entries.begin(), entries.end(),
              [](const FactorEntry& one, const FactorEntry& other) { return one.row < other.row; });
    return entries;
  }

  void solve_changed(Eigen::VectorXd& x) const {
    Eigen::VectorXd y(x.size());
    for (std::size_t k = 0; k < place.size(); ++k) y[place[k]] = x[static_cast<Eigen::Index>(k)];
    changed->solve_in_place(y);
    for (std::size_t k = 0; k < place.size(); ++k) x[static_cast<Eigen::Index>(k)] = y[place[k]];
  }

  mutable cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::optional<UpdatableFactor> changed;  ///< in place of `factor`
  std::vector<int> place;                  ///< of A's columns in it
  cholmod_dense* solution = nullptr;       // kept between calls of solve_in_place
  cholmod_dense* forward = nullptr;
  cholmod_dense* backward = nullptr;
};

SparseCholesky::SparseCholesky(Ordering ordering) : cholmod_(std::make_unique<Cholmod>(ordering)) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::analyse(const SparseMatrix& lower) {
  cholmod_sparse a = view_of(lower, -1);
  cholmod_free_factor(&cholmod_->factor, &cholmod_->common);
  cholmod_->factor = cholmod_analyze(&a, &cholmod_->common);
  cholmod_->check("analyse");
}

void SparseCholesky::factorise(const SparseMatrix& lower) {
  cholmod_->changed.reset();
  cholmod_sparse a = view_of(lower, -1);
  cholmod_->common.status = CHOLMOD_OK;
  cholmod_factorize(&a, cholmod_->factor, &cholmod_->common);
  const cholmod_factor& factor = *cholmod_->factor;
  if (cholmod_->common.status == CHOLMOD_NOT_POSDEF || factor.minor < factor.n) {
    const auto* permutation = static_cast<const int*>(factor.Perm);
    throw NotPositiveDefinite(permutation[factor.minor]);
  }
  cholmod_->check("factorise");
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& b) const {
  if (b.size() == 0) return b;
  if (cholmod_->changed) {
    Eigen::MatrixXd x(b.rows(), b.cols());
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
      Eigen::VectorXd column = b.col(k);
      cholmod_->solve_changed(column);
      x.col(k) = column;
    }
    return x;
  }
  cholmod_dense rhs = view_of(b.data(), b.rows(), b.cols());
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, cholmod_->factor, &rhs, &cholmod_->common);
  cholmod_->check("solve");
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), b.rows(), b.cols());
  cholmod_free_dense(&x, &cholmod_->common);
  return result;
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& b) const {
  return solve(static_cast<const Eigen::MatrixXd&>(Eigen::MatrixXd(b))).col(0);
}

void SparseCholesky::solve_in_place(Eigen::VectorXd& x) {
  Cholmod& c = *cholmod_;
  if (c.changed) {
    c.solve_changed(x);
    return;
  }
  cholmod_dense rhs = view_of(x.data(), x.rows(), 1);
  cholmod_solve2(CHOLMOD_A, c.factor, &rhs, nullptr, &c.solution, nullptr, &c.forward, &c.backward,
                 &c.common);
  c.check("solve");
  x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(c.solution->x), x.rows());
}

std::vector<int> SparseCholesky::order() const {
  const auto* permutation = static_cast<const int*>(cholmod_->factor->Perm);
  return {permutation, permutation + cholmod_->factor->n};
}

double SparseCholesky::multiplications() const {
  return cholmod_->common.fl;
}

void SparseCholesky::update(const SparseMatrix& w) {
  change(true, w);
}

void SparseCholesky::downdate(const SparseMatrix& w) {
  change(false, w);
}

void SparseCholesky::change(bool add, const SparseMatrix& w) {
  UpdatableFactor& factor = cholmod_->changing();
  std::vector<std::vector<FactorEntry>> columns;
  const auto same_rows = [](const auto& one, const auto& other) {
    return std::ranges::equal(one, other, {}, &FactorEntry::row, &FactorEntry::row);
  };
  for (Eigen::Index k = 0; k < w.cols(); ++k) {
    std::vector<FactorEntry> column = cholmod_->in_factor_order(w, k);
    if (!columns.empty() && !same_rows(columns.front(), column)) {
      factor.change(add, columns);
      columns.clear();
    }
    columns.push_back(std::move(column));
  }
  factor.change(add, columns);
}

void SparseCholesky::add_row(int row, const SparseMatrix& column) {
  UpdatableFactor& factor = cholmod_->changing();
  factor.add_row(cholmod_->place[idx(row)], cholmod_->in_factor_order(column, 0));
}

void SparseCholesky::solve_updated(Eigen::VectorXd& x) {
  static_cast<void>(cholmod_->changing());
  cholmod_->solve_changed(x);
}

std::vector<double> SparseCholesky::pivots() const {
  if (cholmod_->changed) return cholmod_->changed->pivots();
  const cholmod_factor& factor = *cholmod_->factor;
  const auto* x = static_cast<const double*>(factor.x);
  std::vector<double> pivots;
  pivots.reserve(factor.n);
  if (factor.is_super != 0) {
    const auto* super = static_cast<const int*>(factor.super);
    const auto* pi = static_cast<const int*>(factor.pi);
    const auto* px = static_cast<const int*>(factor.px);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
      const int rows = pi[s + 1] - pi[s];
      for (int j = 0; j < super[s + 1] - super[s]; ++j) {
        const double l = x[px[s] + j * rows + j];
        pivots.push_back(l * l);
      }
    }
    return pivots;
  }
  const auto* p = static_cast<const int*>(factor.p);
  for (std::size_t j = 0; j < factor.n; ++j) {
    const double l = x[p[j]];
    pivots.push_back(factor.is_ll != 0 ? l * l : l);
  }
  return pivots;
}

double SparseCholesky::log_determinant() const {
  double sum = 0.0;
  for (const double pivot : pivots()) sum += std::log(pivot);
  return sum;
}

double SparseCholesky::least_pivot_share(const Eigen::VectorXd& diagonal) const {
  const std::vector<double> left = pivots();
  const auto* permutation = static_cast<const int*>(cholmod_->factor->Perm);
  double least = 1.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    const double share = left[k] / diagonal[permutation[k]];
    if (!(share >= least)) least = std::isnan(share) ? 0.0 : share;
  }
  return least;
}

double SparseCholesky::reciprocal_condition() const {
  if (cholmod_->changed) {
    const auto [least, most] = std::ranges::minmax(cholmod_->changed->pivots());
    return least / most;
  }
  return cholmod_rcond(cholmod_->factor, &cholmod_->common);
}

double SparseCholesky::factor_nonzeros() const {
  return cholmod_->changed ? cholmod_->changed->nonzeros() : cholmod_->common.lnz;
}

}  // namespace trussmap::linalg
