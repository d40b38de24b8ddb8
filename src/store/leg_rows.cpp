// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/leg_rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace trussmap::store {
namespace {

constexpr int kCallKinds = 5;

StoredLeg::Kind kind_of(std::int64_t number) {
  if (number < 0 || number >= kCallKinds) throw std::invalid_argument("a leg of no kind");
  return static_cast<StoredLeg::Kind>(number);
}

Arrival::Kind outcome_of(std::int64_t number) {
  if (number < 0 || number > static_cast<std::int64_t>(Arrival::Kind::found_again)) {
    throw std::invalid_argument("a leg of no outcome");
  }
  return static_cast<Arrival::Kind>(number);
}

/// -1: null.
std::int64_t number_in(const text::RowReader& row, int column) {
  return row.is_null(column) ? -1 : row.integer(column);
}

/// 0 where there is none: of which legs have what, their kind tells.
double figure_at(const text::RowReader& row, int column) {
  const double value = row.real(column);
  if (!std::isfinite(value)) throw std::invalid_argument("a leg that is not finite");
  return value;
}

std::string landmark_in(const text::RowReader& row, int column, const LandmarkGraph& graph) {
  const std::int64_t landmark = number_in(row, column);
  if (landmark >= graph.landmarks()) throw std::invalid_argument("a leg to no landmark");
  return landmark < 0 ? std::string() : graph.landmark(static_cast<int>(landmark)).name;
}

}  // namespace

void create_leg_tables(const Database& database) {
  database.run(R"sql(
    CREATE TABLE sessions(number INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE,
                          name TEXT NOT NULL, first_leg INTEGER NOT NULL, legs INTEGER NOT NULL);
    CREATE TABLE legs(number INTEGER PRIMARY KEY, session INTEGER, kind INTEGER NOT NULL,
                      source INTEGER, target INTEGER, own_axes INTEGER, dx REAL, dy REAL,
                      turn REAL, c_xx REAL, c_xy REAL, c_yy REAL, c_xt REAL, c_yt REAL, c_tt REAL,
                      ox REAL, oy REAL, o_xx REAL, o_xy REAL, o_yy REAL, outcome INTEGER);
  )sql");
}

void put_leg(text::RowWriter& row, const map::BuilderCall& call, std::int64_t number,
             const std::optional<std::int64_t>& session) {
  row.bind(0, number).bind(2, static_cast<int>(call.kind));
  if (session) row.bind(1, *session);
  if (call.from >= 0) row.bind(3, call.from);
  if (call.to >= 0) row.bind(4, call.to);
  row.bind(5, call.reckoned ? 1 : 0);
  if (call.reckoned || call.kind == map::BuilderCall::Kind::compass) {
    const Pose& moved = call.motion.displacement;
    const Matrix3& C = call.motion.covariance;
    row.bind(6, moved.position()).bind(8, moved.heading);
    row.bind(9, Matrix2(C.topLeftCorner<2, 2>())).bind(12, C(0, 2)).bind(13, C(1, 2));
    row.bind(14, C(2, 2));
  } else if (call.kind <= map::BuilderCall::Kind::observe) {
    row.bind(6, call.leg.displacement).bind(9, call.leg.covariance);
  }
  if (call.reckoned || call.kind == map::BuilderCall::Kind::start) {
    row.bind(15, call.seen.offset_robot).bind(17, call.seen.covariance_robot);
  }
  if (call.outcome) row.bind(20, static_cast<int>(*call.outcome));
}

StoredLeg leg_in(const text::RowReader& row, std::int64_t number, const LandmarkGraph& graph,
                 std::int64_t sessions) {
  const auto at = [&row](int column) { return figure_at(row, column); };
  if (row.integer(0) != number) throw std::invalid_argument("a leg that is misnumbered");
  StoredLeg one;
  one.kind = kind_of(row.integer(2));
  one.from = landmark_in(row, 3, graph);
  one.to = landmark_in(row, 4, graph);
  one.own_axes = row.integer(5) != 0;
  one.leg.displacement = {at(6), at(7)};
  one.leg.covariance << at(9), at(10), at(10), at(11);
  one.motion.displacement = {at(6), at(7), at(8)};
  one.motion.covariance << one.leg.covariance, Vector2(at(12), at(13)), at(12), at(13), at(14);
  one.seen.offset_robot = {at(15), at(16)};
  one.seen.covariance_robot << at(17), at(18), at(18), at(19);
  const std::int64_t session = number_in(row, 1);
  if (session >= sessions) throw std::invalid_argument("a leg of no session");
  one.session = static_cast<int>(std::max<std::int64_t>(session, -1));
  if (!row.is_null(20)) one.outcome = outcome_of(row.integer(20));
  return one;
}

std::int64_t legs_in(const Database& database) {
  constexpr std::int64_t kMost = 1'000'000'000'000'000;
  const std::int64_t legs = database.number("SELECT max(number) + 1 FROM legs");
  if (legs < 0 || legs > kMost) throw std::invalid_argument("a leg that is misnumbered");
  return legs;
}

std::int64_t put_session(const Database& database, const StoredSession& session) {
  Statement put(database, "INSERT INTO sessions(key, name, first_leg, legs) VALUES (?, ?, ?, ?)");
  put.bind(0, session.key).bind(1, session.name).bind(2, session.first_leg);
  put.bind(3, session.legs).run();
  return database.number("SELECT max(number) FROM sessions") - 1;
}

// Legs name sessions by their place: none may be missing.
std::vector<StoredSession> sessions_in(const Database& database) {
  Statement rows(database,
                 "SELECT number, key, name, first_leg, legs FROM sessions ORDER BY number");
  std::vector<StoredSession> sessions;
  while (rows.step()) {
    if (rows.integer(0) != std::ssize(sessions) + 1) {
      throw std::invalid_argument("a session that is misnumbered");
    }
    sessions.push_back({rows.text(1), rows.text(2), rows.integer(3), rows.integer(4)});
  }
  return sessions;
}

}  // namespace trussmap::store
