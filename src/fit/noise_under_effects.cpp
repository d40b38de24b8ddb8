// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_under_effects.hpp"

#include "effects/channel_physics.hpp"
#include "parallel/parallel_for.hpp"

#include <Eigen/LU>

namespace trussmap::fitting {
namespace {

/// Of a row: forward [m], turn [rad], excess of the gyro [rad].
using RowNoise = Eigen::Vector3d;

struct ConstantEffect {
  Channel channel;
  double offset;
};

std::vector<ConstantEffect> constants_of(const FitState& fit, std::size_t session) {
  const Eigen::VectorXd offsets = offsets_of(fit);
  std::vector<ConstantEffect> result;
  for (std::size_t k = 0; k < fit.columns.border.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[k];
    const Effect& effect = fit.model.effects[one.effect];
    const double offset = offsets[static_cast<Eigen::Index>(k)];
    const bool acts = !effect.per_session || one.place == session;
    if (!effect.is_constant() || !acts || offset == 0.0) continue;
    if (effects::acts_on(effect.channel) == effects::ActsOn::drives)
      result.push_back({effect.channel, offset});
  }
  return result;
}

RowNoise additions(const std::vector<ConstantEffect>& effects, const drive::RowMotion& row) {
  effects::DrivePattern sum;
  for (const ConstantEffect& one : effects) {
    sum.add(one.offset, effects::drive_pattern(one.channel, 1.0, row));
  }
  return {sum.advance, sum.turn, sum.excess};
}

/// How what the effects add grows with the noise.
Matrix3 growth(const std::vector<ConstantEffect>& effects, const drive::RowMotion& row) {
  const RowNoise none = additions(effects, row);
  Matrix3 result;
  for (int k = 0; k < 3; ++k) {
    const RowNoise unit = RowNoise::Unit(k);
    drive::RowMotion more = row;
    add_noise({unit[0], unit[1]}, unit[2], more);
    result.col(k) = additions(effects, more) - none;
  }
  return result;
}

RowNoise noise_in(const SessionPath& path, std::size_t row) {
  return {path.missing[row][0], path.missing[row][1], path.excess.empty() ? 0.0 : path.excess[row]};
}

RowNoise stepped(const RowNoise& before, const RowNoise& found, const Matrix3& growth) {
  // What an effect adds is missing less, but adds to the excess.
  const Matrix3 less = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal() * growth;
  const Matrix3 factor = Matrix3::Identity() + less;
  if (factor.diagonal().minCoeff() < 0.0 || factor.determinant() < 0.0) return RowNoise::Zero();
  if (!(less.trace() > 0.0)) return found;
  const Matrix3 step = Matrix3::Identity() + 0.5 * less;
  return before + step.inverse() * (found - before);
}

}  // namespace

void step_noise_under_effects(const std::vector<SessionPath>& before, FitState& fit) {
  for (std::size_t s = 0; s < fit.paths.size() && s < before.size(); ++s) {
    SessionPath& path = fit.paths[s];
    if (path.missing.empty() || before[s].missing.size() != path.missing.size() ||
        before[s].excess.size() != path.excess.size()) {
      continue;
    }
    const std::vector<ConstantEffect> effects = constants_of(fit, s);
    if (effects.empty()) continue;
    const MotionRows& drive = fit.recordings[s].drive;
    parallel::parallel_for(path.missing.size(), [&](std::size_t row) {
      const drive::RowMotion motion = drive::row_motion(drive, row, fit.model.robot);
      const RowNoise next =
          stepped(noise_in(before[s], row), noise_in(path, row), growth(effects, motion));
      path.missing[row] = next.head<2>();
      if (!path.excess.empty()) path.excess[row] = next[2];
    });
  }
}

}  // namespace trussmap::fitting
