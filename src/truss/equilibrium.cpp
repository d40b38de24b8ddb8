// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/equilibrium.hpp"

#include "linalg/block_system.hpp"
#include "linalg/dense.hpp"
#include "truss/energy_descent.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace trussmap::truss {
namespace {

// Places kept free, and how much the rows added there, which lengthen all later updates, may add to
// a factor until a new one is cheaper.
constexpr int kLeastSpare = 32;
constexpr int kJointsPerSpare = 8;
constexpr double kMostGrowth = 2.0;
constexpr double kFewNonzeros = 1e4;  // a pass over so many costs little beside a new factor
constexpr double kTurned = 1e-3;      // change of a gradient, as a share of it
constexpr int kFewTurned = 100;       // more: a new factor is cheaper
// What elimination may leave of a diagonal entry: 4 digits of the answer are right even then.
constexpr double kLeastShare = 1e-12;

/// Columns W with W W' = |B|, those of negative eigenvalues first, and how many these are.
std::pair<Matrix2, int> signed_root(const Matrix2& B) {
  const linalg::PlanarModes axes = linalg::planar_modes(B);
  const Vector2 size = axes.eigenvalues;
  const int negative = (size[0] < 0.0 ? 1 : 0) + (size[1] < 0.0 ? 1 : 0);  // these ascend
  return {axes.eigenvectors * size.cwiseAbs().cwiseSqrt().asDiagonal(), negative};
}

}  // namespace

void Equilibrium::changed(int element) {
  if (!factored_) return;
  if (std::ssize(changed_) > kFewTurned) {
    drop();
    return;
  }
  changed_.push_back(element);
  unrest_.push_back(element);
}

void Equilibrium::drop() noexcept {
  factored_ = false;
  changed_.clear();
  unrest_.clear();
  sparse_ = kMostSparse;
}

Equilibrium::Term Equilibrium::term_of(const ElasticTruss& truss, int element) {
  const Element& one = truss.element(element);
  Term term;
  if (one.kind == Element::Kind::bar) {
    term.B = one.B;
  } else {
    term.k = one.k;
    term.gradient = strain_of(truss, one).gradient;
  }
  return term;
}

void Equilibrium::relax(ElasticTruss& truss, const Enough& enough) {
  if (truss.joints() < 2) return;
  follow(truss);
  std::vector<Vector2> before(idx(truss.joints()));
  for (int round = 0; round < enough.rounds; ++round) {
    double then = 0.0;
    const bool exact = linear_ && sound_;  // one step is enough
    if (exact && sparse_ < kMostSparse) {
      evaluate_changes(truss);
    } else {
      then = evaluate(truss);
    }
    if (!turned_.empty()) {
      for (const int element : turned_) changed_.push_back(element);
      follow(truss);
      static_cast<void>(evaluate(truss));  // in a new factor's order
    }
    Eigen::VectorXd u = f_;
    cholesky_.solve_updated(u);
    const double gain = 0.5 * f_.dot(u);
    if (!std::isfinite(gain)) {
      drop();
      throw linalg::NotPositiveDefinite(0);
    }
    if (!(gain > 0.0)) break;
    for (int joint = 1; joint < truss.joints(); ++joint) before[idx(joint)] = truss.position(joint);
    bool fallen = false;
    double share = 1.0;
    for (int halvings = 0; halvings < kMostHalvings && !fallen; ++halvings, share *= 0.5) {
      for (int joint = 1; joint < truss.joints(); ++joint) {
        truss.move(joint, before[idx(joint)] + share * u.segment<2>(unknown_[idx(joint)]));
      }
      fallen = exact || truss.energy() <= then + kNoRise * then;
    }
    if (!fallen) {
      for (int joint = 1; joint < truss.joints(); ++joint) truss.move(joint, before[idx(joint)]);
      return;
    }
    if (exact || gain <= enough.gain * then) break;
  }
  unrest_.clear();
}

/// Forces where bars have changed or joints have moved: elsewhere they balanced before and do now.
void Equilibrium::evaluate_changes(const ElasticTruss& truss) {
  ++sparse_;
  f_.setZero();
  turned_.clear();
  seen_.resize(std::max(seen_.size(), idx(truss.joints())), 0);
  std::vector<int> joints;
  const auto note = [&](int joint) {
    if (seen_[idx(joint)] != 0) return;
    seen_[idx(joint)] = 1;
    joints.push_back(joint);
  };
  for (const int number : unrest_) {
    for (int n = 0; n < truss.element(number).count(); ++n)
      note(truss.element(number).joints[idx(n)]);
  }
  for (const auto& [joint, before] : truss.moved()) {
    note(joint);
    for (const int number : truss.elements_at(joint)) {
      for (int n = 0; n < 2; ++n) note(truss.element(number).joints[idx(n)]);
    }
  }
  for (const int joint : joints) {
    seen_[idx(joint)] = 0;
    if (held(joint)) continue;
    Vector2 sum = Vector2::Zero();
    for (const int number : truss.elements_at(joint)) {
      const Element& one = truss.element(number);
      const Vector2 pull =
          one.B * (one.w - (truss.position(one.joints[1]) - truss.position(one.joints[0])));
      sum += one.joints[1] == joint ? pull : Vector2(-pull);
    }
    f_.segment<2>(unknown_[idx(joint)]) = sum;
  }
}

std::vector<Vector2> Equilibrium::displacements(const ElasticTruss& truss,
                                                const std::vector<std::pair<int, Vector2>>& loads) {
  follow(truss);
  if (!sound_) throw linalg::NotPositiveDefinite(0);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(f_.size());
  for (const auto& [joint, force] : loads) {
    if (!held(joint)) u.segment<2>(unknown_[idx(joint)]) += force;
  }
  cholesky_.solve_updated(u);
  std::vector<Vector2> displacements(idx(truss.joints()), Vector2::Zero());
  for (int joint = 1; joint < truss.joints(); ++joint) {
    displacements[idx(joint)] = u.segment<2>(unknown_[idx(joint)]);
  }
  return displacements;
}

/// Forces at all joints; returns the energy.
double Equilibrium::evaluate(const ElasticTruss& truss) {
  f_.setZero();
  turned_.clear();
  sparse_ = 0;
  double energy = 0.0;
  const auto pull_at = [this](int joint, const Vector2& force) {
    if (!held(joint)) f_.segment<2>(unknown_[idx(joint)]) += force;
  };
  for (int number = 0; number < truss.elements(); ++number) {
    const Element& one = truss.element(number);
    if (one.kind == Element::Kind::bar) {
      const Vector2 strain =
          one.w - (truss.position(one.joints[1]) - truss.position(one.joints[0]));
      const Vector2 force = one.B * strain;
      energy += 0.5 * strain.dot(force);
      pull_at(one.joints[1], force);
      pull_at(one.joints[0], -force);
      continue;
    }
    const Strain strain = strain_of(truss, one);
    energy += 0.5 * one.k * strain.value * strain.value;
    double off = 0.0;
    double size = 0.0;
    for (int n = 0; n < one.count(); ++n) {
      pull_at(one.joints[idx(n)], one.k * strain.value * strain.gradient[idx(n)]);
      off = std::max(off, (strain.gradient[idx(n)] - terms_[idx(number)].gradient[idx(n)]).norm());
      size = std::max(size, strain.gradient[idx(n)].norm());
    }
    if (off > kTurned * size) turned_.push_back(number);
  }
  return energy;
}

/// The factor goes with the truss, or is made anew.
void Equilibrium::follow(const ElasticTruss& truss) {
  if (!factored_ || truss.joints() > static_cast<int>(unknown_.size()) ||
      cholesky_.factor_nonzeros() > kMostGrowth * nonzeros_ + kFewNonzeros ||
      std::ssize(changed_) > kFewTurned) {
    factorise(truss);
    return;
  }
  if (changed_.empty()) return;
  try {
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    const auto last_joint = [&truss](int number) {
      const auto& joints = truss.element(number).joints;
      return *std::max_element(joints.begin(), joints.end());
    };
    while (joints_ < truss.joints()) {
      std::vector<int> at_joint;
      for (const int number : changed_) {
        if (last_joint(number) == joints_) at_joint.push_back(number);
      }
      take_in_joint(truss, joints_, at_joint);
      ++joints_;
    }
    for (const int number : changed_) {
      linear_ = linear_ && truss.element(number).kind == Element::Kind::bar;
      change_term(truss, number, term_of(truss, number));
    }
    changed_.clear();
    sound_ = is_sound();
    if (!sound_) factorise(truss);
  } catch (const linalg::NotPositiveDefinite&) {
    factorise(truss);
  } catch (...) {
    drop();
    throw;
  }
}

/// Its place has been waiting for it, tied to the ground alone.
void Equilibrium::take_in_joint(const ElasticTruss& truss, int joint,
                                const std::vector<int>& elements) {
  terms_.resize(std::max(terms_.size(), idx(truss.elements())));
  std::map<int, Matrix2> row;  // K between a joint and this one
  row[joint] = Matrix2::Zero();
  for (const int number : elements) {
    const Element& one = truss.element(number);
    const Term term = term_of(truss, number);
    std::vector<Column> on_others;
    if (one.kind == Element::Kind::bar) {
      const int other = one.joints[0] == joint ? one.joints[1] : one.joints[0];
      row[joint] += term.B;
      if (!held(other)) {
        row.try_emplace(other, Matrix2::Zero()).first->second -= term.B;
        const Matrix2 W = signed_root(term.B).first;
        on_others = {{{{other, W.col(0)}}}, {{{other, W.col(1)}}}};
      }
    } else {
      std::size_t own = 0;
      while (one.joints[own] != joint) ++own;
      Column column;
      for (int n = 0; n < one.count(); ++n) {
        const int other = one.joints[idx(n)];
        if (held(other)) continue;
        row.try_emplace(other, Matrix2::Zero()).first->second +=
            term.k * term.gradient[idx(n)] * term.gradient[own].transpose();
        if (other != joint) {
          column.parts.emplace_back(other, std::sqrt(term.k) * term.gradient[idx(n)]);
        }
      }
      if (!column.parts.empty()) on_others = {column};
    }
    update(on_others, true);
    terms_[idx(number)] = term;
  }
  for (int c = 0; c < 2; ++c) {
    linalg::SparseMatrix column(f_.size(), 1);
    std::vector<std::pair<int, double>> entries;
    for (const auto& [other, K] : row) {
      for (int r = 0; r < 2; ++r) {
        if (other == joint && r > c) continue;
        entries.emplace_back(unknown_[idx(other)] + r, K(r, c));
      }
    }
    std::sort(entries.begin(), entries.end());
    column.reserve(static_cast<Eigen::Index>(entries.size()));
    for (const auto& [at, value] : entries) column.insert(at, 0) = value;
    column.makeCompressed();
    cholesky_.add_row(unknown_[idx(joint)] + c, column);
    diagonal_[unknown_[idx(joint)] + c] = row[joint](c, c);
  }
}

void Equilibrium::change_term(const ElasticTruss& truss, int element, const Term& now) {
  terms_.resize(std::max(terms_.size(), idx(truss.elements())));
  const Element& one = truss.element(element);
  const Term then = terms_[idx(element)];
  if (one.kind == Element::Kind::bar) {
    const Matrix2 change = now.B - then.B;
    if (change.isZero(0.0)) return;
    const auto [W, negative] = signed_root(change);
    // What it adds goes in first, so that K stays definite.
    std::vector<Column> more;
    std::vector<Column> less;
    for (int c = 0; c < 2; ++c) {
      std::vector<Column>& to = c < negative ? less : more;
      to.push_back({{{one.joints[0], -W.col(c)}, {one.joints[1], W.col(c)}}});
    }
    update(more, true);
    update(less, false);
  } else {
    const auto column = [&one](const Term& term) {
      Column result;
      for (int n = 0; n < one.count(); ++n) {
        result.parts.emplace_back(one.joints[idx(n)], std::sqrt(term.k) * term.gradient[idx(n)]);
      }
      return result;
    };
    if (now.k == then.k && now.gradient == then.gradient) return;
    if (now.k > 0.0) update({column(now)}, true);
    if (then.k > 0.0) update({column(then)}, false);
  }
  terms_[idx(element)] = now;
}

void Equilibrium::update(const std::vector<Column>& columns, bool add) {
  if (columns.empty()) return;
  linalg::SparseMatrix W(f_.size(), static_cast<Eigen::Index>(columns.size()));
  W.reserve(Eigen::VectorXi::Constant(W.cols(), 6));
  Eigen::Index c = 0;
  for (const Column& column : columns) {
    for (const auto& [joint, value] : column.parts) {
      if (held(joint)) continue;
      const int at = unknown_[idx(joint)];
      for (int r = 0; r < 2; ++r) W.insert(at + r, c) = value[r];
      const Vector2 squares = value.cwiseAbs2();
      diagonal_.segment<2>(at) += add ? squares : Vector2(-squares);
    }
    ++c;
  }
  W.makeCompressed();
  if (add) {
    cholesky_.update(W);
  } else {
    cholesky_.downdate(W);
  }
}

namespace {

struct Pattern {
  std::vector<linalg::NodePair> pairs;      ///< of all joints: the elements' own, in order
  std::vector<linalg::NodePair> couplings;  ///< of the joints from 1 on
};

Pattern pattern_of(const ElasticTruss& truss) {
  Pattern pattern;
  const auto couple = [&pattern](int i, int j) {
    pattern.pairs.push_back({i, j});
    if (i > 0 && j > 0) pattern.couplings.push_back({i - 1, j - 1});
  };
  for (int number = 0; number < truss.elements(); ++number) {
    const Element& one = truss.element(number);
    couple(one.joints[0], one.joints[1]);
    if (one.count() < 3) continue;
    couple(one.joints[1], one.joints[2]);
    couple(one.joints[0], one.joints[2]);
  }
  return pattern;
}

/// Joint 0 is held; places beyond the truss's joints come last.
std::vector<int> order_of(const ElasticTruss& truss, const Pattern& pattern, int places) {
  std::vector<int> order{0};
  for (const int joint : linalg::elimination_order(truss.joints() - 1, pattern.couplings)) {
    order.push_back(joint + 1);
  }
  for (int spare = truss.joints(); spare < places; ++spare) order.push_back(spare);
  return order;
}

linalg::BlockSystem system_of(const ElasticTruss& truss, int places, linalg::Kernel kernel) {
  const Pattern pattern = pattern_of(truss);
  std::vector<int> sizes(idx(places), 2);
  sizes[0] = 0;
  linalg::BlockSystem system(sizes, pattern.pairs, order_of(truss, pattern, places), kernel);
  int pair = 0;
  for (int number = 0; number < truss.elements(); ++number) {
    const Element& one = truss.element(number);
    const Tangent tangent = truss.tangent(number);
    for (int n = 0; n < one.count(); ++n) {
      system.add_diagonal(one.joints[idx(n)], tangent.stiffness[idx(n)][idx(n)]);
    }
    system.add_coupling(pair++, tangent.stiffness[0][1]);
    if (one.count() < 3) continue;
    system.add_coupling(pair++, tangent.stiffness[1][2]);
    system.add_coupling(pair++, tangent.stiffness[0][2]);
  }
  for (int spare = truss.joints(); spare < places; ++spare) {
    system.add_diagonal(spare, Matrix2(Matrix2::Identity()));
  }
  return system;
}

}  // namespace

void Equilibrium::factorise(const ElasticTruss& truss) {
  drop();
  const int places = truss.joints() + std::max(kLeastSpare, truss.joints() / kJointsPerSpare);
  linear_ = true;
  terms_.assign(idx(truss.elements()), {});
  for (int number = 0; number < truss.elements(); ++number) {
    terms_[idx(number)] = term_of(truss, number);
    if (truss.element(number).kind != Element::Kind::bar) linear_ = false;
  }
  const linalg::BlockSystem system = system_of(truss, places, linalg::Kernel::cholmod);
  cholesky_.analyse(system.matrix());
  cholesky_.factorise(system.matrix());
  nonzeros_ = cholesky_.factor_nonzeros();
  diagonal_ = system.diagonal();
  sound_ = is_sound();
  unknown_.assign(idx(places), -1);
  for (int joint = 1; joint < places; ++joint) unknown_[idx(joint)] = system.offset(joint);
  f_ = Eigen::VectorXd::Zero(system.unknowns());
  joints_ = truss.joints();
  factored_ = true;
}

bool Equilibrium::is_sound() const {
  return cholesky_.least_pivot_share(diagonal_) >= kLeastShare;
}

std::vector<Matrix2> flexibilities(const ElasticTruss& truss) {
  std::vector<Matrix2> result(idx(truss.joints()), Matrix2::Zero());
  if (truss.joints() < 2) return result;
  linalg::BlockSystem system = system_of(truss, truss.joints(), linalg::Kernel::frontal);
  system.factorise();
  if (!(system.least_pivot_share() >= kLeastShare)) throw linalg::NotPositiveDefinite(0);
  const Eigen::MatrixXd blocks = system.inverse_blocks();
  for (int joint = 1; joint < truss.joints(); ++joint) {
    result[idx(joint)] = blocks.block<2, 2>(0, system.offset(joint));
  }
  return result;
}

}  // namespace trussmap::truss
