// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/relaxation.hpp"

#include "linalg/dense.hpp"
#include "truss/energy_descent.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::truss {
namespace {

constexpr double kUnheld = 1e-13;  // share of its stiffness that an unknown keeps when held

}  // namespace

void Relaxation::relax(ElasticTruss& truss, const std::vector<FreeJoint>& free, int modes,
                       const Enough& enough) {
  if (free.empty()) return;
  look_up(truss, free);
  try {
    order_blocks(truss, free);
    for (int round = 0; round < (linear_ ? 1 : enough.rounds); ++round) {
      if (!step(truss, free, modes, enough.gain)) break;
    }
  } catch (...) {
    forget(free);
    throw;
  }
  forget(free);
}

void Relaxation::look_up(const ElasticTruss& truss, const std::vector<FreeJoint>& free) {
  place_.resize(std::max(place_.size(), idx(truss.joints())), -1);
  touched_.resize(std::max(touched_.size(), idx(truss.elements())), 0);
  elements_.clear();
  std::size_t most = 0;
  for (const FreeJoint& one : free) most += truss.elements_at(one.joint).size();
  elements_.reserve(most);
  linear_ = true;
  for (std::size_t n = 0; n < free.size(); ++n) {
    place_[idx(free[n].joint)] = static_cast<int>(n);
    for (const int number : truss.elements_at(free[n].joint)) {
      if (touched_[idx(number)] != 0) continue;
      touched_[idx(number)] = 1;
      elements_.push_back(number);
      linear_ = linear_ && truss.element(number).kind == Element::Kind::bar;
    }
  }
}

void Relaxation::forget(const std::vector<FreeJoint>& free) noexcept {
  for (const FreeJoint& one : free) place_[idx(one.joint)] = -1;
  for (const int number : elements_) touched_[idx(number)] = 0;
}

/// Along the direction in which the free joints spread most: a patch of a map is narrow across it.
void Relaxation::order_blocks(const ElasticTruss& truss, const std::vector<FreeJoint>& free) {
  int blocks = 0;
  for (const FreeJoint& one : free) blocks = std::max(blocks, one.block + 1);
  std::vector<Vector2> centre(idx(blocks), Vector2::Zero());
  std::vector<int> members(idx(blocks), 0);
  for (const FreeJoint& one : free) {
    centre[idx(one.block)] += truss.position(one.joint);
    ++members[idx(one.block)];
  }
  Vector2 mean = Vector2::Zero();
  for (int b = 0; b < blocks; ++b) {
    centre[idx(b)] /= std::max(members[idx(b)], 1);
    mean += centre[idx(b)] / blocks;
  }
  Matrix2 spread = Matrix2::Zero();
  for (const Vector2& at : centre) spread += (at - mean) * (at - mean).transpose();
  const Vector2 axis = linalg::planar_modes(spread).eigenvectors.col(1);
  std::vector<std::pair<double, int>> along;
  along.reserve(idx(blocks));
  for (int b = 0; b < blocks; ++b) along.emplace_back(axis.dot(centre[idx(b)] - mean), b);
  std::sort(along.begin(), along.end());
  rank_.assign(idx(blocks), 0);
  for (int r = 0; r < blocks; ++r) rank_[idx(along[idx(r)].second)] = r;
  band_ = 0;
  for (const int number : elements_) {
    const Element& element = truss.element(number);
    int low = blocks;
    int high = -1;
    for (int n = 0; n < element.count(); ++n) {
      const int place = place_[idx(element.joints[idx(n)])];
      if (place < 0) continue;
      low = std::min(low, rank_[idx(free[idx(place)].block)]);
      high = std::max(high, rank_[idx(free[idx(place)].block)]);
    }
    band_ = std::max(band_, high - low);
  }
}

double Relaxation::energy(const ElasticTruss& truss) const {
  double sum = 0.0;
  for (const int number : elements_) sum += truss.energy(number);
  return sum;
}

/// Where an element's joints lie among the unknowns: those of one block added up.
struct Relaxation::Share {
  int row = 0;  ///< the block's first unknown
  Eigen::Vector3d c =
      Eigen::Vector3d::Zero();  ///< of a bar: +c of its far joint, -c of its near one
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();  ///< of the others
};

/// Of a bar d = p_j - p_i, of another element its one number: how it depends on the unknowns.
int Relaxation::shares_of(const Element& element, const std::vector<FreeJoint>& free, int modes,
                          const std::array<Vector2, 3>* gradient,
                          std::array<Share, 3>& shares) const {
  int count = 0;
  for (int n = 0; n < element.count(); ++n) {
    const int place = place_[idx(element.joints[idx(n)])];
    if (place < 0) continue;
    const FreeJoint& one = free[idx(place)];
    const int row = 2 * modes * rank_[idx(one.block)];
    int at = 0;
    while (at < count && shares[idx(at)].row != row) ++at;
    if (at == count) {
      shares[idx(count)] = Share{};
      shares[idx(count++)].row = row;
    }
    Share& share = shares[idx(at)];
    if (gradient == nullptr) {
      share.c += n == 0 ? Eigen::Vector3d(-one.c) : one.c;
      continue;
    }
    for (int m = 0; m < modes; ++m) {
      share.gradient.segment<2>(Eigen::Index{2} * m) += one.c[m] * (*gradient)[idx(n)];
    }
  }
  return count;
}

void Relaxation::add_bar(const Element& bar, const Vector2& force, const Share& a, const Share& b,
                         int modes) {
  const bool same = a.row == b.row;
  for (int m = 0; m < modes; ++m) {
    if (same && a.c[m] == 0.0) continue;
    if (same) f_.segment<2>(a.row + 2 * m) += a.c[m] * force;
    for (int k = 0; k < modes; ++k) {
      const double c = a.c[m] * b.c[k];
      if (c == 0.0 || (same && k > m)) continue;
      const int row = a.row + 2 * m;
      const int column = b.row + 2 * k;
      K_.add(row, column, c * bar.B(0, 0));
      K_.add(row + 1, column, c * bar.B(1, 0));
      K_.add(row + 1, column + 1, c * bar.B(1, 1));
      if (row > column) K_.add(row, column + 1, c * bar.B(0, 1));
    }
  }
}

void Relaxation::add_scalar(double k, double strain, const Share& a, const Share& b, int modes) {
  const bool same = a.row == b.row;
  for (int m = 0; m < 2 * modes; ++m) {
    const double pull = k * a.gradient[m];
    if (same) f_[a.row + m] += pull * strain;
    const int last = same ? m + 1 : 2 * modes;
    for (int n = 0; n < last; ++n) K_.add(a.row + m, b.row + n, pull * b.gradient[n]);
  }
}

void Relaxation::assemble(const ElasticTruss& truss, const std::vector<FreeJoint>& free,
                          int modes) {
  const int size = 2 * modes;
  const int n = size * static_cast<int>(rank_.size());
  K_.resize(n, size * (band_ + 1) - 1);
  f_ = Eigen::VectorXd::Zero(n);
  std::array<Share, 3> shares;
  for (const int number : elements_) {
    const Element& element = truss.element(number);
    if (element.kind == Element::Kind::bar) {
      const Vector2 d = truss.position(element.joints[1]) - truss.position(element.joints[0]);
      const Vector2 force = element.B * (element.w - d);
      const int count = shares_of(element, free, modes, nullptr, shares);
      for (int a = 0; a < count; ++a) {
        for (int b = 0; b < count; ++b) {
          if (shares[idx(b)].row > shares[idx(a)].row) continue;
          add_bar(element, force, shares[idx(a)], shares[idx(b)], modes);
        }
      }
      continue;
    }
    const Strain strain = strain_of(truss, element);
    const int count = shares_of(element, free, modes, &strain.gradient, shares);
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        if (shares[idx(b)].row > shares[idx(a)].row) continue;
        add_scalar(element.k, strain.value, shares[idx(a)], shares[idx(b)], modes);
      }
    }
  }
}

/// False where little is left to be gained.
bool Relaxation::step(ElasticTruss& truss, const std::vector<FreeJoint>& free, int modes,
                      double enough) {
  assemble(truss, free, modes);
  const Eigen::VectorXd force = f_;
  K_.factorise(kUnheld);
  K_.solve_in_place(f_);
  const double then = energy(truss);
  const double gain = 0.5 * force.dot(f_);
  if (!(gain > 0.0) || !std::isfinite(gain)) return false;
  before_.clear();
  for (const FreeJoint& one : free) before_.push_back(truss.position(one.joint));
  const int size = 2 * modes;
  double share = 1.0;
  for (int halvings = 0; halvings < kMostHalvings; ++halvings, share *= 0.5) {
    for (std::size_t n = 0; n < free.size(); ++n) {
      Vector2 u = Vector2::Zero();
      const int row = size * rank_[idx(free[n].block)];
      for (int m = 0; m < modes; ++m) u += free[n].c[m] * f_.segment<2>(row + 2 * m);
      truss.move(free[n].joint, before_[n] + share * u);
    }
    if (energy(truss) <= then + kNoRise * then) return gain > enough * then;
  }
  for (std::size_t n = 0; n < free.size(); ++n) truss.move(free[n].joint, before_[n]);
  return false;
}

}  // namespace trussmap::truss
