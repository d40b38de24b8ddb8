// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Columns put together from channels and shapes against those that the adjustment computes effect
// by effect.
#include "fit/column_builder.hpp"

#include "criticism/inverted_recordings.hpp"
#include "estimation/recording_system.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/fit_state.hpp"

#include <gtest/gtest.h>

namespace trussmap::column_builder_test {
using namespace fitting;
namespace {

TEST(ColumnBuilder, AgreesWithTheBorderOfTheAdjustmentInEveryChannel) {
  const testing::SimulatedRecording one = testing::simulate_recording({true, true, true}, 4);
  Model model = one.model;
  Effect present;
  present.name = "present";
  present.channel = Channel::turn;
  present.shape = {"1"};
  present.coefficients = {0.01};
  model.effects = {present};
  FitterOptions options;
  options.fit_effects = false;
  const FitState fit = fit_recordings({one.recording}, model, options);
  const ShapeContext context(fit.recordings, fit.model.robot, fit.paths);
  const std::vector<double> weights(fit.problem.measurements.size(), 1.0);
  ColumnBuilder builder(context, fit.problem, fit.columns.border, offsets_of(fit),
                        fit.adjustment.state, weights);
  for (const ChannelFacts& channel : channels()) {
    Effect effect;
    effect.name = "candidate";
    effect.channel = channel.channel;
    effect.shape = {"1", "sin(heading)", "speed", "t"};
    EffectColumns both = effect_columns({fit.model.effects[0], effect}, context);
    both.border[0].held = 0.01;
    estimation::RecordingSystem system(fit.problem, both.border);
    system.linearise(fit.adjustment.state, Eigen::VectorXd::Zero(4));
    const Eigen::MatrixXd columns = builder.columns(effect);
    ASSERT_EQ(columns.rows(), system.border().rows());
    for (Eigen::Index k = 0; k < 4; ++k) {
      EXPECT_LT((columns.col(k) - system.border().col(k)).norm(),
                1e-7 * (1.0 + system.border().col(k).norm()))
          << channel.name << " " << effect.shape[static_cast<std::size_t>(k)].text();
    }
  }
}

TEST(ColumnBuilder, SessionsOfTheirOwnAddUpToTheWhole) {
  std::vector<DrivenRecording> recordings;
  for (const std::uint64_t seed : {5U, 6U}) {
    recordings.push_back(testing::simulate_recording({}, seed).recording);
  }
  const FitState fit = fit_recordings(recordings, Model{});
  const ShapeContext context(fit.recordings, fit.model.robot, fit.paths);
  const std::vector<double> weights(fit.problem.measurements.size(), 1.0);
  ColumnBuilder builder(context, fit.problem, fit.columns.border, offsets_of(fit),
                        fit.adjustment.state, weights);
  for (const Channel channel :
       {Channel::wheels, Channel::compass, Channel::lever, Channel::delay}) {
    Effect effect;
    effect.name = "one for all";
    effect.channel = channel;
    effect.shape = {"1", "speed"};
    const Eigen::MatrixXd whole = builder.columns(effect);
    effect.per_session = true;
    const Eigen::MatrixXd apart = builder.columns(effect);
    ASSERT_EQ(apart.cols(), 4);
    EXPECT_LT((apart.leftCols(2) + apart.rightCols(2) - whole).norm(), 1e-12 * whole.norm());
    EXPECT_EQ(apart.col(0).cwiseProduct(apart.col(2)).norm(), 0.0) << name_of(channel);
  }
}

}  // namespace
}  // namespace trussmap::column_builder_test
