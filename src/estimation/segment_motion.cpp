// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/segment_motion.hpp"

#include "drive/unit_arc.hpp"
#include "odometry/row_reckoner.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {
namespace {

constexpr double kLeastSegmentSd = 1e-5;  // m and rad

/// A row's motion under the effects.
struct Step {
  double path = 0.0;
  double slip = 0.0;
  double turn = 0.0;
  double compass = 0.0;

  [[nodiscard]] Vector2 end(const drive::UnitArc& arc) const {
    return path * arc.end + slip * quarter_turn(arc.end);
  }
  /// Its derivative by the turn.
  [[nodiscard]] Vector2 slope(const drive::UnitArc& arc) const {
    return path * arc.slope + slip * quarter_turn(arc.slope);
  }
};

/// Mean of angles that lie near each other, wherever whole turns put them.
class MeanAngle {
 public:
  void add(double angle) {
    if (count_ == 0) first_ = angle;
    sum_ += wrap_angle(angle - first_);
    ++count_;
  }
  [[nodiscard]] double mean() const {
    return count_ == 0 ? kAbsent : wrap_angle(first_ + sum_ / count_);
  }

 private:
  double first_ = 0.0;
  double sum_ = 0.0;
  int count_ = 0;
};

/// An effect that acts on the drive: what a unit of it does in each row, and has done so far.
struct Acting {
  const std::vector<effects::DrivePattern>& rows;
  Eigen::Index place;
  double coefficient;
  Vector2 moved = Vector2::Zero();
  double turned = 0.0;
  double read = 0.0;  ///< sum over the readings
};

std::vector<Acting> acting_among(
    const std::vector<const std::vector<effects::DrivePattern>*>& patterns,
    const Eigen::VectorXd& coefficients) {
  std::vector<Acting> result;
  for (Eigen::Index k = 0; k < coefficients.size(); ++k) {
    const auto* rows = patterns[static_cast<std::size_t>(k)];
    if (rows != nullptr && !rows->empty()) result.push_back({*rows, k, coefficients[k]});
  }
  return result;
}

Step step_of(const SegmentRow& row, const std::vector<Acting>& effects) {
  Step step{row.path, row.slip, row.turn, 0.0};
  for (const Acting& one : effects) {
    const effects::DrivePattern& unit = one.rows[row.row];
    const double g = one.coefficient * row.part;
    step.path += g * unit.advance;
    step.slip += g * unit.slip;
    step.turn += g * unit.turn;
    step.compass += one.coefficient * unit.compass;
  }
  return step;
}

}  // namespace

std::vector<SegmentRow> segment_rows(const MotionRows& drive, double from, double to) {
  std::vector<SegmentRow> rows;
  for (const odometry::DriveRow& row : odometry::rows_between(drive, from, to)) {
    const BodyMotion motion = odometry::motion_of(drive, row);
    const double reading = drive.has_compass() && row.ends ? drive.heading[row.row] : kAbsent;
    rows.push_back(
        {row.row, row.part, motion.forward, motion.turn, row.duration, reading, motion.sideways});
  }
  return rows;
}

int readings_of(const std::vector<SegmentRow>& rows) {
  int count = 0;
  for (const SegmentRow& row : rows) count += std::isnan(row.reading) ? 0 : 1;
  return count;
}

SegmentRow with_effects(SegmentRow row, const std::vector<effects::DrivePattern>& sum) {
  if (sum.empty()) return row;
  const effects::DrivePattern& more = sum[row.row];
  row.path += row.part * more.advance;
  row.slip += row.part * more.slip;
  row.turn += row.part * more.turn;
  row.reading -= more.compass;
  return row;
}

std::vector<SegmentRow> with_effects(std::vector<SegmentRow> rows,
                                     const std::vector<effects::DrivePattern>& sum) {
  for (SegmentRow& row : rows) row = with_effects(row, sum);
  return rows;
}

SegmentMotion segment_motion(const std::vector<SegmentRow>& rows) {
  return segment_motion(rows, {}, Eigen::VectorXd()).motion;
}

SegmentWithEffects segment_motion(
    const std::vector<SegmentRow>& rows,
    const std::vector<const std::vector<effects::DrivePattern>*>& patterns,
    const Eigen::VectorXd& coefficients) {
  std::vector<Acting> effects = acting_among(patterns, coefficients);
  Pose pose;
  drive::RowHeading R;
  MeanAngle mean;
  int readings = 0;
  for (const SegmentRow& row : rows) {
    const Step step = step_of(row, effects);
    const drive::UnitArc arc = drive::unit_arc(step.turn);
    const Vector2 ahead = row.part * (R * arc.end);
    const Vector2 turning = row.part * (R * step.slope(arc));
    const Vector2 chord = R * step.end(arc);
    for (Acting& one : effects) {
      const effects::DrivePattern& unit = one.rows[row.row];
      one.moved += one.turned * quarter_turn(chord) + unit.advance * ahead +
                   unit.slip * quarter_turn(ahead) + unit.turn * turning;
      one.turned += row.part * unit.turn;
    }
    pose.x += chord.x();
    pose.y += chord.y();
    pose.heading += step.turn;
    R.turn(step.turn, arc);
    if (std::isnan(row.reading)) continue;
    ++readings;
    mean.add(row.reading - step.compass - pose.heading);
    for (Acting& one : effects) one.read -= one.turned + one.rows[row.row].compass;
  }
  Eigen::Matrix<double, 4, Eigen::Dynamic> slopes =
      Eigen::Matrix<double, 4, Eigen::Dynamic>::Zero(4, coefficients.size());
  for (const Acting& one : effects) {
    slopes.col(one.place) << one.moved, one.turned, one.read / std::max(readings, 1);
  }
  return {{pose, mean.mean()}, slopes};
}

std::vector<Matrix4> row_influences(const std::vector<SegmentRow>& rows) {
  std::vector<Matrix4> influences(rows.size(), Matrix4::Zero());
  std::vector<Vector2> ends(rows.size());
  Pose pose;
  drive::RowHeading R;
  const int readings = readings_of(rows);
  int read = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SegmentRow& row = rows[k];
    const Step step{row.path, row.slip, row.turn};
    const drive::UnitArc arc = drive::unit_arc(step.turn);
    Matrix4& own = influences[k];
    own.block<2, 1>(0, 0) = row.part * (R * arc.end);
    own.block<2, 1>(0, 1) = quarter_turn(own.block<2, 1>(0, 0));
    own.block<2, 1>(0, 2) = row.part * (R * step.slope(arc));
    own(2, 2) = row.part;
    const Vector2 chord = R * step.end(arc);
    pose.x += chord.x();
    pose.y += chord.y();
    pose.heading += step.turn;
    R.turn(step.turn, arc);
    ends[k] = pose.position();
    if (readings == 0) continue;
    own(3, 2) = -row.part * (readings - read) / readings;  // this row's own and all later ones
    if (std::isnan(row.reading)) continue;
    ++read;
    own(3, 3) = -1.0 / readings;
  }
  // A turn swings all that comes after it.
  for (std::size_t k = 0; k < rows.size(); ++k) {
    influences[k].block<2, 1>(0, 2) += rows[k].part * quarter_turn(pose.position() - ends[k]);
  }
  return influences;
}

Matrix4 segment_covariance(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                           const Robot& robot, const Noise& noise) {
  Matrix4 P = Matrix4::Zero();  // of (x, y, a, S)
  Pose pose;
  int readings = 0;
  for (const SegmentRow& row : rows) {
    const Matrix3 T = pose_rotation(pose.heading);
    const Pose step = odometry::displacement_of({row.path, row.slip, row.turn});
    Matrix4 F = Matrix4::Identity();
    F.block<2, 1>(0, 2) = quarter_turn(T.topLeftCorner<2, 2>() * step.position());
    P = F * P * F.transpose();
    P.topLeftCorner<3, 3>() +=
        T * odometry::row_covariance(drive, row.row, row.part, row.duration, robot, noise) *
        T.transpose();
    pose = compose(pose, step);
    if (std::isnan(row.reading)) continue;
    ++readings;
    P.row(3) += P.row(2);
    P.col(3) += P.col(2);
  }
  P.diagonal().head<3>().array() += kLeastSegmentSd * kLeastSegmentSd;
  if (readings > 0) {
    P.row(3) /= -readings;
    P.col(3) /= -readings;
    P(3, 3) += noise.compass * noise.compass / readings + kLeastSegmentSd * kLeastSegmentSd;
  } else {
    P.row(3).setZero();
    P.col(3).setZero();
  }
  return 0.5 * (P + P.transpose());
}

}  // namespace trussmap::estimation
