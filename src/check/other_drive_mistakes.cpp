// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/other_drive_mistakes.hpp"

#include "drive/wheel_kinematics.hpp"
#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap::check {
namespace {

class List {
 public:
  explicit List(std::size_t columns) : columns_(columns) {}

  void negated(const std::vector<std::size_t>& which, const char* kind) {
    OtherDriveMistake one = none(kind);
    for (const std::size_t k : which) one.factor[k] = -1.0;
    all_.push_back(std::move(one));
  }
  void scaled(std::size_t which, double factor, const char* kind) {
    all_.push_back(none(kind));
    all_.back().factor[which] = factor;
  }
  void ordered(const std::vector<std::size_t>& order) {
    all_.push_back(none("wheels exchanged"));
    all_.back().order = order;
  }
  void exchanged(std::size_t a, std::size_t b) {
    std::vector<std::size_t> order = none("").order;
    std::swap(order[a], order[b]);
    ordered(order);
  }
  [[nodiscard]] std::vector<OtherDriveMistake> take() { return std::move(all_); }

 private:
  [[nodiscard]] OtherDriveMistake none(const char* kind) const {
    OtherDriveMistake one{kind, std::vector<std::size_t>(columns_),
                          std::vector<double>(columns_, 1.0)};
    std::iota(one.order.begin(), one.order.end(), 0U);
    return one;
  }

  std::size_t columns_;
  std::vector<OtherDriveMistake> all_;
};

std::string names_of(const std::vector<std::size_t>& which, const Robot& robot) {
  std::string names;
  for (const std::size_t k : which) names += (names.empty() ? "" : ", ") + robot.columns[k];
  return names;
}

/// Columns of the left side, then those of the right one; of robots that have sides.
std::vector<std::vector<std::size_t>> sides_of(const Robot& robot) {
  if (robot.drive == DriveKind::mecanum) return {{0, 2}, {1, 3}};
  if (robot.drive != DriveKind::skid_steer || robot.columns.size() == 2) return {};
  std::vector<std::size_t> all(robot.columns.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto half = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  return {{all.begin(), half}, {half, all.end()}};
}

bool is_exchange(const OtherDriveMistake& mistake) {
  return !std::is_sorted(mistake.order.begin(), mistake.order.end());
}

/// The columns' names in the order in which they seem to be recorded.
std::string recorded_order(const OtherDriveMistake& mistake, const Robot& robot) {
  return names_of(mistake.order, robot);
}

}  // namespace

std::vector<std::size_t> OtherDriveMistake::columns() const {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] != k || factor[k] != 1.0) result.push_back(k);
  }
  return result;
}

std::vector<OtherDriveMistake> other_drive_mistakes(const Robot& robot) {
  const std::size_t count = robot.columns.size();
  List list(count);
  if (robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann) {
    list.scaled(1, -1.0, "steering clockwise");
    list.scaled(1, geometry::kDegree, "angle unit");
    list.scaled(1, -geometry::kDegree, "angle unit");
    list.negated({0}, "wheel negated");
    list.exchanged(0, 1);
    return list.take();
  }
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  for (const std::size_t k : all) list.negated({k}, "wheel negated");
  list.negated(all, "wheels negated");
  for (const std::vector<std::size_t>& side : sides_of(robot)) {
    list.negated(side, "wheels negated");
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) list.exchanged(a, b);
  }
  if (count == 3) {
    list.ordered({1, 2, 0});
    list.ordered({2, 0, 1});
  }
  if (count == 4) {
    list.ordered({1, 0, 3, 2});
    list.ordered({2, 3, 0, 1});
    list.ordered({3, 2, 1, 0});
  }
  return list.take();
}

std::string in_words(const OtherDriveMistake& mistake, const Robot& robot) {
  const std::vector<std::size_t> columns = mistake.columns();
  if (is_exchange(mistake)) {
    return columns.size() == 2 ? names_of({columns[0]}, robot) + " and " +
                                     names_of({columns[1]}, robot) + " exchanged"
                               : "columns in the order " + recorded_order(mistake, robot);
  }
  const double factor = mistake.factor[columns.front()];
  if (std::abs(factor) == 1.0) return "the sign of " + names_of(columns, robot) + " changed";
  return names_of(columns, robot) + " in degrees" + (factor < 0.0 ? ", to the right" : "");
}

std::string remedy_of(const OtherDriveMistake& mistake, const Robot& robot) {
  const std::vector<std::size_t> columns = mistake.columns();
  if (is_exchange(mistake)) {
    return columns.size() == 2
               ? "exchange " + names_of({columns[0]}, robot) + " and " +
                     names_of({columns[1]}, robot) + ", in drive.csv or in the model's columns"
               : "name the columns in the order " + recorded_order(mistake, robot) +
                     " in the model, or exchange them";
  }
  const double factor = mistake.factor[columns.front()];
  if (std::abs(factor) == 1.0) return "change the sign of " + names_of(columns, robot);
  return "convert " + names_of(columns, robot) + " to radians" +
         (factor < 0.0 ? ", and change its sign: left positive" : "");
}

std::optional<MotionRows> drive_without(const OtherDriveMistake& mistake, const MotionRows& drive,
                                        const Robot& robot) {
  const drive::WheelKinematics kinematics(robot);
  MotionRows result;
  result.t = drive.t;
  kinematics.prepare(result, drive.rows());
  bool same = true;
  for (std::size_t k = 0; k < result.wheels.size(); ++k) {
    result.wheels[k].reading = drive.wheels[mistake.order[k]].reading;
    for (double& reading : result.wheels[k].reading) reading *= mistake.factor[k];
  }
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9; };
  for (std::size_t row = 0; row < result.rows(); ++row) {
    if (!kinematics.move(result, row)) return std::nullopt;
    same = same && near(result.forward[row], drive.forward[row]) &&
           near(result.turn[row], drive.turn[row]) && near(result.slip(row), drive.slip(row));
  }
  if (same) return std::nullopt;
  return result;
}

}  // namespace trussmap::check
