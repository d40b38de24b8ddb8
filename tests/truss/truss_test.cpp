// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The stiffness method's laws, on random trusses (seeds stated).
#include "trussmap/truss.hpp"

#include "geometry/index.hpp"

#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::truss_test {
namespace {

struct RandomTruss {
  int joints = 0;
  std::vector<Bar> bars;
  std::vector<Load> loads;
};

Matrix2 random_stiffness(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.1, 10.0);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  const Matrix2 R = rotation(angle(random));
  return R * Vector2(uniform(random), uniform(random)).asDiagonal() * R.transpose();
}

/// A random tree with as many further bars, and a load on every joint.
RandomTruss random_truss(int joints, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  RandomTruss truss;
  truss.joints = joints;
  for (int j = 1; j < joints; ++j) {
    const int i = std::uniform_int_distribution<int>(0, j - 1)(random);
    truss.bars.push_back({i, j, random_stiffness(random)});
  }
  for (int n = 0; n < joints; ++n) {
    const int i = std::uniform_int_distribution<int>(0, joints - 2)(random);
    truss.bars.push_back({i, i + 1, random_stiffness(random)});
    truss.loads.push_back({n, Vector2(normal(random), normal(random))});
  }
  return truss;
}

Eigen::MatrixXd dense_stiffness(const RandomTruss& truss) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * truss.joints, 2 * truss.joints);
  for (const Bar& bar : truss.bars) {
    const Eigen::Matrix4d B = bar_matrix(bar.stiffness);
    const int at[2] = {2 * bar.i, 2 * bar.j};
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        K.block<2, 2>(at[r], at[c]) += B.block<2, 2>(2 * r, 2 * c);
      }
    }
  }
  return K;
}

Eigen::VectorXd stacked(const std::vector<Vector2>& u) {
  Eigen::VectorXd result(2 * static_cast<Eigen::Index>(u.size()));
  for (std::size_t k = 0; k < u.size(); ++k) {
    result.segment<2>(2 * static_cast<Eigen::Index>(k)) = u[k];
  }
  return result;
}

class TrussLaws : public ::testing::TestWithParam<unsigned> {};

TEST_P(TrussLaws, SparseEqualsDenseAndReactionsBalanceLoads) {
  const RandomTruss truss = random_truss(30, GetParam());
  const Deflection found = solve_truss(
      truss.joints, truss.bars, {{3, Vector2::Zero()}, {7, Vector2(0.3, -0.1)}}, truss.loads);
  const Eigen::MatrixXd K = dense_stiffness(truss);
  const Eigen::VectorXd u = stacked(found.displacements);
  const Eigen::VectorXd out = K * u;
  Vector2 load = Vector2::Zero();
  Vector2 reaction = Vector2::Zero();
  for (int n = 0; n < truss.joints; ++n) {
    const Vector2 f = truss.loads[idx(n)].force;
    EXPECT_LE((out.segment<2>(2 * n) - f - found.reactions[idx(n)]).norm(), 1e-10);
    if (n != 3 && n != 7) {
      EXPECT_LE(found.reactions[idx(n)].norm(), 1e-10);
    }
    load += f;
    reaction += found.reactions[idx(n)];
  }
  EXPECT_LE((load + reaction).norm(), 1e-9);
  EXPECT_NEAR(found.strain_energy, 0.5 * u.dot(out), 1e-9);
}

TEST_P(TrussLaws, EnergyIsHalfTheWorkOfTheLoadsOnAHeldTruss) {
  const RandomTruss truss = random_truss(25, GetParam());
  const Deflection found =
      solve_truss(truss.joints, truss.bars, {{0, Vector2::Zero()}}, truss.loads);
  double work = 0.0;
  for (const Load& load : truss.loads) work += load.force.dot(found.displacements[idx(load.joint)]);
  EXPECT_NEAR(found.strain_energy, 0.5 * work, 1e-9 * work);
}

TEST_P(TrussLaws, TheFloatingTrussIsThePseudoInverse) {
  const RandomTruss truss = random_truss(12, GetParam());
  const Deflection found = solve_floating_truss(truss.joints, truss.bars, truss.loads);
  Eigen::VectorXd f(2 * truss.joints);
  for (int n = 0; n < truss.joints; ++n) f.segment<2>(2 * n) = truss.loads[idx(n)].force;
  const Eigen::VectorXd u =
      dense_stiffness(truss).completeOrthogonalDecomposition().pseudoInverse() * f;
  EXPECT_LE((stacked(found.displacements) - u).norm(), 1e-9);
}

TEST_P(TrussLaws, ANewBarNeverSoftens) {
  RandomTruss truss = random_truss(20, GetParam());
  const auto energy = [&truss] {
    return solve_truss(truss.joints, truss.bars, {{0, Vector2::Zero()}}, truss.loads).strain_energy;
  };
  const double before = energy();
  std::mt19937_64 random(GetParam() + 1000);
  truss.bars.push_back({4, 17, random_stiffness(random)});
  EXPECT_LE(energy(), before * (1.0 + 1e-12));
}

TEST_P(TrussLaws, JointOrderIsIrrelevant) {
  const RandomTruss truss = random_truss(15, GetParam());
  RandomTruss mirrored = truss;
  const auto image = [&truss](int joint) { return truss.joints - 1 - joint; };
  for (Bar& bar : mirrored.bars) bar = {image(bar.j), image(bar.i), bar.stiffness};
  for (Load& load : mirrored.loads) load.joint = image(load.joint);
  const auto u = solve_truss(15, truss.bars, {{2, Vector2::Zero()}}, truss.loads);
  const auto v = solve_truss(15, mirrored.bars, {{image(2), Vector2::Zero()}}, mirrored.loads);
  for (int n = 0; n < 15; ++n) {
    EXPECT_LE((u.displacements[idx(n)] - v.displacements[idx(image(n))]).norm(), 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, TrussLaws, ::testing::Range(1U, 9U));

TEST(Truss, TranslationCostsNoEnergy) {
  const RandomTruss truss = random_truss(10, 5);
  const Vector2 move(0.7, -2.0);
  const Deflection found = solve_truss(truss.joints, truss.bars, {{4, move}}, {});
  for (const Vector2& u : found.displacements) EXPECT_LE((u - move).norm(), 1e-11);
  EXPECT_NEAR(found.strain_energy, 0.0, 1e-20);
}

TEST(Truss, AJointTiedToNoSupportIsNamed) {
  const Matrix2 B = Matrix2::Identity();
  try {
    (void)solve_truss(4, {{0, 1, B}, {2, 3, B}}, {{0, Vector2::Zero()}}, {});
    FAIL() << "nothing was thrown";
  } catch (const UnsupportedJoint& error) {
    EXPECT_EQ(error.joint(), 2);
    EXPECT_STREQ(error.what(), "joint 2 is tied to no support");
  }
}

TEST(Truss, AJointThatCanSlideIsNamed) {
  const Matrix2 axial = (Matrix2() << 1.0, 0.0, 0.0, 0.0).finished();
  try {
    (void)solve_truss(3, {{0, 1, Matrix2::Identity()}, {1, 2, axial}}, {{0, Vector2::Zero()}}, {});
    FAIL() << "nothing was thrown";
  } catch (const UnsupportedJoint& error) {
    EXPECT_EQ(error.joint(), 2);
  }
}

TEST(Truss, RefusesWhatIsNoTruss) {
  const Matrix2 B = Matrix2::Identity();
  const std::vector<Support> held{{0, Vector2::Zero()}};
  EXPECT_THROW((void)solve_truss(2, {{0, 2, B}}, held, {}), std::invalid_argument);
  EXPECT_THROW((void)solve_truss(2, {{1, 1, B}}, held, {}), std::invalid_argument);
  EXPECT_THROW((void)solve_truss(2, {{0, 1, B}}, {held[0], held[0]}, {}), std::invalid_argument);
  EXPECT_THROW((void)solve_truss(2, {{0, 1, B}}, held, {{5, Vector2::Zero()}}),
               std::invalid_argument);
  EXPECT_THROW((void)bar_stiffness(StiffnessLaw::mean_error, Matrix2::Zero(), 0.0, 1.0),
               std::invalid_argument);
  EXPECT_THROW((void)bar_stiffness(StiffnessLaw::variance, -B, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW((void)bar_stiffness(StiffnessLaw::mean_error, B, 0.0, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::truss_test
