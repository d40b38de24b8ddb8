// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/expected_falls.hpp"

#include "geometry/index.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace trussmap::map {

ExpectedFalls::ExpectedFalls(MapMechanics& mechanics, bool aligned)
    : mechanics_(mechanics), aligned_(aligned) {
  const truss::ElasticTruss& truss = mechanics.truss();
  Vector2 middle = Vector2::Zero();
  for (const Vector2& at : truss.positions()) middle += at / truss.joints();
  turn_.resize(2 * truss.joints());
  for (int k = 0; k < truss.joints(); ++k) {
    turn_.segment<2>(2 * k) = quarter_turn(truss.position(k) - middle);
  }
  turn_.normalize();
}

Eigen::VectorXd ExpectedFalls::within_the_map(Eigen::VectorXd displacement) const {
  if (!aligned_) return displacement;
  const Eigen::Map<Eigen::Matrix2Xd> by_joint(displacement.data(), 2, displacement.size() / 2);
  const Vector2 middle = by_joint.rowwise().mean();
  for (Eigen::Index k = 0; k < displacement.size(); k += 2) displacement.segment<2>(k) -= middle;
  displacement -= turn_.dot(displacement) * turn_;
  return displacement;
}

const ExpectedFalls::Column& ExpectedFalls::column(const Key& key, const Load& gradient) {
  const auto known = columns_.find(key);
  if (known != columns_.end()) return known->second;
  Column one;
  one.gradient = gradient;
  const std::vector<Vector2> by_joint = mechanics_.displacements(gradient);
  one.displacement.resize(2 * std::ssize(by_joint));
  for (std::size_t k = 0; k < by_joint.size(); ++k) {
    one.displacement.segment<2>(2 * static_cast<Eigen::Index>(k)) = by_joint[k];
  }
  one.counted = within_the_map(one.displacement);
  return columns_.emplace(key, std::move(one)).first->second;
}

/// What an element measures, one number or two: the gradient of each.
std::vector<ExpectedFalls::Load> ExpectedFalls::gradients(const truss::Element& one) const {
  const auto [i, j, k] = one.joints;
  if (one.kind == truss::Element::Kind::bar) {
    return {{{i, -Vector2::UnitX()}, {j, Vector2::UnitX()}},
            {{i, -Vector2::UnitY()}, {j, Vector2::UnitY()}}};
  }
  const truss::Strain strain = truss::strain_of(mechanics_.truss(), one);
  Load gradient;
  for (int n = 0; n < one.count(); ++n) {
    gradient.emplace_back(one.joints[idx(n)], strain.gradient[idx(n)]);
  }
  return {gradient};
}

double ExpectedFalls::of(const std::vector<truss::Element>& measured) {
  std::vector<const Column*> columns;
  for (const truss::Element& one : measured) {
    int part = 0;
    for (const Load& gradient : gradients(one)) {
      columns.push_back(&column({one.joints, one.kind, part++}, gradient));
    }
  }
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd S(count, count);
  Eigen::MatrixXd squares(count, count);
  for (Eigen::Index r = 0; r < count; ++r) {
    for (Eigen::Index c = 0; c <= r; ++c) {
      double variance = 0.0;
      for (const auto& [joint, force] : columns[idx(r)]->gradient) {
        variance += force.dot(columns[idx(c)]->displacement.segment<2>(Eigen::Index{2} * joint));
      }
      S(r, c) = S(c, r) = variance;
      squares(r, c) = squares(c, r) = columns[idx(r)]->counted.dot(columns[idx(c)]->counted);
    }
  }
  Eigen::Index at = 0;
  for (const truss::Element& one : measured) {
    if (one.kind == truss::Element::Kind::bar) {
      S.block<2, 2>(at, at) += one.B.inverse();
      at += 2;
    } else {
      S(at, at) += 1.0 / one.k;
      ++at;
    }
  }
  return S.llt().solve(squares).trace();
}

}  // namespace trussmap::map
