// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fields over the floor, against what was simulated; Matern's precision against its closed form.
#include "criticism/place_fields.hpp"

#include "criticism/matern_field.hpp"
#include "criticism/place_scores.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::place_fields_test {
using namespace criticism;
namespace {

Effect by_place(Channel channel, const std::vector<std::string>& shapes, double coefficient) {
  Effect effect;
  effect.name = "by place";
  effect.channel = channel;
  for (const std::string& one : shapes) {
    effect.shape.emplace_back(one);
    effect.coefficients.push_back(coefficient);
  }
  return effect;
}

/// Three waves across the floor, of sd sqrt(3/2) times the coefficient.
const std::vector<std::string> kWaves{"sin(0.5*x+0.2*y+1)", "cos(0.4*y-0.3*x)",
                                      "sin(0.6*y+0.1*x-2)"};

double waves_at(double x, double y) {
  return std::sin(0.5 * x + 0.2 * y + 1.0) + std::cos(0.4 * y - 0.3 * x) +
         std::sin(0.6 * y + 0.1 * x - 2.0);
}

/// Of the mesh that the command drives.
SimulatedRecording toured(std::uint64_t seed, const std::vector<Effect>& effects) {
  SimulationSettings settings;
  settings.seed = seed;
  return simulate(settings, effects);
}

PlaceScores scores_in(const SimulatedRecording& one) {
  const ModelFit fit = fit_model({one.drive.recording}, one.model);
  return place_scores(*fit.state, ScoreTest(*fit.state), {}).value();
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd da = a.array() - a.mean();
  const Eigen::VectorXd db = b.array() - b.mean();
  return da.dot(db) / (da.norm() * db.norm());
}

/// Whittle's: kappa r K_1(kappa r).
double matern_correlation(double distance, double length) {
  const double z = std::sqrt(8.0) / length * distance;
  return z > 0.0 ? z * std::cyl_bessel_k(1.0, z) : 1.0;
}

TEST(MaternField, HasTheClosedFormsCovariance) {
  const SquareGrid grid{{0.0, 0.0}, 0.25, 17, 9};
  const std::vector<GridNode> nodes{{0, 0}, {4, 0}, {4, 4}, {12, 2}, {16, 8}};
  const double length = 3.0;
  const Eigen::MatrixXd covariance = matern_covariance(grid, nodes, length);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double distance = (grid.place_of(nodes[j]) - grid.place_of(nodes[k])).norm();
      // Each edge, a length or more away, adds the image beyond it, at most 0.0098 at twice that:
      // 0.05 of four edges and corners. The grid takes off less.
      EXPECT_NEAR(covariance(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)),
                  matern_correlation(distance, length), 0.055)
          << j << " " << k;
    }
  }
}

/// The operator as it stands in the paper, dense: kappa^2 C + S of a 3 x 2 grid.
TEST(MaternField, ItsOperatorIsTheStencil) {
  const SquareGrid grid{{0.0, 0.0}, 0.5, 3, 2};
  const Eigen::MatrixXd lower = matern_operator(grid, std::sqrt(8.0));  // kappa = 1
  const Eigen::MatrixXd K = lower.selfadjointView<Eigen::Lower>();
  const std::vector<double> neighbours{2, 3, 2, 2, 3, 2};
  for (Eigen::Index j = 0; j < 6; ++j) {
    for (Eigen::Index k = 0; k < 6; ++k) {
      const Eigen::Index columns = std::abs(j % 3 - k % 3);
      const Eigen::Index rows = std::abs(j / 3 - k / 3);
      const double expected = j == k                ? 0.25 + neighbours[static_cast<std::size_t>(j)]
                              : columns + rows == 1 ? -1.0
                                                    : 0.0;
      EXPECT_NEAR(K(j, k), expected, 1e-12) << j << " " << k;
    }
  }
}

/// All pieces of a channel together are the channel itself.
TEST(PlaceScores, AddUpToTheChannels) {
  const SimulatedRecording one = toured(3, {});
  const ModelFit fit = fit_model({one.drive.recording}, one.model);
  const ScoreTest tests(*fit.state);
  const PlaceScores scores = place_scores(*fit.state, tests, {}).value();
  ASSERT_EQ(scores.channels.size(), 4U);
  EXPECT_NEAR(scores.driven.sum(), 1.0, 1e-9);
  for (std::size_t c = 0; c < scores.channels.size(); ++c) {
    const Score whole = tests.test({by_place(scores.channels[c], {"1"}, 0.0)}).front();
    const Eigen::Index first = scores.count() * static_cast<Eigen::Index>(c);
    const double G = scores.G.block(first, first, scores.count(), scores.count()).sum();
    const double s = scores.s.segment(first, scores.count()).sum();
    // Nodes that hardly anything is near were left out.
    EXPECT_NEAR(G / whole.information.front(), 1.0, 0.02) << name_of(scores.channels[c]);
    EXPECT_NEAR(s, whole.projected.col(0).dot(tests.residuals()), 0.05 * std::sqrt(G))
        << name_of(scores.channels[c]);
  }
}

/// A bilinear field is the same from its nodes as from a formula.
TEST(PlaceScores, ShareRowsBilinearly) {
  const SimulatedRecording one = toured(4, {});
  const ModelFit fit = fit_model({one.drive.recording}, one.model);
  const ScoreTest tests(*fit.state);
  const PlaceScores scores = place_scores(*fit.state, tests, {}).value();
  Eigen::VectorXd values(scores.count());
  for (Eigen::Index k = 0; k < scores.count(); ++k) {
    const Vector2 place = scores.grid.place_of(scores.nodes[static_cast<std::size_t>(k)]);
    values[k] = place.x() * place.y();
  }
  const Score whole = tests.test({by_place(Channel::travel, {"x*y"}, 0.0)}).front();
  const double G = values.dot(scores.G.topLeftCorner(scores.count(), scores.count()) * values);
  EXPECT_NEAR(G / whole.information.front(), 1.0, 0.02);
}

TEST(PlaceFields, NoneWhereThereIsNone) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    EXPECT_TRUE(place_fields(scores_in(toured(seed, {})), 0.001).empty()) << seed;
  }
}

TEST(PlaceFields, TheMapOfAFieldIsLikeIt) {
  for (const auto& [channel, size] :
       {std::pair(Channel::travel, 0.02), {Channel::creep, 0.02}, {Channel::compass, 0.02}}) {
    const std::vector<FieldOfPlaces> found =
        place_fields(scores_in(toured(11, {by_place(channel, kWaves, size)})));
    ASSERT_FALSE(found.empty()) << name_of(channel);
    const FieldOfPlaces& field = found.front();
    EXPECT_EQ(field.channel, channel);
    EXPECT_TRUE(field.is_field());
    EXPECT_GT(field.length, 1.0);
    std::vector<double> told, truth;
    int within = 0;
    for (int row = 0; row < field.rows; ++row) {
      for (int column = 0; column < field.columns; ++column) {
        const auto at = static_cast<std::size_t>(row * field.columns + column);
        if (std::isnan(field.mean[at])) continue;
        told.push_back(field.mean[at]);
        truth.push_back(size * waves_at(field.x + field.cell * column, field.y + field.cell * row));
      }
    }
    const auto n = static_cast<Eigen::Index>(told.size());
    const Eigen::Map<const Eigen::VectorXd> a(told.data(), n);
    const Eigen::Map<const Eigen::VectorXd> b(truth.data(), n);
    EXPECT_GT(correlation(a, b), 0.8) << name_of(channel);
    std::size_t k = 0;
    for (std::size_t at = 0; at < field.mean.size(); ++at) {
      if (std::isnan(field.mean[at])) continue;
      const double off = (a[static_cast<Eigen::Index>(k)] - a.mean()) -
                         (b[static_cast<Eigen::Index>(k)] - b.mean());
      within += std::abs(off) < 2.5 * field.sd[at] ? 1 : 0;
      ++k;
    }
    EXPECT_GE(within, static_cast<int>(n) * 85 / 100) << name_of(channel);
  }
}

TEST(SlowPlaceFields, ACircleIsStillCalledACircle) {
  const SimulatedRecording one =
      toured(21, {catalogue_effect("slippery patch (x=12, y=9, r=4)", {-0.06})});
  const Diagnosis result = diagnose({one.drive.recording}, one.model);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  EXPECT_NE(result.missing.find("slippery patch"), std::string::npos) << result.missing;
  for (const FieldOfPlaces& field : result.places) {
    EXPECT_FALSE(field.is_field());
    EXPECT_NE(in_words(field).find("explained as well by"), std::string::npos) << in_words(field);
  }
}

TEST(SlowPlaceFields, ADiagnosisTellsAField) {
  const SimulatedRecording one = toured(31, {by_place(Channel::compass, kWaves, 0.05)});
  const Diagnosis result = diagnose({one.drive.recording}, one.model);
  EXPECT_NE(result.verdict, Diagnosis::Verdict::nothing_missing);
  ASSERT_FALSE(result.places.empty());
  EXPECT_EQ(result.places.front().channel, Channel::compass);
  EXPECT_TRUE(result.places.front().is_field());
  // Root of 3/2 times 0.05 rad, less what the way's mean takes.
  EXPECT_NEAR(result.places.front().size, 0.061, 0.025);
}

}  // namespace
}  // namespace trussmap::place_fields_test
