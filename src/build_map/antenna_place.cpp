// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/antenna_place.hpp"

#include "effects/channel_physics.hpp"
#include "fit/fitted_path.hpp"
#include "statistics/median.hpp"
#include "statistics/thinned.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace trussmap::map_building {
namespace {

/// Where the robot is by the sightings, and a fix has its antenna.
struct FixedPose {
  Pose pose;
  Vector2 fix;
};

bool is_stated(const Model& model) {
  return model.robot.mounted.antenna ||
         std::any_of(model.effects.begin(), model.effects.end(), [](const Effect& one) {
           return effects::acts_on_fixes(one.channel) && !effects::is_delay(one.channel);
         });
}

std::vector<FixedPose> fixed_poses(const fitting::FitState& fit) {
  constexpr std::size_t kMost = 3000;
  std::vector<FixedPose> result;
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const DrivenRecording& recording = fit.recordings[s];
    if (recording.sightings.size() < 2) continue;
    for (const Fix& one : recording.fixes) {
      // Before the first sighting and after the last one nothing holds the path.
      if (one.t < recording.sightings.front().t || one.t > recording.sightings.back().t) continue;
      result.push_back({fitting::pose_at(recording.drive, fit.paths[s], one.t), {one.x, one.y}});
    }
  }
  return statistics::thinned(std::move(result), kMost);
}

/// Of (t, cos, sin, R s): two rows per fix.
struct FixRows {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};

FixRows rows_of(const std::vector<FixedPose>& poses) {
  const auto rows = 2 * static_cast<Eigen::Index>(poses.size());
  FixRows result{Eigen::MatrixXd::Zero(rows, 6), Eigen::VectorXd(rows)};
  Eigen::Index row = 0;
  for (const FixedPose& one : poses) {
    result.A.block<2, 2>(row, 0).setIdentity();
    result.A.block<2, 1>(row, 2) = one.pose.position();
    result.A.block<2, 1>(row, 3) = quarter_turn(one.pose.position());
    result.A.block<2, 2>(row, 4) = rotation(one.pose.heading);
    result.b.segment<2>(row) = one.fix;
    row += 2;
  }
  return result;
}

struct Solved {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  double usual = 0.0;  ///< m, the median distance of a fix
};

/// Those that contradict the others with less say.
std::optional<Solved> solved(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  constexpr int kRounds = 8;
  constexpr double kTellable = 1e-6;
  Eigen::ArrayXd weights = Eigen::ArrayXd::Ones(b.size());
  Solved result;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(weights.matrix().asDiagonal() * A);
    solver.setThreshold(kTellable);
    if (solver.rank() < A.cols()) return std::nullopt;
    result.x = solver.solve(weights.matrix().asDiagonal() * b);
    const Eigen::ArrayXd off = (A * result.x - b).array().abs();
    result.usual = statistics::median({off.data(), off.data() + off.size()});
    weights = 1.0 / (1.0 + (off / std::max(2.0 * result.usual, 1e-9)).square()).sqrt();
  }
  const Eigen::MatrixXd weighted = weights.matrix().asDiagonal() * A;
  const Eigen::VectorXd left = weights.matrix().asDiagonal() * (A * result.x - b);
  const double variance = left.squaredNorm() / static_cast<double>(b.size() - A.cols());
  result.covariance =
      variance *
      (weighted.transpose() * weighted).ldlt().solve(Eigen::MatrixXd::Identity(A.cols(), A.cols()));
  return result;
}

}  // namespace

std::optional<AntennaFound> antenna_by_sightings(const std::vector<DrivenRecording>& recordings,
                                                 const Model& model, fitting::FitterOptions how) {
  constexpr std::size_t kFewest = 20;  // fixes
  constexpr double kSure = 8.0;        // standard deviations: errors last
  constexpr double kTellable = 0.05;   // m
  constexpr double kMuchNearer = 0.7;  // of the fixes' distances without
  const auto has_both = [](const DrivenRecording& one) {
    return !one.sightings.empty() && one.fixes.size() >= kFewest;
  };
  if (is_stated(model) || std::none_of(recordings.begin(), recordings.end(), has_both)) {
    return std::nullopt;
  }
  how.problem.fixes = false;
  how.paths = true;
  how.free_common_errors = true;
  std::vector<FixedPose> poses;
  try {
    poses = fixed_poses(fitting::fit_recordings(recordings, model, how));
  } catch (const SolveError&) {  // too little without the fixes
    return std::nullopt;
  }
  if (poses.size() < kFewest) return std::nullopt;
  const FixRows rows = rows_of(poses);
  const std::optional<Solved> over_axle = solved(rows.A.leftCols(4), rows.b);
  const std::optional<Solved> found = solved(rows.A, rows.b);
  if (!over_axle || !found || found->usual > kMuchNearer * over_axle->usual) return std::nullopt;
  const Vector2 turned = found->x.tail<2>();
  const Vector2 place = rotation(-std::atan2(found->x[3], found->x[2])) * turned;
  const double sd = std::sqrt(found->covariance.bottomRightCorner<2, 2>().diagonal().maxCoeff());
  if (place.norm() < std::max(kTellable, kSure * sd)) return std::nullopt;
  return AntennaFound{{place.x(), place.y(), 0.0}, sd};
}

}  // namespace trussmap::map_building
