// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "linalg/sparse_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>
#include <utility>

#include <cholmod.h>

namespace trussmap {
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

  /// CHOLMOD changes a factor by columns whose rows are in the order of the factor.
  [[nodiscard]] cholmod_sparse* in_factor_order(const SparseMatrix& columns) {
    cholmod_sparse view = view_of(columns, 0);
    cholmod_sparse* permuted =
        cholmod_submatrix(&view, static_cast<int*>(factor->Perm),
                          static_cast<SuiteSparse_long>(factor->n), nullptr, -1, 1, 1, &common);
    check("permute an update");
    return permuted;
  }

  mutable cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;  // kept between calls of solve_in_place
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

void SparseCholesky::update(const SparseMatrix& w) {
  change(true, w);
}

void SparseCholesky::downdate(const SparseMatrix& w) {
  change(false, w);
}

void SparseCholesky::change(bool add, const SparseMatrix& w) {
  auto* factor = cholmod_->factor;
  cholmod_sparse* permuted = cholmod_->in_factor_order(w);
  cholmod_updown(add ? 1 : 0, permuted, factor, &cholmod_->common);
  cholmod_free_sparse(&permuted, &cholmod_->common);
  cholmod_->check("update the factor");
}

void SparseCholesky::add_row(int row, const SparseMatrix& column) {
  auto* factor = cholmod_->factor;
  const auto* permutation = static_cast<const int*>(factor->Perm);
  const auto place = std::find(permutation, permutation + factor->n, row) - permutation;
  cholmod_sparse* permuted = cholmod_->in_factor_order(column);
  cholmod_rowadd(static_cast<size_t>(place), permuted, factor, &cholmod_->common);
  cholmod_free_sparse(&permuted, &cholmod_->common);
  cholmod_->check("add a row to the factor");
}

void SparseCholesky::solve_updated(Eigen::VectorXd& x) {
  const cholmod_factor& factor = *cholmod_->factor;
  if (factor.is_super != 0 || factor.is_ll != 0) {
    cholmod_change_factor(CHOLMOD_REAL, 0, 0, 0, 1, cholmod_->factor, &cholmod_->common);
    cholmod_->check("make the factor one that can be updated");
  }
  const auto* permutation = static_cast<const int*>(factor.Perm);
  const auto* begin = static_cast<const int*>(factor.p);
  const auto* count = static_cast<const int*>(factor.nz);
  const auto* row = static_cast<const int*>(factor.i);
  const auto* value = static_cast<const double*>(factor.x);
  const auto n = static_cast<Eigen::Index>(factor.n);
  // Each column: its pivot d_j first, then L below it.
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) y[k] = x[permutation[k]];
  for (Eigen::Index j = 0; j < n; ++j) {
    const double yj = y[j];
    if (yj == 0.0) continue;
    const int first = begin[j];
    for (int k = first + 1; k < first + count[j]; ++k) y[row[k]] -= value[k] * yj;
    y[j] = yj / value[first];
  }
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    const int first = begin[j];
    const int last = first + count[j];
    double sums[2] = {y[j], 0.0};
    int k = first + 1;
    for (; k + 2 <= last; k += 2) {
      sums[0] -= value[k] * y[row[k]];
      sums[1] -= value[k + 1] * y[row[k + 1]];
    }
    if (k < last) sums[0] -= value[k] * y[row[k]];
    y[j] = sums[0] + sums[1];
  }
  for (Eigen::Index k = 0; k < n; ++k) x[permutation[k]] = y[k];
}

double SparseCholesky::log_determinant() const {
  const cholmod_factor& factor = *cholmod_->factor;
  const auto* x = static_cast<const double*>(factor.x);
  double sum = 0.0;
  if (factor.is_super != 0) {
    const auto* super = static_cast<const int*>(factor.super);
    const auto* pi = static_cast<const int*>(factor.pi);
    const auto* px = static_cast<const int*>(factor.px);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
      const int rows = pi[s + 1] - pi[s];
      for (int j = 0; j < super[s + 1] - super[s]; ++j)
        sum += 2.0 * std::log(x[px[s] + j * rows + j]);
    }
    return sum;
  }
  const auto* p = static_cast<const int*>(factor.p);
  for (std::size_t j = 0; j < factor.n; ++j) {
    sum += (factor.is_ll != 0 ? 2.0 : 1.0) * std::log(x[p[j]]);
  }
  return sum;
}

double SparseCholesky::reciprocal_condition() const {
  return cholmod_rcond(cholmod_->factor, &cholmod_->common);
}

double SparseCholesky::factor_nonzeros() const {
  return cholmod_->common.lnz;
}

}  // namespace trussmap
