// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/segment_noise.hpp"

#include "estimation/noise_states.hpp"
#include "odometry/row_reckoner.hpp"
#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace trussmap::estimation {
namespace {

constexpr double kLeastSd = 1e-5;  // m and rad

struct Path {
  std::vector<Matrix2> turned;   ///< axes at the start of each row
  std::vector<Vector2> reached;  ///< at the end of each row
  Vector4 numbers = Vector4::Zero();
};

/// Lays the steps end to end; without readings the fourth number is 0.
Path lay(const std::vector<SegmentRow>& rows, const std::vector<Pose>& steps) {
  Path path;
  path.turned.reserve(rows.size());
  path.reached.reserve(rows.size());
  Vector2 place = Vector2::Zero();
  double heading = 0.0;
  double first = 0.0;
  double sum = 0.0;
  int readings = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    path.turned.push_back(rotation(heading));
    place += path.turned.back() * steps[k].position();
    heading += steps[k].heading;
    path.reached.push_back(place);
    if (std::isnan(rows[k].reading)) continue;
    const double angle = rows[k].reading - heading;
    if (readings == 0) first = angle;
    sum += wrap_angle(angle - first);
    ++readings;
  }
  path.numbers << place.x(), place.y(), heading,
      readings == 0 ? 0.0 : wrap_angle(first + sum / readings);
  return path;
}

/// What the rows do each by itself, whatever the noise of the others.
struct RowsAlone {
  std::vector<Pose> steps;
  int readings = 0;
  std::vector<Matrix3> Q;
  Path recorded;
};

RowsAlone rows_alone(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                     const Robot& robot, const Noise& noise) {
  RowsAlone alone;
  alone.readings = readings_of(rows);
  alone.steps.reserve(rows.size());
  alone.Q.reserve(rows.size());
  for (const SegmentRow& row : rows) {
    alone.steps.push_back(odometry::displacement_of({row.path, row.slip, row.turn}));
    alone.Q.push_back(
        odometry::row_covariance(drive, row.row, row.part, row.duration, robot, noise));
  }
  alone.recorded = lay(rows, alone.steps);
  return alone;
}

/// All of a segment's noise but Q.
SegmentNoise noise_at(const std::vector<SegmentRow>& rows, const RowsAlone& alone,
                      const Noise& noise, const std::vector<Eigen::Vector3d>& missing) {
  SegmentNoise result;
  result.recorded = alone.recorded.numbers;
  std::optional<Path> moved;
  if (!missing.empty()) {
    std::vector<Pose> steps = alone.steps;
    for (std::size_t k = 0; k < missing.size(); ++k) {
      steps[k].x += missing[k][0];
      steps[k].y += missing[k][1];
      steps[k].heading += missing[k][2];
    }
    moved = lay(rows, steps);
  }
  const Path& path = moved ? *moved : alone.recorded;
  result.value = path.numbers;
  result.H.resize(rows.size());
  const Vector2 end = path.reached.empty() ? Vector2(Vector2::Zero()) : path.reached.back();
  const int readings = alone.readings;
  int after = 0;
  for (std::size_t k = rows.size(); k-- > 0;) {
    if (!std::isnan(rows[k].reading)) ++after;
    Eigen::Matrix<double, 4, 3>& H = result.H[k];
    H.setZero();
    H.topLeftCorner<2, 2>() = path.turned[k];
    H.block<2, 1>(0, 2) = quarter_turn(end - path.reached[k]);
    H(2, 2) = 1.0;
    if (readings > 0) H(3, 2) = -static_cast<double>(after) / readings;
    result.covariance += H * alone.Q[k] * H.transpose();
    if (k < missing.size()) result.value -= H * missing[k];
  }
  result.covariance.diagonal().head<3>().array() += kLeastSd * kLeastSd;
  if (readings > 0) {
    result.covariance(3, 3) += noise.compass * noise.compass / readings + kLeastSd * kLeastSd;
  }
  return result;
}

}  // namespace

SegmentNoise segment_noise(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                           const Robot& robot, const Noise& noise,
                           const std::vector<Eigen::Vector3d>& missing) {
  RowsAlone alone = rows_alone(drive, rows, robot, noise);
  SegmentNoise result = noise_at(rows, alone, noise, missing);
  result.Q = std::move(alone.Q);
  return result;
}

namespace {

/// Of one segment: from n = 0; the second look takes H where the first found n.
SegmentNoise believed(const RecordingProblem& problem, std::size_t k,
                      const std::vector<SegmentRow>& rows, const RowsAlone& alone,
                      const Noise& noise, const RecordingState& state) {
  const Measurement& one = problem.measurements[k];
  const Matrix4 within = problem.within.empty() ? Matrix4(Matrix4::Zero()) : problem.within[k];
  const Pose& from = state.poses[idx(one.from - problem.landmark_count())];
  const Pose& to = state.poses[idx(one.to - problem.landmark_count())];
  const Vector2 chord = rotation(-from.heading) * (to.position() - from.position());
  const Vector4 z = Vector4(chord.x(), chord.y(), to.heading - from.heading, from.heading) -
                    lasting_in_segment(problem, k, state.noise);
  std::vector<Eigen::Vector3d> missing;
  SegmentNoise at = noise_at(rows, alone, noise, missing);
  for (int look = 0; look < 2; ++look) {
    Vector4 error = z - at.value;
    error[3] = wrap_angle(error[3]);
    const Matrix4 W = whitener_of(at.covariance + within, one.rows);
    const Vector4 pull = W.transpose() * (W * error);
    missing.resize(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row) {
      missing[row] = alone.Q[row] * at.H[row].transpose() * pull;
    }
    at = noise_at(rows, alone, noise, missing);
  }
  return at;
}

}  // namespace

SegmentNoise believed_noise(const RecordingProblem& problem, std::size_t k,
                            const std::vector<DrivenRecording>& recordings, const Model& model,
                            const std::vector<effects::DrivePattern>& effects,
                            const RecordingState& state) {
  const Measurement& one = problem.measurements[k];
  const std::vector<SegmentRow> rows = with_effects(problem.segments[one.source], effects);
  const RowsAlone alone =
      rows_alone(recordings[idx(one.session)].drive, rows, model.robot, model.noise);
  return believed(problem, k, rows, alone, model.noise, state);
}

double relinearise(RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
                   const Model& model, const EffectParameters& border,
                   const Eigen::VectorXd& offsets, const RecordingState& state) {
  const std::vector<std::vector<effects::DrivePattern>> effects =
      summed_patterns(border, offsets, recordings.size());
  std::vector<double> changes(problem.measurements.size(), 0.0);
  parallel::parallel_for(problem.measurements.size(), [&](std::size_t k) {
    Measurement& one = problem.measurements[k];
    if (!is_segment(one)) return;
    const SegmentNoise at =
        believed_noise(problem, k, recordings, model, effects[idx(one.session)], state);
    const Matrix4 within = problem.within.empty() ? Matrix4(Matrix4::Zero()) : problem.within[k];
    Vector4 value_offset = at.value - at.recorded;
    value_offset[3] = one.rows == 4 ? wrap_angle(value_offset[3]) : 0.0;
    const Vector4 change = one.whitener * (value_offset - one.value_offset);
    changes[k] = change.cwiseAbs().maxCoeff();
    one.value_offset = value_offset;
    one.whitener = whitener_of(at.covariance + within, one.rows);
  });
  return changes.empty() ? 0.0 : *std::max_element(changes.begin(), changes.end());
}

}  // namespace trussmap::estimation
