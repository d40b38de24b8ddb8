// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Standard errors at a place or threshold that was sought, and sizes that cannot be.
#include "criticism/place_uncertainty.hpp"

#include "criticism/noisy_recordings.hpp"
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace trussmap::place_uncertainty_test {
using namespace criticism;
namespace {

struct Drawn {
  std::vector<DrivenRecording> recordings;
  Model model;
};

Drawn drawn(const Effect& effect, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 4, random);
  SimulatedEffects acting;
  acting.effects = {effect};
  return {{testing::driven(simulate_drive(mesh, tours.walk, {}, {}, seed, acting).recording)}, {}};
}

Candidate threshold_at(double value) {
  Candidate one;
  one.effect.name = "travel with speed above a threshold";
  one.effect.channel = Channel::travel;
  one.form = Form::threshold;
  one.pattern = {"max(0, speed-{c})"};
  one.parameters = {{"c", value}};
  one.search = {{0.1, 0.2, 0.9}};
  return with_parameters(one, {value});
}

// The joint covariance of size and threshold, from second differences of chi^2 itself: residuals
// without noise, so that Gauss's and Newton's are the same.
TEST(Widening, IsThatOfTheJointCovariance) {
  const Drawn world = drawn(threshold_at(0.5).effect, 1);  // no coefficients: nothing acts
  const ModelFit fit = fit_model(world.recordings, world.model);
  const ScoreTest tests(*fit.state);
  const std::vector<double> a{-0.05};
  const double c = 0.5;
  const auto seen = [&](double size, double threshold) -> Eigen::VectorXd {
    return tests.projected(size * tests.columns(threshold_at(threshold).effect));
  };
  const Eigen::VectorXd truth = seen(a[0], c);
  const auto chi2 = [&](double size, double threshold) {
    return (truth - seen(size, threshold)).squaredNorm();
  };
  const double h = 1e-3;
  const double k = 0.0125;  // as wide as the differences in question
  Eigen::Matrix2d H;
  H(0, 0) = (chi2(a[0] + h, c) + chi2(a[0] - h, c)) / (2.0 * h * h);
  H(1, 1) = (chi2(a[0], c + k) + chi2(a[0], c - k)) / (2.0 * k * k);
  H(0, 1) = H(1, 0) = (chi2(a[0] + h, c + k) - chi2(a[0] + h, c - k) - chi2(a[0] - h, c + k) +
                       chi2(a[0] - h, c - k)) /
                      (8.0 * h * k);
  H(1, 1) += 1.0 / std::pow(0.9 - 0.2, 2);  // the prior: where it was sought
  const double wanted = std::sqrt(H.inverse()(0, 0) * H(0, 0));
  const std::vector<double> found = widening(tests, threshold_at(c), a, tests.present());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(wanted, 1.3);
  EXPECT_NEAR(found[0], wanted, 0.03 * wanted);
}

TEST(Widening, IsNoneWithoutParameters) {
  const Drawn world = drawn(threshold_at(0.5).effect, 2);
  const ModelFit fit = fit_model(world.recordings, world.model);
  const ScoreTest tests(*fit.state);
  Candidate plain;
  plain.effect = catalogue_effect("wheelbase");
  EXPECT_EQ(widening(tests, plain, {0.01}, tests.present()), std::vector<double>{1.0});
}

// Of 95 % intervals 12 or fewer of 16 hold the truth once in 1000 runs; without the threshold's own
// uncertainty it is 9 of these.
TEST(SlowWidening, IntervalsHoldWhereAThresholdWasSought) {
  int held = 0;
  int whole = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    Effect truth = catalogue_effect("missed ticks (v0=0.55)");
    truth.coefficients = {0.04};
    const Drawn world = drawn(truth, seed);
    const Discovery found = discover(world.recordings, world.model);
    for (const EffectEstimate& one : found.found.effects) {
      if (one.effect.name.rfind("missed ticks", 0) != 0) continue;
      ++whole;
      held += std::abs(one.effect.coefficients[0] - 0.04) <= 1.96 * one.sd[0] ? 1 : 0;
    }
  }
  EXPECT_GE(whole, 10);
  EXPECT_GE(held, (whole * 13 + 15) / 16);
}

// Ten centimetres lost in each start are five times what a channel of events may have: named all
// the same, for nothing plausible explains as much, and said to be so.
TEST(Diagnosis, AnImplausibleSizeIsNamedAndSaid) {
  Effect monstrous = catalogue_effect("loss per start");
  monstrous.coefficients = {-0.1};
  const Drawn world = drawn(monstrous, 3);
  const Diagnosis result = diagnose(world.recordings, world.model);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Finding& first = result.findings.front();
  EXPECT_EQ(result.missing, "loss per start");
  EXPECT_TRUE(first.implausible);
  EXPECT_NE(in_words(first).find("implausibly large"), std::string::npos) << in_words(first);
  EXPECT_NEAR(first.effect.coefficients[0], -0.1, 0.01);
}

}  // namespace
}  // namespace trussmap::place_uncertainty_test
