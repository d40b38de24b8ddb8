// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The library's own factorisation against dense algebra and against CHOLMOD.
#include "linalg/frontal_cholesky.hpp"

#include "linalg/block_system.hpp"
#include "linalg/dissection.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::frontal_cholesky_test {
using namespace linalg;
namespace {

/// Nodes in the plane, each tied to some near ones; sizes of 1 to `largest` unknowns.
struct Mesh {
  std::vector<Vector2> positions;
  std::vector<int> sizes;
  std::vector<NodePair> pairs;
};

Mesh square_mesh(int side, int largest, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  Mesh mesh;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int node = y * side + x;
      mesh.positions.emplace_back(x + jitter(random), y + jitter(random));
      mesh.sizes.push_back(1 + static_cast<int>(random() % static_cast<unsigned>(largest)));
      if (x > 0) mesh.pairs.push_back({node, node - 1});
      if (y > 0) mesh.pairs.push_back({node - side, node});
      if (x > 0 && y > 0 && random() % 4 == 0) mesh.pairs.push_back({node, node - side - 1});
    }
  }
  return mesh;
}

/// No planar structure at all: a tree with chords anywhere, and some nodes on their own.
Mesh wild_mesh(int nodes, int chords, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&random](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  Mesh mesh;
  for (int k = 0; k < nodes; ++k) {
    mesh.positions.emplace_back(draw(100), draw(100));
    mesh.sizes.push_back(1 + draw(3));
    if (k > 0 && draw(10) > 0) mesh.pairs.push_back({k, draw(k)});
  }
  for (int k = 0; k < chords; ++k) mesh.pairs.push_back({draw(nodes), draw(nodes)});
  return mesh;
}

/// Fills the lower triangle with random numbers, dominated by the diagonal.
SparseMatrix random_values(const SparseMatrix& pattern, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  SparseMatrix result = pattern;
  Eigen::VectorXd sums = Eigen::VectorXd::Ones(result.rows());
  for (int c = 0; c < result.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(result, c); it; ++it) {
      it.valueRef() = it.row() == c ? 0.0 : uniform(random);
      sums[it.row()] += std::abs(it.value());
      sums[c] += std::abs(it.value());
    }
  }
  for (int c = 0; c < result.outerSize(); ++c) result.coeffRef(c, c) = sums[c];
  return result;
}

struct Case {
  FrontalCholesky cholesky;
  SparseMatrix lower;
  std::vector<int> sizes;  ///< in the tree's order
};

std::vector<int> places_in(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[idx(order[k])] = static_cast<int>(k);
  return place;
}

Case factored(const Mesh& mesh, const std::vector<int>& order, unsigned seed) {
  std::vector<int> sizes;
  for (const int node : order) sizes.push_back(mesh.sizes[idx(node)]);
  FrontTree tree =
      plan_fronts(pattern_of(mesh.pairs, places_in(order), static_cast<int>(order.size())), sizes);
  Case result;
  std::vector<int> by_fronts;
  for (const int k : tree.order) {
    by_fronts.push_back(order[idx(k)]);
    result.sizes.push_back(sizes[idx(k)]);
  }
  // CHOLMOD's system keeps the order that it is given.
  const BlockSystem system(mesh.sizes, mesh.pairs, by_fronts, Kernel::cholmod);
  result.lower = random_values(system.matrix(), seed);
  result.cholesky = FrontalCholesky(std::move(tree), result.sizes);
  result.cholesky.factorise(result.lower);
  return result;
}

std::vector<int> as_they_come(const Mesh& mesh) {
  std::vector<int> order(mesh.sizes.size());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

void expect_like_dense(const Mesh& mesh, const std::vector<int>& order, unsigned seed) {
  const Case c = factored(mesh, order, seed);
  const Eigen::MatrixXd A = Eigen::MatrixXd(c.lower).selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), -1.0, 2.0);
  const Eigen::LLT<Eigen::MatrixXd> dense(A);
  Eigen::VectorXd x = b;
  c.cholesky.solve_in_place(x);
  EXPECT_LT((x - dense.solve(b)).norm(), 1e-13 * x.norm() * static_cast<double>(A.rows()));
  const Eigen::MatrixXd L = dense.matrixL();
  EXPECT_NEAR(c.cholesky.log_determinant(), 2.0 * L.diagonal().array().log().sum(),
              1e-12 * static_cast<double>(A.rows()));

  const Eigen::MatrixXd inverse = A.inverse();
  const Eigen::MatrixXd blocks = c.cholesky.inverse_blocks();
  int begin = 0;
  for (const int size : c.sizes) {
    EXPECT_LT((blocks.block(0, begin, size, size) - inverse.block(begin, begin, size, size))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-13);
    begin += size;
  }
}

/// Many right sides at once, entries of the inverse, and products with columns of few entries.
void expect_inverse_like_dense(const Mesh& mesh, const std::vector<int>& order, unsigned seed) {
  const Case c = factored(mesh, order, seed);
  const Eigen::MatrixXd A = Eigen::MatrixXd(c.lower).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd inverse = A.inverse();
  const double accuracy = 1e-13 * static_cast<double>(A.rows());
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const Eigen::Index columns : {1, 7, 8, 45}) {
    Eigen::MatrixXd X(A.rows(), columns);
    for (double& value : X.reshaped()) value = uniform(random);
    const Eigen::MatrixXd expected = inverse * X;
    Eigen::MatrixXd together = X;
    c.cholesky.solve_columns(together);
    EXPECT_LT((together - expected).cwiseAbs().maxCoeff(), accuracy);
    // A column is the same to the last digit, whatever stands beside it.
    Eigen::MatrixXd last = X.rightCols(1);
    c.cholesky.solve_columns(last);
    EXPECT_EQ((together.rightCols(1) - last).cwiseAbs().maxCoeff(), 0.0);
  }

  const FrontalInverse entries = c.cholesky.inverse();
  std::vector<int> begin{0};
  for (const int size : c.sizes) begin.push_back(begin.back() + size);
  for (std::size_t a = 0; a < c.sizes.size(); ++a) {
    for (std::size_t b = 0; b < c.sizes.size(); ++b) {
      const auto coupling = A.block(begin[a], begin[b], c.sizes[a], c.sizes[b]);
      if (coupling.isZero(0.0)) continue;
      EXPECT_LT((entries.block(begin[a], c.sizes[a], begin[b], c.sizes[b]) -
                 inverse.block(begin[a], begin[b], c.sizes[a], c.sizes[b]))
                    .cwiseAbs()
                    .maxCoeff(),
                accuracy);
    }
  }

  constexpr int kColumns = 11;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(A.rows(), kColumns);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int k = 0; k < 3 * kColumns; ++k) {
    const int row = static_cast<int>(random() % static_cast<unsigned>(A.rows()));
    triplets.emplace_back(row, k % kColumns, uniform(random));
    B(row, k % kColumns) += triplets.back().value();
  }
  EXPECT_LT((c.cholesky.inverse_products(triplets, kColumns) - B.transpose() * inverse * B)
                .cwiseAbs()
                .maxCoeff(),
            accuracy);
}

TEST(FrontalCholesky, HasTheInverseOfADenseMatrix) {
  for (const int side : {1, 2, 7, 12}) {
    const Mesh mesh = square_mesh(side, 4, static_cast<unsigned>(side));
    expect_inverse_like_dense(mesh, dissection_order(mesh.positions, mesh.pairs), 1);
    expect_inverse_like_dense(mesh, as_they_come(mesh), 2);
  }
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Mesh mesh = wild_mesh(60, 30, seed);
    expect_inverse_like_dense(mesh, as_they_come(mesh), seed);
  }
  // Fronts large enough for BLAS.
  const Mesh dense = wild_mesh(130, 3000, 3);
  expect_inverse_like_dense(dense, as_they_come(dense), 3);
}

TEST(FrontalCholesky, HasTheInverseInFrontsOfSeveralBlocks) {
  // Two parts that only a border joins, everything coupled otherwise: fronts of 202 to 230 columns
  // above the border's rows, and the border's.
  for (const int part : {101, 110, 115}) {
    constexpr int kBorder = 20;
    Mesh mesh;
    for (int k = 0; k < 2 * part + kBorder; ++k) {
      mesh.positions.emplace_back(k, 0.0);
      mesh.sizes.push_back(2);
      for (int i = k < part || k >= 2 * part ? 0 : part; i < k; ++i) mesh.pairs.push_back({i, k});
    }
    expect_like_dense(mesh, as_they_come(mesh), static_cast<unsigned>(part));
    expect_inverse_like_dense(mesh, as_they_come(mesh), static_cast<unsigned>(part));
  }
}

TEST(FrontalCholesky, KnowsNoInverseBetweenNodesThatNothingCouples) {
  Mesh mesh;
  for (int k = 0; k < 3; ++k) {
    mesh.positions.emplace_back(k, 0.0);
    mesh.sizes.push_back(2);
  }
  mesh.pairs = {{1, 2}};
  const Case c = factored(mesh, as_they_come(mesh), 1);
  EXPECT_THROW(static_cast<void>(c.cholesky.inverse().block(4, 2, 0, 2)), std::out_of_range);
}

TEST(FrontalCholesky, EqualsADenseFactorisationOnMeshes) {
  for (const int side : {1, 2, 3, 7, 12}) {
    for (const int largest : {1, 2, 4}) {
      const Mesh mesh = square_mesh(side, largest, static_cast<unsigned>(side));
      expect_like_dense(mesh, dissection_order(mesh.positions, mesh.pairs), 1);
      expect_like_dense(mesh, as_they_come(mesh), 2);
    }
  }
}

TEST(FrontalCholesky, EqualsADenseFactorisationOnAnyGraph) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Mesh mesh = wild_mesh(2 + static_cast<int>(seed) * 3, static_cast<int>(seed), seed);
    expect_like_dense(mesh, elimination_order(static_cast<int>(mesh.sizes.size()), mesh.pairs),
                      seed);
    expect_like_dense(mesh, as_they_come(mesh), seed);
  }
}

TEST(FrontalCholesky, EqualsADenseFactorisationOnAFullMatrix) {
  // Large enough for BLAS, with and without rows that remain.
  Mesh mesh;
  for (int k = 0; k < 90; ++k) {
    mesh.positions.emplace_back(k, 0.0);
    mesh.sizes.push_back(2);
    for (int i = std::max(0, k - 60); i < k; ++i) mesh.pairs.push_back({i, k});
  }
  expect_like_dense(mesh, as_they_come(mesh), 3);
}

TEST(FrontalCholesky, AgreesWithCholmodOnALargeMesh) {
  const Mesh mesh = square_mesh(60, 3, 5);
  const Case c = factored(mesh, dissection_order(mesh.positions, mesh.pairs), 6);
  SparseCholesky cholmod;
  cholmod.analyse(c.lower);
  cholmod.factorise(c.lower);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(c.lower.rows(), 0.0, 1.0);
  Eigen::VectorXd x = b;
  c.cholesky.solve_in_place(x);
  EXPECT_LT((x - cholmod.solve(b)).norm(), 1e-11 * x.norm());
  EXPECT_NEAR(c.cholesky.log_determinant(), cholmod.log_determinant(),
              1e-11 * std::abs(cholmod.log_determinant()));
  const Eigen::MatrixXd blocks = c.cholesky.inverse_blocks();
  for (const int column : {0, 777, 4321}) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(c.lower.rows(), column);
    const Eigen::VectorXd exact = cholmod.solve(unit);
    EXPECT_NEAR(blocks.col(column).maxCoeff(), exact[column], 1e-12);
  }
}

TEST(FrontalCholesky, NamesTheUnknownAtWhichItBreaksDown) {
  const Mesh mesh = square_mesh(12, 2, 5);
  Case c = factored(mesh, dissection_order(mesh.positions, mesh.pairs), 6);
  for (const int column : {0, 17, 50, static_cast<int>(c.lower.rows()) - 1}) {
    SparseMatrix broken = c.lower;
    broken.coeffRef(column, column) = -1.0;
    try {
      c.cholesky.factorise(broken);
      FAIL() << "a negative diagonal was accepted";
    } catch (const NotPositiveDefinite& failure) {
      EXPECT_EQ(failure.column(), column);
    }
  }
  EXPECT_NO_THROW(c.cholesky.factorise(c.lower));
}

TEST(BlockSystem, BothKernelsGiveTheSame) {
  const Mesh mesh = square_mesh(9, 1, 8);
  std::vector<int> sizes(mesh.sizes.size(), 2);
  sizes[40] = 0;
  Eigen::VectorXd x[2];
  Eigen::MatrixXd covariances[2];
  const std::vector<int> order = dissection_order(mesh.positions, mesh.pairs);
  for (const Kernel kernel : {Kernel::frontal, Kernel::cholmod}) {
    BlockSystem system(sizes, mesh.pairs, order, kernel);
    for (std::size_t k = 0; k < mesh.pairs.size(); ++k) {
      const Eigen::Matrix2d B = (Eigen::Matrix2d() << 2.0, 0.5, 0.5, 1.0).finished();
      system.add_diagonal<2>(mesh.pairs[k][0], B);
      system.add_diagonal<2>(mesh.pairs[k][1], B);
      system.add_coupling<2, 2>(static_cast<int>(k), -B);
    }
    system.factorise();
    Eigen::VectorXd u = Eigen::VectorXd::Zero(system.unknowns());
    u[system.offset(3)] = 1.0;
    system.solve_in_place(u);
    const Eigen::MatrixXd blocks = system.inverse_blocks();
    const std::size_t which = kernel == Kernel::frontal ? 0 : 1;
    x[which].resize(2 * 81);
    covariances[which].resize(2, 2 * 81);
    for (int node = 0; node < 81; ++node) {
      if (node == 40) continue;
      x[which].segment<2>(2 * node) = u.segment<2>(system.offset(node));
      covariances[which].middleCols<2>(2 * node) = blocks.block<2, 2>(0, system.offset(node));
    }
    x[which].segment<2>(80).setZero();
    covariances[which].middleCols<2>(80).setZero();
  }
  EXPECT_LT((x[0] - x[1]).norm(), 1e-12 * x[0].norm());
  EXPECT_LT((covariances[0] - covariances[1]).norm(), 1e-12 * covariances[0].norm());
}

TEST(Dissection, IsAPermutationWithLittleFill) {
  const Mesh mesh = square_mesh(40, 1, 3);
  const std::vector<int> order = dissection_order(mesh.positions, mesh.pairs);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, as_they_come(mesh));
  // Beside minimum degree: fronts, which include some zeros, at most a quarter larger.
  const auto stored = [&mesh](const std::vector<int>& elimination) {
    const std::vector<int> ones(mesh.sizes.size(), 1);
    const BlockPattern pattern = pattern_of(mesh.pairs, places_in(elimination), 1600);
    return FrontalCholesky(plan_fronts(pattern, ones), ones).stored();
  };
  EXPECT_LT(stored(order), 1.25 * stored(elimination_order(1600, mesh.pairs)));
}

TEST(Dissection, CopesWithNodesInOnePlace) {
  const std::vector<Vector2> positions(30, Vector2(1.0, 1.0));
  std::vector<NodePair> pairs;
  for (int k = 1; k < 30; ++k) pairs.push_back({0, k});
  std::vector<int> order = dissection_order(positions, pairs);
  std::sort(order.begin(), order.end());
  for (int k = 0; k < 30; ++k) EXPECT_EQ(order[idx(k)], k);
  EXPECT_THROW((void)dissection_order(positions, {{0, 30}}), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::frontal_cholesky_test
