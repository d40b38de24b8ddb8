// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/blocked_coefficients.hpp"

#include "estimation/recording_system.hpp"
#include "trussmap/channel.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::validation {
namespace {

// Of a row left out: tells nothing, and leaves no landmark of the block undetermined.
constexpr double kFaint = 1e-9;

/// With the sizes that a channel's effects have as priors, for what the other blocks leave open.
estimation::EffectParameters with_priors(const fitting::FitState& fit) {
  estimation::EffectParameters border = fit.columns.border;
  for (std::size_t k = 0; k < border.size(); ++k) {
    const fitting::Coefficient& one = fit.columns.coefficients[k];
    const double plausible = facts_of(fit.model.effects[one.effect].channel).prior_sd;
    border[k].prior_sd = std::min(border[k].prior_sd, plausible / std::max(one.largest, 1e-300));
  }
  return border;
}

std::vector<double> weights_without_block(const fitting::FitState& fit, const TimeBlocks& blocks,
                                          int block) {
  const estimation::RecordingProblem& problem = fit.problem;
  std::vector<double> weights =
      estimation::weights_without(fit.adjustment.left_out, problem.measurements.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (!estimation::may_be_wrong(one) && !estimation::gives_pose(one)) continue;
    const auto in_block = [&](int node) {
      const estimation::PoseNode& pose = problem.poses[idx(node - problem.landmark_count())];
      return blocks.at(pose.session, pose.t) == block;
    };
    if (in_block(one.from) || (estimation::is_tie(one) && in_block(one.to))) weights[k] *= kFaint;
  }
  return weights;
}

}  // namespace

TimeBlocks::TimeBlocks(const estimation::RecordingProblem& problem, int count)
    : spans_(problem.sessions.size()), count_(count) {
  std::vector<bool> seen(spans_.size(), false);
  for (const estimation::PoseNode& node : problem.poses) {
    TimeSpan& span = spans_[idx(node.session)];
    if (!seen[idx(node.session)]) span.from = node.t;
    seen[idx(node.session)] = true;
    span.to = node.t;
  }
}

int TimeBlocks::at(int session, double t) const {
  const TimeSpan& span = spans_[idx(session)];
  const double share = (t - span.from) / std::max(span.to - span.from, 1e-9);
  return std::clamp(static_cast<int>(std::floor(share * count_)), 0, count_ - 1);
}

std::vector<Eigen::VectorXd> offsets_without_blocks(const fitting::FitState& fit,
                                                    const TimeBlocks& blocks) {
  std::vector<Eigen::VectorXd> result(idx(blocks.count()), fitting::offsets_of(fit));
  if (estimation::unknown_coefficients(fit.columns.border).empty()) return result;
  const estimation::EffectParameters border = with_priors(fit);
  estimation::RecordingSystem system(fit.problem, border);
  for (int block = 0; block < blocks.count(); ++block) {
    system.set_weights(weights_without_block(fit, blocks, block));
    system.linearise(fit.adjustment.state, fit.adjustment.coefficients);
    const estimation::RecordingSystem::Step step = system.solve_step();
    result[idx(block)] =
        estimation::offsets_at(border, fit.adjustment.coefficients + step.coefficients);
  }
  return result;
}

}  // namespace trussmap::validation
