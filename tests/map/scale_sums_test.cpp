// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Groups that move by their sums, against the same done landmark by landmark: a dense minimisation
// of the energy over the groups' six numbers each, as the landmarks lie.
#include "map/scale_sums.hpp"

#include "geometry/index.hpp"
#include "map/scale_groups.hpp"
#include "truss/elastic_truss.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::scale_sums_test {
using namespace map;
using namespace truss;
namespace {

/// Landmarks met on a random way over a grid, bars where routes are, and groups along the way.
class World {
 public:
  World(int side, unsigned seed, const Vector2& origin) : random_(seed) {
    std::vector<int> number(idx(side * side), -1);
    int at = 0;
    number[0] = truss.add_joint(origin);
    groups.add(0, -1);
    std::set<std::pair<int, int>> driven;
    for (int k = 0; k < 12 * side * side; ++k) {
      const int x = at % side;
      const int y = at / side;
      const int dx = random_() % 2 == 0 ? 1 : -1;
      const bool across = random_() % 2 == 0;
      const int nx = across ? x + dx : x;
      const int ny = across ? y : y + dx;
      if (nx < 0 || ny < 0 || nx >= side || ny >= side) continue;
      const int to = ny * side + nx;
      const bool fresh = number[idx(to)] < 0;
      if (fresh) {
        number[idx(to)] = truss.add_joint(origin + Vector2(nx, ny) + noise(0.2));
        groups.add(number[idx(to)], number[idx(at)]);
      }
      if (driven.insert(std::minmax(at, to)).second) {
        truss.add_element(bar_element(number[idx(at)], number[idx(to)], stiffness(),
                                      Vector2(nx - x, ny - y) + noise(0.05)));
        groups.tie(number[idx(at)], number[idx(to)]);
      }
      at = to;
    }
  }

  Vector2 noise(double sd) { return {sd * normal_(random_), sd * normal_(random_)}; }
  Matrix2 stiffness() {
    const Matrix2 root = (Matrix2() << 3.0 + normal_(random_), normal_(random_), normal_(random_),
                          6.0 + normal_(random_))
                             .finished();
    return root * root.transpose() + 0.1 * Matrix2::Identity();
  }
  int any(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

  ElasticTruss truss;
  ScaleGroups groups;

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

std::vector<Vector2> positions_of(const ScaleSums& sums, const ElasticTruss& truss) {
  std::vector<Vector2> positions;
  for (int k = 0; k < truss.joints(); ++k) positions.push_back(sums.position(truss, k));
  return positions;
}

double energy_at(const ElasticTruss& truss, const std::vector<Vector2>& positions) {
  double sum = 0.0;
  for (int number = 0; number < truss.elements(); ++number) {
    const Element& bar = truss.element(number);
    const Vector2 off = positions[idx(bar.joints[1])] - positions[idx(bar.joints[0])] - bar.w;
    sum += 0.5 * off.dot(bar.B * off);
  }
  return sum;
}

/// Every landmark visited: the least energy over the numbers of each free group, two per mode.
std::vector<Vector2> by_landmarks(const World& world, int level, const std::vector<int>& free,
                                  const std::vector<Vector2>& positions) {
  const int unknowns = 6 * static_cast<int>(free.size());
  std::vector<Eigen::MatrixXd> P(positions.size(), Eigen::MatrixXd::Zero(2, unknowns));
  for (std::size_t n = 0; n < free.size(); ++n) {
    std::vector<int> members;
    world.groups.members(level, free[n], members);
    Vector2 mean = Vector2::Zero();
    for (const int k : members) mean += positions[idx(k)] / static_cast<double>(members.size());
    Matrix2 spread = Matrix2::Zero();
    for (const int k : members) {
      spread += (positions[idx(k)] - mean) * (positions[idx(k)] - mean).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix2> axes(spread);
    const Vector2 squares = axes.eigenvalues();
    const bool thin =
        !(squares[0] > ScaleSums::kThinnest * ScaleSums::kThinnest * squares[1] + 1e-12);
    for (const int k : members) {
      const Vector2 off = axes.eigenvectors().transpose() * (positions[idx(k)] - mean);
      const Eigen::Vector3d c(1.0, off[1], thin ? 0.0 : off[0]);
      for (int m = 0; m < 3; ++m) {
        P[idx(k)].block<2, 2>(0, 6 * static_cast<int>(n) + 2 * m) = c[m] * Matrix2::Identity();
      }
    }
  }
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(unknowns);
  for (int number = 0; number < world.truss.elements(); ++number) {
    const Element& bar = world.truss.element(number);
    const Eigen::MatrixXd D = P[idx(bar.joints[1])] - P[idx(bar.joints[0])];
    const Vector2 d = positions[idx(bar.joints[1])] - positions[idx(bar.joints[0])];
    K += D.transpose() * bar.B * D;
    f += D.transpose() * bar.B * (bar.w - d);
  }
  const Eigen::VectorXd scale = K.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-9);
  solver.compute(scale.asDiagonal() * K * scale.asDiagonal());
  const Eigen::VectorXd q = scale.asDiagonal() * solver.solve(scale.asDiagonal() * f);
  std::vector<Vector2> result = positions;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] += P[k] * q;
  return result;
}

/// One correction after another: landmarks move by themselves, bars change, groups follow.
void expect_the_same(int side, unsigned seed, int corrections, const Vector2& origin) {
  World world(side, seed, origin);
  ScaleSums sums;
  sums.follow(world.groups, world.truss);
  ASSERT_GT(world.groups.levels(), ScaleSums::kFinest + 1);
  for (int k = 0; k < corrections; ++k) {
    world.truss.begin();
    sums.begin();
    const int place = 1 + world.any(world.truss.joints() - 1);
    sums.look(world.truss, place);
    world.truss.move(place, world.truss.position(place) + world.noise(0.1));
    sums.touch(place);
    Element bar = world.truss.element(world.any(world.truss.elements()));
    const int number = world.any(world.truss.elements());
    bar = world.truss.element(number);
    bar.B = world.stiffness();
    bar.w += world.noise(0.05);
    world.truss.set_element(number, bar);
    for (int n = 0; n < 2; ++n) sums.touch(bar.joints[idx(n)]);
    const Vector2 middle = sums.position(world.truss, place);
    for (int level = ScaleSums::kFinest; level < world.groups.levels(); ++level) {
      sums.take_sums(level, world.truss);
      const std::vector<int> free = world.groups.nearest(level, place, place, 5, [&](int landmark) {
        return (sums.position(world.truss, landmark) - middle).squaredNorm();
      });
      const std::vector<Vector2> before = positions_of(sums, world.truss);
      const double gain = sums.relax(level, free, world.truss);
      const std::vector<Vector2> after = positions_of(sums, world.truss);
      const std::vector<Vector2> expected = by_landmarks(world, level, free, before);
      const double then = energy_at(world.truss, before);
      const double least = energy_at(world.truss, expected);
      ASSERT_NEAR(energy_at(world.truss, after), least, 1e-9 * then) << k << " level " << level;
      ASSERT_NEAR(gain, then - least, 1e-9 * then);
      double off = 0.0;
      for (std::size_t n = 0; n < after.size(); ++n) {
        off = std::max(off, (after[n] - expected[n]).norm());
      }
      ASSERT_LE(off, 1e-7) << k << " level " << level;
    }
  }
}

TEST(ScaleSums, AStepIsThatOfAllTheLandmarksInTheGroups) {
  expect_the_same(7, 1, 40, Vector2::Zero());
  expect_the_same(12, 2, 12, Vector2(300.0, -200.0));
}

TEST(SlowScaleSums, AStepIsThatOfAllTheLandmarksInTheGroups) {
  for (unsigned seed = 10; seed < 20; ++seed) expect_the_same(9, seed, 60, Vector2::Zero());
}

TEST(ScaleSums, FindWhatIsNearest) {
  World world(14, 5, Vector2::Zero());
  ScaleSums sums;
  sums.follow(world.groups, world.truss);
  for (int k = 0; k < 60; ++k) {
    const int place = 1 + world.any(world.truss.joints() - 1);
    sums.look(world.truss, place);
    world.truss.move(place, world.truss.position(place) + world.noise(1.0));
    sums.touch(place);
    if (k % 3 != 1) {
      for (int level = ScaleSums::kFinest; level < world.groups.levels(); ++level) {
        sums.take_sums(level, world.truss);
        sums.relax(level, {world.groups.group_of(level, place)}, world.truss);
      }
    }
    const std::vector<Vector2> positions = positions_of(sums, world.truss);
    const Vector2 point = Vector2(7.0, 7.0) + world.noise(6.0);
    for (const int count : {1, 5, 40}) {
      std::vector<int> order(positions.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return (positions[idx(a)] - point).norm() < (positions[idx(b)] - point).norm();
      });
      order.resize(idx(count));
      std::sort(order.begin(), order.end());
      EXPECT_EQ(sums.nearest(world.truss, point, count), order) << k;
    }
  }
}

TEST(ScaleSums, WhatIsTakenBackOrSettledIsWhereItWas) {
  World world(8, 7, Vector2(10.0, 5.0));
  ScaleSums sums;
  sums.follow(world.groups, world.truss);
  for (int k = 0; k < 20; ++k) {
    world.truss.begin();
    sums.begin();
    const std::vector<Vector2> before = positions_of(sums, world.truss);
    const int place = 1 + world.any(world.truss.joints() - 1);
    sums.look(world.truss, place);
    world.truss.move(place, world.truss.position(place) + world.noise(0.5));
    sums.touch(place);
    for (int level = ScaleSums::kFinest; level < world.groups.levels(); ++level) {
      sums.take_sums(level, world.truss);
      sums.relax(level, {world.groups.group_of(level, place)}, world.truss);
    }
    std::vector<Vector2> expected = positions_of(sums, world.truss);
    if (k % 2 == 0) {
      EXPECT_GT((expected[idx(place)] - before[idx(place)]).norm(), 1e-4);
      expected = before;
      world.truss.roll_back();
      sums.roll_back();
    }
    if (k % 4 != 3) sums.settle(world.truss);
    for (int n = 0; n < world.truss.joints(); ++n) {
      EXPECT_LE((sums.position(world.truss, n) - expected[idx(n)]).norm(), 1e-11) << k;
    }
    if (k % 4 != 3) sums.follow(world.groups, world.truss);
  }
}

}  // namespace
}  // namespace trussmap::scale_sums_test
