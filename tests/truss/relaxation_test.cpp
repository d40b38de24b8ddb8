// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Relaxation against dense solutions in 40 digits made elsewhere (tests/reference/relaxation.json),
// and what must hold of it whatever the truss: energy falls, and is least where all joints are
// free.
#include "truss/relaxation.hpp"

#include "geometry/index.hpp"
#include "json_matrix.hpp"
#include "shared_data.hpp"
#include "truss/elastic_truss.hpp"
#include "truss/equilibrium.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::relaxation_test {
using namespace truss;
namespace {

using nlohmann::json;
using testing::matrix;
using testing::vector2;

StiffnessLaw law_of(const json& c) {
  return c["law"] == "variance" ? StiffnessLaw::variance : StiffnessLaw::mean_error;
}

ElasticTruss truss_of(const json& c) {
  ElasticTruss truss;
  for (const json& node : c["nodes"]) truss.add_joint(vector2(node));
  const StiffnessLaw law = law_of(c);
  const bool corners = c.contains("corners");
  std::map<std::pair<int, int>, double> stretch;
  for (const json& bar : c["bars"]) {
    const int i = bar["i"];
    const int j = bar["j"];
    if (corners) {
      stretch[{i, j}] = stretch[{j, i}] = bar["stretch"];
      truss.add_element(
          length_element(i, j, spring_stiffness(law, bar["variance"], bar["t"]), bar["stretch"]));
    } else {
      truss.add_element(bar_element(
          i, j, bar_stiffness(law, matrix<2, 2>(bar["C"]), bar["orientation"], bar["t"]),
          vector2(bar["rest"])));
    }
  }
  if (!corners) return truss;
  for (const json& one : c["corners"]) {
    const int i = one["i"];
    const int j = one["j"];
    const int k = one["k"];
    const double arm = 0.5 * (stretch.at({i, j}) + stretch.at({j, k}));
    truss.add_element(corner_element(i, j, k, spring_stiffness(law, one["variance"], one["t"], arm),
                                     one["angle"]));
  }
  for (const json& one : c["grounded"]) {
    const int i = one["i"];
    const int j = one["j"];
    const double k = spring_stiffness(law, one["variance"], one["t"], stretch.at({i, j}));
    truss.add_element(direction_element(i, j, k, one["orientation"]));
  }
  return truss;
}

std::vector<FreeJoint> each_alone(const std::vector<int>& joints) {
  std::vector<FreeJoint> free;
  for (const int joint : joints) free.push_back({joint, static_cast<int>(free.size())});
  return free;
}

void expect_reference(const ElasticTruss& found, const json& c, double tolerance) {
  double largest = 0.0;
  for (std::size_t n = 0; n < c["nodes"].size(); ++n) {
    largest = std::max(largest, (vector2(c["nodes_after"][n]) - vector2(c["nodes"][n])).norm());
  }
  for (std::size_t n = 0; n < c["nodes"].size(); ++n) {
    EXPECT_LE((found.position(static_cast<int>(n)) - vector2(c["nodes_after"][n])).norm(),
              tolerance * largest)
        << c["name"] << ", node " << n;
  }
  const double energy = c["energy_after"];
  EXPECT_NEAR(found.energy(), energy, 1e-9 * c["energy_before"].get<double>() + 1e-12 * energy);
}

std::vector<testing::Case> references() {
  std::vector<testing::Case> all = testing::cases("relaxation.json", "bar_cases");
  for (const testing::Case& one : testing::cases("relaxation.json", "corner_cases")) {
    all.push_back({all.size(), one.content});
  }
  return all;
}

TEST(RelaxationReference, JointsComeToTheSameEquilibrium) {
  testing::for_each(references(), [](const nlohmann::json& c) {
    const bool ill = c["name"].get<std::string>().find("by 10000") != std::string::npos;
    ElasticTruss truss = truss_of(c);
    EXPECT_NEAR(truss.energy(), c["energy_before"], 1e-9 * c["energy_before"].get<double>());
    const std::vector<int> joints = c["free"];
    Relaxation().relax(truss, each_alone(joints), 1);
    expect_reference(truss, c, ill ? 1e-6 : 1e-9);
    if (std::ssize(joints) + 1 != truss.joints()) return;  // joint 0 alone is held
    ElasticTruss whole = truss_of(c);
    Equilibrium().relax(whole);
    expect_reference(whole, c, ill ? 1e-6 : 1e-9);
  });
}

Matrix2 random_stiffness(std::mt19937_64& random, double ratio) {
  std::normal_distribution<double> normal;
  const Matrix2 R = rotation(normal(random));
  const Matrix2 B = R * Vector2(100.0, 100.0 / ratio).asDiagonal() * R.transpose();
  return 0.5 * (B + B.transpose());
}

/// A wandering truss of bars, lengths, corners and directions, none at rest.
ElasticTruss random_truss(int joints, bool bars_alone, double ratio, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ElasticTruss truss;
  truss.add_joint(Vector2::Zero());
  const auto tie = [&](int i, int j) {
    const Vector2 d = truss.position(j) - truss.position(i);
    if (bars_alone) {
      truss.add_element(bar_element(i, j, random_stiffness(random, ratio),
                                    d + 0.1 * Vector2(normal(random), normal(random))));
      return;
    }
    truss.add_element(length_element(i, j, 100.0 * ratio, d.norm() + 0.01 * normal(random)));
    truss.add_element(direction_element(i, j, 30.0, direction(d) + 0.05 * normal(random)));
  };
  for (int k = 1; k < joints; ++k) {
    truss.add_joint(Vector2(3.0 * (k % 5), 3.0 * (k / 5)) +
                    0.3 * Vector2(normal(random), normal(random)));
    tie(k - 1, k);
    if (k >= 5) tie(k - 5, k);
    if (!bars_alone && k >= 2) {
      const double angle = direction(truss.position(k) - truss.position(k - 1)) -
                           direction(truss.position(k - 1) - truss.position(k - 2));
      truss.add_element(corner_element(k - 2, k - 1, k, 500.0, angle + 0.02 * normal(random)));
    }
  }
  return truss;
}

/// The minimum by dense Gauss-Newton steps of the whole.
double least_energy(ElasticTruss truss) {
  const int n = 2 * truss.joints();
  for (int round = 0; round < 100; ++round) {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
    for (int number = 0; number < truss.elements(); ++number) {
      const Tangent tangent = truss.tangent(number);
      const Element& one = truss.element(number);
      for (int a = 0; a < one.count(); ++a) {
        f.segment<2>(2 * one.joints[idx(a)]) += tangent.force[idx(a)];
        for (int b = 0; b < one.count(); ++b) {
          K.block<2, 2>(2 * one.joints[idx(a)], 2 * one.joints[idx(b)]) +=
              tangent.stiffness[idx(a)][idx(b)];
        }
      }
    }
    const Eigen::VectorXd u = K.bottomRightCorner(n - 2, n - 2).ldlt().solve(f.tail(n - 2));
    for (int k = 1; k < truss.joints(); ++k) {
      truss.move(k, truss.position(k) + u.segment<2>(2 * (k - 1)));
    }
  }
  return truss.energy();
}

std::vector<int> all_but_first(const ElasticTruss& truss) {
  std::vector<int> joints;
  for (int k = 1; k < truss.joints(); ++k) joints.push_back(k);
  return joints;
}

TEST(Relaxation, OfAllJointsEndsInTheLeastEnergy) {
  for (const bool bars_alone : {true, false}) {
    for (const double ratio : {1.0, 30.0, 1e4}) {
      const ElasticTruss truss = random_truss(28, bars_alone, ratio, 7);
      const double least = least_energy(truss);
      ElasticTruss patch = truss;
      Relaxation().relax(patch, each_alone(all_but_first(truss)), 1);
      EXPECT_NEAR(patch.energy(), least, 1e-9 * least) << ratio;
      ElasticTruss whole = truss;
      Equilibrium().relax(whole);
      EXPECT_NEAR(whole.energy(), least, 1e-9 * least) << ratio;
      EXPECT_LE(least, truss.energy());
    }
  }
}

/// Joints alone, blocks moved as one, blocks sheared: each step lowers the energy, more modes lower
/// it more, and a block of one joint is that joint alone.
TEST(Relaxation, OverBlocksLowersTheEnergy) {
  for (const bool bars_alone : {true, false}) {
    const ElasticTruss truss = random_truss(31, bars_alone, 50.0, 8);
    double last = truss.energy();
    for (const int modes : {1, 3}) {
      std::vector<FreeJoint> free;
      for (int k = 1; k < truss.joints(); ++k) {
        const Vector2 at = 0.1 * truss.position(k);
        free.push_back({k, (k - 1) / 6, {1.0, at.x(), at.y()}});
      }
      ElasticTruss moved = truss;
      Relaxation().relax(moved, free, modes);
      EXPECT_LT(moved.energy(), last) << modes;
      last = moved.energy();
    }
  }
}

TEST(Relaxation, WhatNothingHoldsStaysWhereItIs) {
  ElasticTruss truss;
  for (int k = 0; k < 4; ++k) truss.add_joint({1.0 * k, 0.5 * k * k});
  truss.add_element(length_element(0, 1, 100.0, 2.0));  // joint 1 may turn about joint 0
  const Vector2 lonely = truss.position(3);             // joints 2 and 3 are tied to nothing
  truss.add_element(bar_element(2, 3, 100.0 * Matrix2::Identity(), Vector2(1.0, 1.0)));
  const double before = truss.energy();
  Relaxation().relax(truss, each_alone({1, 2, 3}), 1);
  EXPECT_LT(truss.energy(), 1e-9 * before);
  EXPECT_TRUE(truss.position(1).allFinite());
  EXPECT_LE((truss.position(3) - lonely).norm(), 3.0);
  EXPECT_NEAR(truss.position(1).norm(), 2.0, 1e-9);
}

TEST(ElasticTruss, TakesBackWhatCameSinceItBegan) {
  ElasticTruss truss = random_truss(9, false, 3.0, 9);
  const double energy = truss.energy();
  const int elements = truss.elements();
  truss.begin();
  truss.add_joint({1.0, 2.0});
  truss.add_element(length_element(3, 9, 5.0, 1.0));
  truss.set_element(0, length_element(0, 1, 7.0, 9.0));
  truss.set_element(0, length_element(0, 1, 8.0, 9.0));
  truss.move(4, {9.0, 9.0});
  truss.move(4, {8.0, 9.0});
  truss.roll_back();
  EXPECT_EQ(truss.joints(), 9);
  EXPECT_EQ(truss.elements(), elements);
  EXPECT_EQ(truss.energy(), energy);
  for (const int number : truss.elements_at(3)) EXPECT_LT(number, elements);
}

/// Joints and elements come, elements change: the live factor's equilibrium is that of a new one.
TEST(Equilibrium, TheLiveFactorEqualsANewOneAtEveryStep) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const auto draw = [&random](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  for (const bool bars_alone : {true, false}) {
    ElasticTruss truss = random_truss(12, bars_alone, 5.0, 10);
    Equilibrium live;
    live.relax(truss);
    for (int step = 0; step < 300; ++step) {
      const int joints = truss.joints();
      const int what = draw(3);
      const int i = draw(joints);
      const int j = draw(joints);
      const int before = truss.elements();
      if (what == 0) {
        truss.add_joint(truss.position(i) + 2.0 * Vector2(normal(random), normal(random)));
        truss.add_element(bar_element(i, joints, random_stiffness(random, 5.0),
                                      Vector2(normal(random), normal(random))));
      } else if (what == 1 && i != j) {
        truss.add_element(bar_element(
            i, j, random_stiffness(random, 5.0),
            truss.position(j) - truss.position(i) + 0.1 * Vector2(normal(random), normal(random))));
      } else {
        const int number = draw(truss.elements());
        Element changed = truss.element(number);
        changed.B *= 1.5;
        changed.k *= 0.7;
        changed.rest += 0.01;
        truss.set_element(number, changed);
        live.changed(number);
      }
      for (int number = before; number < truss.elements(); ++number) live.changed(number);
      ElasticTruss twin = truss;
      live.relax(truss);
      Equilibrium().relax(twin);
      const double scale = 1e-9 * (1.0 + twin.energy());
      ASSERT_NEAR(truss.energy(), twin.energy(), scale) << step;
    }
    EXPECT_GT(truss.joints(), 60);
    // What the live factor says of a pull is what a new one says.
    const Vector2 force(2.0, 1.0);
    const std::vector<std::pair<int, Vector2>> pull{{3, -force}, {40, force}};
    const std::vector<Vector2> u = live.displacements(truss, pull);
    const std::vector<Vector2> fresh = Equilibrium().displacements(truss, pull);
    for (std::size_t k = 0; k < u.size(); ++k) {
      EXPECT_LE((u[k] - fresh[k]).norm(), (bars_alone ? 1e-9 : 1e-2) * fresh[40].norm());
    }
  }
}

}  // namespace
}  // namespace trussmap::relaxation_test
