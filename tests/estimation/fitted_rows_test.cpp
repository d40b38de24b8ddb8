// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a fit knows of each measurement's rows, against solves with the whole normal matrix.
#include "estimation/fitted_rows.hpp"

#include "estimation/recording_adjustment.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"

#include <gtest/gtest.h>

namespace trussmap::fitted_rows_test {
namespace {

TEST(FittedRows, AreThoseOfTheWholeInverse) {
  const testing::SimulatedRecording world = testing::simulate_recording({}, 5);
  Model model = world.model;
  model.effects = {catalogue_effect("wheelbase"), catalogue_effect("wheel scale")};
  const ModelFit fit = fit_model({world.recording}, model);
  const fitting::FitState& state = *fit.state;
  estimation::RecordingSystem system(state.problem, state.columns.border);
  system.set_weights(
      estimation::weights_without(state.adjustment.left_out, state.problem.measurements.size()));
  system.linearise(state.adjustment.state, state.adjustment.coefficients);
  system.factorise();
  ASSERT_EQ(system.border().cols(), 2);
  const estimation::FittedRows fitted(system);
  for (std::size_t k = 0; k < state.problem.measurements.size(); ++k) {
    const Eigen::MatrixXd J = system.transposed_rows(k);
    const Eigen::MatrixXd expected = J.transpose() * system.solve(J);
    EXPECT_LT((fitted.covariance(system, k) - expected).cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::MatrixXd nodes = J.topRows(system.normal_equations().unknowns());
    EXPECT_LT((fitted.by_nodes(system, k) - nodes.transpose() * system.solve_nodes(nodes))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9);
  }
}

}  // namespace
}  // namespace trussmap::fitted_rows_test
