// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "truss/elastic_truss.hpp"

#include "geometry/make_room.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap::truss {
namespace {

/// Gradient of angle(d) by the far end; zero where d has no direction.
Vector2 turning(const Vector2& d) {
  const double square = d.squaredNorm();
  return square > 0.0 ? Vector2(quarter_turn(d) / square) : Vector2(Vector2::Zero());
}

Element scalar(Element::Kind kind, std::array<int, 3> joints, double k, double rest) {
  Element element;
  element.kind = kind;
  element.joints = joints;
  element.k = k;
  element.rest = rest;
  return element;
}

}  // namespace

Element bar_element(int i, int j, const Matrix2& B, const Vector2& w) {
  Element element;
  element.joints = {i, j, -1};
  element.B = B;
  element.w = w;
  return element;
}

Element length_element(int i, int j, double k, double length) {
  return scalar(Element::Kind::length, {i, j, -1}, k, length);
}

Element direction_element(int i, int j, double k, double angle) {
  return scalar(Element::Kind::direction, {i, j, -1}, k, angle);
}

Element corner_element(int i, int j, int k, double stiffness, double angle) {
  return scalar(Element::Kind::corner, {i, j, k}, stiffness, angle);
}

int ElasticTruss::add_joint(const Vector2& position) {
  geometry::make_room(positions_);
  at_.emplace_back();
  positions_.push_back(position);
  return joints() - 1;
}

int ElasticTruss::add_element(const Element& element) {
  for (int n = 0; n < element.count(); ++n) {
    const int joint = element.joints[idx(n)];
    if (joint < 0 || joint >= joints()) throw std::invalid_argument("an element joins two joints");
    for (int m = 0; m < n; ++m) {
      if (element.joints[idx(m)] == joint) {
        throw std::invalid_argument("an element's joints are different ones");
      }
    }
  }
  geometry::make_room(elements_);
  for (int n = 0; n < element.count(); ++n) geometry::make_room(at_[idx(element.joints[idx(n)])]);
  for (int n = 0; n < element.count(); ++n) {
    at_[idx(element.joints[idx(n)])].push_back(elements());
  }
  elements_.push_back(element);
  return elements() - 1;
}

void ElasticTruss::set_element(int number, const Element& element) {
  Element& present = elements_[idx(number)];
  if (present.kind != element.kind || present.joints != element.joints) {
    throw std::invalid_argument("an element keeps its joints");
  }
  if (number < elements_then_) changed_.emplace_back(number, present);
  present = element;
}

void ElasticTruss::move(int joint, const Vector2& to) {
  if (joint < joints_then_) moved_.emplace_back(joint, positions_[idx(joint)]);
  positions_[idx(joint)] = to;
}

void ElasticTruss::begin() noexcept {
  joints_then_ = joints();
  elements_then_ = elements();
  moved_.clear();
  changed_.clear();
}

void ElasticTruss::roll_back() noexcept {
  while (elements() > elements_then_) {
    const Element& last = elements_.back();
    for (int n = 0; n < last.count(); ++n) at_[idx(last.joints[idx(n)])].pop_back();
    elements_.pop_back();
  }
  while (joints() > joints_then_) positions_.pop_back();
  while (at_.size() > positions_.size()) at_.pop_back();
  for (auto one = changed_.rbegin(); one != changed_.rend(); ++one) {
    elements_[idx(one->first)] = one->second;
  }
  for (auto one = moved_.rbegin(); one != moved_.rend(); ++one) {
    positions_[idx(one->first)] = one->second;
  }
  begin();
}

Strain strain_of(const ElasticTruss& truss, const Element& element) {
  const auto [i, j, k] = element.joints;
  const Vector2 d = truss.position(j) - truss.position(i);
  Strain strain;
  strain.gradient.fill(Vector2::Zero());
  if (element.kind == Element::Kind::length) {
    const double length = d.norm();
    strain.value = element.rest - length;
    strain.gradient[1] = length > 0.0 ? Vector2(d / length) : Vector2(Vector2::UnitX());
    strain.gradient[0] = -strain.gradient[1];
    return strain;
  }
  const Vector2 turn = turning(d);
  if (element.kind == Element::Kind::direction) {
    strain.value = wrap_angle(element.rest - direction(d));
    strain.gradient[1] = turn;
    strain.gradient[0] = -turn;
    return strain;
  }
  const Vector2 next = truss.position(k) - truss.position(j);
  const Vector2 next_turn = turning(next);
  strain.value = wrap_angle(element.rest - (direction(next) - direction(d)));
  strain.gradient = {turn, Vector2(-turn - next_turn), next_turn};
  return strain;
}

void ElasticTruss::fetch(const std::vector<int>& joints) const noexcept {
  for (const int joint : joints) {
    __builtin_prefetch(&at_[idx(joint)]);
    __builtin_prefetch(&positions_[idx(joint)]);
  }
  for (const int joint : joints) __builtin_prefetch(at_[idx(joint)].data());
  for (const int joint : joints) {
    for (const int number : at_[idx(joint)]) {
      const auto* const element = reinterpret_cast<const char*>(&elements_[idx(number)]);
      __builtin_prefetch(element);
      __builtin_prefetch(element + sizeof(Element) - 1);
    }
  }
  for (const int joint : joints) {
    for (const int number : at_[idx(joint)]) {
      for (int n = 0; n < element(number).count(); ++n) {
        __builtin_prefetch(&positions_[idx(element(number).joints[idx(n)])]);
      }
    }
  }
}

double ElasticTruss::energy(int number) const {
  const Element& one = element(number);
  if (one.kind == Element::Kind::bar) {
    const Vector2 strain = position(one.joints[1]) - position(one.joints[0]) - one.w;
    return 0.5 * strain.dot(one.B * strain);
  }
  const double strain = strain_of(*this, one).value;
  return 0.5 * one.k * strain * strain;
}

double ElasticTruss::energy() const {
  double sum = 0.0;
  for (int number = 0; number < elements(); ++number) sum += energy(number);
  return sum;
}

Tangent ElasticTruss::tangent(int number) const {
  const Element& one = element(number);
  Tangent result;
  if (one.kind == Element::Kind::bar) {
    const Vector2 force = one.B * (one.w - (position(one.joints[1]) - position(one.joints[0])));
    result.force = {Vector2(-force), force, Vector2(Vector2::Zero())};
    result.stiffness[0][0] = result.stiffness[1][1] = one.B;
    result.stiffness[0][1] = result.stiffness[1][0] = -one.B;
    return result;
  }
  const Strain strain = strain_of(*this, one);
  for (std::size_t n = 0; n < 3; ++n) {
    result.force[n] = one.k * strain.value * strain.gradient[n];
    for (std::size_t m = 0; m < 3; ++m) {
      result.stiffness[n][m] = one.k * strain.gradient[n] * strain.gradient[m].transpose();
    }
  }
  return result;
}

}  // namespace trussmap::truss
