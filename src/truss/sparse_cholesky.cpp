// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/truss/sparse_cholesky.hpp"

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
  // cholmod_updown wants the rows of W in the order of the factor.
  cholmod_sparse view = view_of(w, 0);
  auto* factor = cholmod_->factor;
  cholmod_sparse* permuted = cholmod_submatrix(&view, static_cast<int*>(factor->Perm),
                                               static_cast<SuiteSparse_long>(factor->n), nullptr,
                                               -1, 1, 1, &cholmod_->common);
  cholmod_->check("permute an update");
  cholmod_updown(add ? 1 : 0, permuted, factor, &cholmod_->common);
  cholmod_free_sparse(&permuted, &cholmod_->common);
  cholmod_->check("update the factor");
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
