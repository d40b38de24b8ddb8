// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "monitor/leg_filter.hpp"

#include "drive/unit_arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

namespace trussmap::monitor {
namespace {

/// What nothing has told: a variance that is as good as none knowledge, rad^2.
constexpr double kUntold = 100.0;
/// Places nearer to each other than so many of their standard deviations tell no direction.
constexpr double kClearlyApart = 10.0;

/// A heading that is told with more variance than this does not err a little, rad^2.
constexpr double kBadlyKnown = 0.1;

/// Two rows of a matrix, turned by R.
template <typename Rows>
void turn_rows(Rows&& rows, const Matrix2& R) {
  const auto turned = (R * rows).eval();
  rows = turned;
}

}  // namespace

LegFilter::LegFilter(const std::vector<NoiseProcess>& lasting, int capacity, Eigen::Index columns)
    : lasting_(lasting.begin(), lasting.end()),
      lasting_count_(static_cast<Eigen::Index>(lasting.size())),
      kept_(static_cast<std::size_t>(capacity)) {
  const Eigen::Index size = point_at(kept_.size());
  x_ = Eigen::VectorXd::Zero(size);
  P_ = Eigen::MatrixXd::Zero(size, size);
  U_ = Eigen::MatrixXd::Zero(size, columns);
  for (Eigen::Index k = 0; k < lasting_count_; ++k) {
    P_(k, k) = lasting_[static_cast<std::size_t>(k)].first_variance();
  }
}

void LegFilter::set_columns(Eigen::Index count) {
  if (count > columns_) U_.middleCols(columns_, count - columns_).setZero();
  columns_ = count;
}

void LegFilter::drop_columns(Eigen::Index first, Eigen::Index count) {
  for (Eigen::Index k = first; k + count < columns_; ++k) U_.col(k) = U_.col(k + count);
  columns_ -= count;
}

/// Lasting errors become those of the next leg.
void LegFilter::go_on(const LegReckoning& leg) {
  for (Eigen::Index k = 0; k < lasting_count_; ++k) {
    const LastingError::Step step = lasting_[static_cast<std::size_t>(k)].next(leg);
    if (step.rho != 1.0) {
      x_[k] *= step.rho;
      P_.row(k) *= step.rho;
      P_.col(k) *= step.rho;
      U_.row(k).head(columns_) *= step.rho;
    }
    P_(k, k) += step.variance;
  }
}

void LegFilter::drive(const LegReckoning& leg, const LegColumns& effects,
                      const LegColumns& lasting) {
  go_on(leg);
  // The leg as lasting errors are believed to have changed it.
  const LegVector more = lasting * x_.head(lasting_count_);
  const Vector2 d = leg.displacement.position() + more.head<2>();
  const double a = leg.displacement.heading + more[2];
  const Matrix2 back = rotation(-a);

  // F: points turn about the robot; the heading of the start goes on in y.
  const auto mean = mean_at();
  const double start_heading = x_[heading_at()];
  P_.row(mean) = P_.row(heading_at());
  P_.col(mean) = P_.col(heading_at());
  U_.row(mean).head(columns_) = U_.row(heading_at()).head(columns_);
  forget(excess_at(), 1);
  x_[mean] = start_heading + more[kLegMeanHeading];
  x_[excess_at()] = leg.excess + more[kLegExcess];
  x_[heading_at()] += a;

  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(states(), 5);
  J(mean, kLegMeanHeading) = 1.0;
  J(excess_at(), kLegExcess) = 1.0;
  J(heading_at(), 2) = 1.0;
  const auto move = [&](Eigen::Index at) {
    const Vector2 moved = back * (x_.segment<2>(at) - d);
    x_.segment<2>(at) = moved;
    turn_rows(P_.middleRows<2>(at), back);
    turn_rows(P_.middleCols<2>(at).transpose(), back);
    turn_rows(U_.block(at, 0, 2, columns_), back);
    J.block<2, 2>(at, 0) = -back;
    J.block<2, 1>(at, 2) = -quarter_turn(moved);
  };
  if (place_known_) move(anchor_at());
  for (const auto& [landmark, slot] : slots_) move(point_at(slot));

  const Eigen::MatrixXd by_lasting = J * lasting;
  for (Eigen::Index k = 0; k < lasting_count_; ++k) {
    const Eigen::RowVectorXd row = P_.row(k);
    P_.noalias() += by_lasting.col(k) * row;
    const Eigen::VectorXd col = P_.col(k);
    P_.noalias() += col * by_lasting.col(k).transpose();
    by_effects().noalias() += by_lasting.col(k) * U_.row(k).head(columns_).eval();
  }
  P_.noalias() += J * leg.covariance * J.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  const Eigen::MatrixXd by = J * effects;
  for (Eigen::Index first = 0; first < columns_; first += effects.cols()) {
    U_.middleCols(first, effects.cols()) += by;
  }
}

void LegFilter::put_point(Eigen::Index at, const Vector2& value, const Matrix2& covariance) {
  forget(at, 2);
  x_.segment<2>(at) = value;
  P_.block<2, 2>(at, at) = covariance;
}

void LegFilter::forget(Eigen::Index at, Eigen::Index count) {
  x_.segment(at, count).setZero();
  P_.middleRows(at, count).setZero();
  P_.middleCols(at, count).setZero();
  U_.middleRows(at, count).setZero();
}

void LegFilter::update(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& H,
                       const Eigen::MatrixXd& R, const Eigen::RowVectorXd& direct,
                       const Said& said) {
  const Eigen::MatrixXd PH = P_ * H.transpose();
  const Eigen::LLT<Eigen::MatrixXd> S(H * PH + R);
  if (S.info() != Eigen::Success) return;  // the same, measured exactly twice
  Eigen::MatrixXd by = H * by_effects();
  for (Eigen::Index first = 0; direct.size() > 0 && first < columns_; first += direct.size()) {
    by.middleCols(first, direct.size()).rowwise() += direct;
  }
  said(S.matrixL().solve(innovation), S.matrixL().solve(by));
  const Eigen::MatrixXd half = S.matrixL().solve(PH.transpose());  // K = half' L^-1
  const Eigen::MatrixXd K = S.matrixU().solve(half).transpose();
  P_.noalias() -= half.transpose() * half;
  by_effects().noalias() -= K * by;
  move_state(K * innovation);
}

/// As far as the heading turns, the points turn about the robot, exactly; and what errors are left
/// are reckoned from where they are then: exp(e) = exp(e') exp(moved), to first order in e'.
void LegFilter::move_state(const Eigen::VectorXd& more) {
  const double turn = -more[heading_at()];
  const drive::UnitArc arc = drive::unit_arc(turn);
  Matrix2 V;
  V << arc.end, quarter_turn(arc.end);
  x_.head(anchor_at()) += more.head(anchor_at());
  x_.segment<2>(mean_at()) += more.segment<2>(mean_at());
  const auto move = [&](Eigen::Index at) {
    const Vector2 moved = V * more.segment<2>(at);
    x_.segment<2>(at) += moved;
    const Vector2 by_heading = -0.5 * quarter_turn(moved);
    turn_rows(P_.middleRows<2>(at), V);
    P_.middleRows<2>(at) += by_heading * P_.row(heading_at());
    turn_rows(P_.middleCols<2>(at).transpose(), V);
    P_.middleCols<2>(at) += P_.col(heading_at()) * by_heading.transpose();
    turn_rows(U_.block(at, 0, 2, columns_), V);
    U_.block(at, 0, 2, columns_) += by_heading * U_.row(heading_at()).head(columns_);
  };
  if (place_known_) move(anchor_at());
  for (const auto& [landmark, slot] : slots_) move(point_at(slot));
}

/// A point is seen `off` from where it is believed to be: H (errors), reckoned from where it is
/// seen. What the heading's error turns of it counts half: as far as `off` tells that error it is
/// taken off, the rest is noise. The legs' innovations are white by that to a few hundredths of
/// their standard deviation; without, those of robots with noisy wheels are not.
void LegFilter::meet(Vector2 off, Eigen::MatrixXd H, Matrix2 R, const Said& said) {
  Eigen::MatrixXd near = H;
  near.col(heading_at()) -= quarter_turn(off);
  const Eigen::MatrixXd PH = P_ * near.transpose();
  const Matrix2 S = near * PH + R;
  const Eigen::RowVector2d gain = PH.row(heading_at()) * S.inverse();
  const double told = gain * PH.row(heading_at()).transpose();
  if (told < kBadlyKnown) {
    H = near;
    const double turn = -gain.dot(off);
    off += 0.5 * turn * quarter_turn(off);
    // Of a straight leg a third as much of the heading's error is not told as is told.
    const double rest = std::min(P_(heading_at(), heading_at()) - told, told / 3.0);
    const Matrix2 across = rotation(0.5 * std::numbers::pi);
    R += 0.25 * rest * across * S * across.transpose();
  }
  update(off, H, R, {}, said);
}

/// The heading, known from where the robot started until now, is told in map axes: as if it had
/// been known badly before.
void LegFilter::tell_heading(double more) {
  for (const Eigen::Index k : {heading_at(), mean_at()}) {
    x_[k] += more;
    P_(k, heading_at()) += kUntold;
    P_(k, mean_at()) += kUntold;
  }
  heading_known_ = true;
}

void LegFilter::read_compass(const LegReckoning& leg, double sd, const Eigen::RowVectorXd& by,
                             const Said& said) {
  if (leg.readings == 0) return;
  if (!heading_known_) tell_heading(leg.heading - x_[mean_at()]);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, states());
  H(0, mean_at()) = 1.0;
  for (Eigen::Index k = 0; k < lasting_count_; ++k) {
    if (lasting_[static_cast<std::size_t>(k)].channel() == Channel::compass) H(0, k) = 1.0;
  }
  const double expected = (H.row(0).head(mean_at() + 1) * x_.head(mean_at() + 1)).value();
  update(Eigen::VectorXd::Constant(1, wrap_angle(leg.heading - expected)), H,
         Eigen::MatrixXd::Constant(1, 1, sd * sd / leg.readings), by, said);
}

void LegFilter::read_gyro(const Said& said) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, states());
  H(0, excess_at()) = 1.0;
  if (!(P_(excess_at(), excess_at()) > 0.0)) return;
  update(-x_.segment<1>(excess_at()), H, Eigen::MatrixXd::Zero(1, 1), {}, said);
}

void LegFilter::know_heading(double heading, double variance, const Said& said) {
  if (!heading_known_) {
    tell_heading(heading - x_[heading_at()]);
  }
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, states());
  H(0, heading_at()) = 1.0;
  update(Eigen::VectorXd::Constant(1, wrap_angle(heading - x_[heading_at()])), H,
         Eigen::MatrixXd::Constant(1, 1, variance), {}, said);
}

/// o becomes the point of the map where the robot is believed to be: so it has no lever.
void LegFilter::anchor_near() {
  const Vector2 from_anchor = -x_.segment<2>(anchor_at());
  anchor_map_ += rotation(x_[heading_at()]) * from_anchor;
  // o' = o + R(-psi)(X' - X): 0, and turned the other way by psi.
  const Vector2 by_heading = -quarter_turn(from_anchor);
  x_.segment<2>(anchor_at()).setZero();
  const Eigen::MatrixXd rows = by_heading * P_.row(heading_at());
  P_.middleRows<2>(anchor_at()) += rows;
  const Eigen::MatrixXd cols = P_.col(heading_at()) * by_heading.transpose();
  P_.middleCols<2>(anchor_at()) += cols;
  U_.block(anchor_at(), 0, 2, columns_) += by_heading * U_.row(heading_at()).head(columns_);
}

/// p = o + R(-psi)(X - X_o), up to what place and sighting leave open. `point` < 0: the robot's own
/// place, at `fixed`.
void LegFilter::compare_with_map(Eigen::Index point, const Vector2& fixed, const MapPlace& place,
                                 const Said& said) {
  const auto at = [&] { return point < 0 ? fixed : Vector2(x_.segment<2>(point)); };
  if (!place_known_) {
    forget(anchor_at(), 2);
    x_.segment<2>(anchor_at()) = at();
    if (point >= 0) {
      P_.middleRows<2>(anchor_at()) = P_.middleRows<2>(point);
      P_.middleCols<2>(anchor_at()) = P_.middleCols<2>(point);
      U_.block(anchor_at(), 0, 2, columns_) = U_.block(point, 0, 2, columns_);
    }
    P_.block<2, 2>(anchor_at(), anchor_at()) += place.covariance;
    anchor_map_ = place.position;
    place_known_ = true;
    return;
  }
  const Vector2 apart = place.position - anchor_map_;
  if (!heading_known_) {
    const double unsure =
        place.covariance.trace() + P_.block<2, 2>(anchor_at(), anchor_at()).trace();
    if (apart.squaredNorm() < kClearlyApart * kClearlyApart * unsure) return;
    const Vector2 between = at() - x_.segment<2>(anchor_at());
    tell_heading(direction(apart) - direction(between) - x_[heading_at()]);
  }
  const Matrix2 back = rotation(-x_[heading_at()]);
  const Vector2 seen = back * apart;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, states());
  H.middleCols<2>(anchor_at()) = Matrix2::Identity();
  H.col(heading_at()) = -quarter_turn(seen);
  if (point >= 0) H.middleCols<2>(point) = -Matrix2::Identity();
  meet(at() - x_.segment<2>(anchor_at()) - seen, std::move(H),
       back * place.covariance * back.transpose(), said);
  anchor_near();
}

void LegFilter::know_place(const MapPlace& place, const Said& said) {
  compare_with_map(-1, Vector2::Zero(), place, said);
}

/// Where the landmark is kept, or may be: then the one not seen for longest is forgotten.
std::size_t LegFilter::slot_for(const std::string& landmark, bool& known) {
  const auto found = slots_.find(landmark);
  known = found != slots_.end();
  std::size_t slot = known ? found->second : 0;
  if (!known) {
    slot = static_cast<std::size_t>(
        std::min_element(kept_.begin(), kept_.end(),
                         [](const Kept& a, const Kept& b) { return a.seen < b.seen; }) -
        kept_.begin());
    slots_.erase(kept_[slot].landmark);
    slots_[landmark] = slot;
    kept_[slot].landmark = landmark;
  }
  kept_[slot].seen = ++calls_;
  return slot;
}

void LegFilter::see(const std::string& landmark, const LandmarkOffset& seen,
                    const MapPlace* surveyed, const Said& said) {
  bool known = false;
  const Eigen::Index at = point_at(slot_for(landmark, known));
  if (known) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, states());
    H.middleCols<2>(at) = Matrix2::Identity();
    meet(seen.offset_robot - x_.segment<2>(at), std::move(H), seen.covariance_robot, said);
    return;
  }
  put_point(at, seen.offset_robot, seen.covariance_robot);
  if (surveyed != nullptr) compare_with_map(at, Vector2::Zero(), *surveyed, said);
}

void LegFilter::believe(Eigen::Index column, double coefficient, double variance,
                        const NoiseProcess& rest) {
  const Eigen::VectorXd u = U_.col(column);
  x_ += coefficient * u;
  add_lasting(u, variance, rest);
}

void LegFilter::expect(double variance, const NoiseProcess& rest) {
  add_lasting(Eigen::VectorXd::Zero(states()), variance, rest);
}

/// An error of this variance, of which one unit has added `u` to what is believed: it stands behind
/// the other lasting ones.
void LegFilter::add_lasting(const Eigen::VectorXd& u, double variance, const NoiseProcess& rest) {
  const Eigen::Index size = states() + 1;
  const Eigen::Index tail = states() - lasting_count_;
  Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd more(size);
  more << u.head(lasting_count_), 1.0, u.tail(tail);
  Q.topLeftCorner(lasting_count_, lasting_count_) =
      P_.topLeftCorner(lasting_count_, lasting_count_);
  Q.topRightCorner(lasting_count_, tail) = P_.topRightCorner(lasting_count_, tail);
  Q.bottomLeftCorner(tail, lasting_count_) = P_.bottomLeftCorner(tail, lasting_count_);
  Q.bottomRightCorner(tail, tail) = P_.bottomRightCorner(tail, tail);
  Q += variance * more * more.transpose();
  Eigen::VectorXd y(size);
  y << x_.head(lasting_count_), 0.0, x_.tail(tail);
  x_ = std::move(y);
  P_ = std::move(Q);
  U_ = Eigen::MatrixXd::Zero(size, U_.cols());
  columns_ = 0;
  lasting_.emplace_back(rest);
  ++lasting_count_;
}

}  // namespace trussmap::monitor
