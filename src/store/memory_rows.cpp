// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/memory_rows.hpp"

#include "geometry/index.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

double finite(const Statement& row, int column, const char* what) {
  const double value = row.real(column);
  if (row.is_null(column) || !std::isfinite(value)) refuse(joined(what, " that is no number"));
  return value;
}

Vector2 vector_at(const Statement& row, int column, const char* what) {
  return {finite(row, column, what), finite(row, column + 1, what)};
}

Matrix2 matrix_at(const Statement& row, int column, const char* what) {
  Matrix2 C;
  C(0, 0) = finite(row, column, what);
  C(0, 1) = C(1, 0) = finite(row, column + 1, what);
  C(1, 1) = finite(row, column + 2, what);
  if (!(C(0, 0) > 0.0) || !(C.determinant() > 0.0)) {
    refuse(joined(what, " whose matrix is not positive definite"));
  }
  return C;
}

/// A number from `lowest` to `count` - 1.
int number_at(const Statement& row, int column, int lowest, int count, const char* what) {
  const std::int64_t number = row.integer(column);
  if (row.is_null(column) || number < lowest || number >= count) {
    refuse(joined(what, " of a landmark that is not there"));
  }
  return static_cast<int>(number);
}

/// How often something was measured.
int count_at(const Statement& row, int column, int least, const char* what) {
  constexpr std::int64_t kMost = 1'000'000'000;
  const std::int64_t count = row.integer(column);
  if (row.is_null(column) || count < least || count > kMost) {
    refuse(joined(what, " without traversals"));
  }
  return static_cast<int>(count);
}

Average average_at(const Statement& row, int column, int least, const char* what) {
  Average average;
  average.count = count_at(row, column, least, what);
  average.mean = finite(row, column + 1, what);
  average.variance = finite(row, column + 2, what);
  if (average.count > 0 && !(average.variance > 0.0)) refuse(joined(what, " without variance"));
  return average;
}

bool same(const Average& a, const Average& b) {
  return a.count == b.count && a.mean == b.mean && a.variance == b.variance;
}

bool same(const ReckonedRoute& a, const ReckonedRoute& b) {
  return same(a.length, b.length) && same(a.direction, b.direction) && a.corner == b.corner &&
         a.bar.traversals == b.bar.traversals;
}

bool same_arrival(const LeftOutArrival& a, const LeftOutArrival& b) {
  return a.from == b.from && a.to == b.to && a.sds == b.sds &&
         a.leg.displacement == b.leg.displacement && a.leg.covariance == b.leg.covariance;
}

void bind_average(Statement& put, int column, const Average& average) {
  put.bind(column, average.count).bind(column + 1, average.mean);
  put.bind(column + 2, average.variance);
}

/// What loops hang on must end somewhere.
void check_roots(const std::vector<int>& roots) {
  std::vector<bool> ends(roots.size(), false);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    std::vector<int> way;
    for (int at = static_cast<int>(k); at >= 0 && !ends[idx(at)]; at = roots[idx(at)]) {
      way.push_back(at);
      if (way.size() > roots.size()) refuse("loops that hang on themselves");
    }
    for (const int at : way) ends[idx(at)] = true;
  }
}

}  // namespace

void create_memory_tables(const Database& database) {
  database.run(R"sql(
    CREATE TABLE landmarks(number INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE,
                           x REAL NOT NULL, y REAL NOT NULL, root INTEGER NOT NULL);
    CREATE TABLE routes(number INTEGER PRIMARY KEY, source INTEGER NOT NULL,
                        target INTEGER NOT NULL, traversals INTEGER NOT NULL,
                        stretch REAL NOT NULL, orientation REAL NOT NULL,
                        dx REAL NOT NULL, dy REAL NOT NULL,
                        c_xx REAL NOT NULL, c_xy REAL NOT NULL, c_yy REAL NOT NULL,
                        k_xx REAL, k_xy REAL, k_yy REAL, wx REAL, wy REAL);
    CREATE TABLE reckoned(number INTEGER PRIMARY KEY, route INTEGER NOT NULL,
                          lengths INTEGER NOT NULL, length REAL NOT NULL,
                          length_variance REAL NOT NULL, directions INTEGER NOT NULL,
                          direction REAL NOT NULL, direction_variance REAL NOT NULL,
                          corner INTEGER NOT NULL, traversals INTEGER NOT NULL,
                          stretch REAL NOT NULL, orientation REAL NOT NULL, dx REAL NOT NULL,
                          dy REAL NOT NULL, c_xx REAL NOT NULL, c_xy REAL NOT NULL,
                          c_yy REAL NOT NULL);
    CREATE TABLE corners(number INTEGER PRIMARY KEY, i INTEGER NOT NULL, j INTEGER NOT NULL,
                         k INTEGER NOT NULL, angles INTEGER NOT NULL, angle REAL NOT NULL,
                         variance REAL NOT NULL, arm REAL NOT NULL);
    CREATE TABLE chain(place INTEGER PRIMARY KEY, landmark INTEGER NOT NULL);
    CREATE TABLE misfits(place INTEGER PRIMARY KEY, squared REAL NOT NULL);
    CREATE TABLE left_out(place INTEGER PRIMARY KEY, source INTEGER NOT NULL,
                          target INTEGER NOT NULL, dx REAL NOT NULL, dy REAL NOT NULL,
                          c_xx REAL NOT NULL, c_xy REAL NOT NULL, c_yy REAL NOT NULL,
                          sds REAL NOT NULL);
    CREATE TABLE state(one INTEGER PRIMARY KEY CHECK (one = 1), here INTEGER NOT NULL,
                       said INTEGER NOT NULL, carried_dx REAL, carried_dy REAL, carried_c_xx REAL,
                       carried_c_xy REAL, carried_c_yy REAL, frame INTEGER NOT NULL,
                       first_direction INTEGER NOT NULL, ox REAL NOT NULL, oy REAL NOT NULL,
                       o_xx REAL NOT NULL, o_xy REAL NOT NULL, o_yy REAL NOT NULL, heading REAL,
                       heading_variance REAL, earlier INTEGER, beta REAL, beta_variance REAL,
                       beta_x REAL, beta_y REAL, reading REAL, reading_variance REAL);
    INSERT INTO state(one, here, said, frame, first_direction, ox, oy, o_xx, o_xy, o_yy)
      VALUES (1, -1, -1, 0, -1, 0, 0, 0, 0, 0);
    CREATE VIEW map AS SELECT name AS landmark, x, y FROM landmarks ORDER BY number;
  )sql");
}

MemoryRows::MemoryRows(const Database& database)
    : database_(database),
      put_landmark_(database, "INSERT INTO landmarks VALUES (?, ?, ?, ?, ?)"),
      move_landmark_(database, "UPDATE landmarks SET x = ?, y = ?, root = ? WHERE number = ?"),
      put_route_(database,
                 "REPLACE INTO routes VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      put_reckoned_(database,
                    "REPLACE INTO reckoned VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                    "?)"),
      put_corner_(database, "REPLACE INTO corners VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
      put_link_(database, "REPLACE INTO chain VALUES (?, ?)"),
      cut_chain_(database, "DELETE FROM chain WHERE place >= ?"),
      put_misfit_(database, "REPLACE INTO misfits VALUES (?, ?)"),
      put_left_out_(database, "INSERT INTO left_out VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      put_state_(database,
                 "UPDATE state SET here = ?, said = ?, carried_dx = ?, carried_dy = ?, "
                 "carried_c_xx = ?, carried_c_xy = ?, carried_c_yy = ?, frame = ?, "
                 "first_direction = ?, ox = ?, oy = ?, o_xx = ?, o_xy = ?, o_yy = ?, heading = ?, "
                 "heading_variance = ?, earlier = ?, beta = ?, beta_variance = ?, beta_x = ?, "
                 "beta_y = ?, reading = ?, reading_variance = ?") {}

BuilderMemory MemoryRows::load(const MapBuilderOptions& options) {
  written_ = {};
  BuilderMemory memory(options.gate);
  load_landmarks(memory);
  load_routes(memory, weighs_each(options));
  load_reckoned(memory);
  load_rest(memory);
  load_state(memory);
  return memory;
}

void MemoryRows::load_landmarks(BuilderMemory& memory) {
  Statement rows(database_, "SELECT number, name, x, y, root FROM landmarks ORDER BY number");
  const int count = static_cast<int>(database_.number("SELECT count(*) FROM landmarks"));
  while (rows.step()) {
    if (rows.integer(0) != memory.graph.landmarks()) refuse("a landmark that is misnumbered");
    memory.graph.add_landmark(rows.text(1), vector_at(rows, 2, "a place"));
    written_.positions.push_back(memory.graph.landmark(memory.graph.landmarks() - 1).position);
    written_.roots.push_back(number_at(rows, 4, -1, count, "a loop"));
  }
  // An index that was damaged counts others than there are.
  if (memory.graph.landmarks() != count) refuse("landmarks that are not all there");
  check_roots(written_.roots);
}

void MemoryRows::load_routes(BuilderMemory& memory, bool weighed) {
  Statement rows(database_,
                 "SELECT number, source, target, traversals, stretch, orientation, dx, dy, c_xx, "
                 "c_xy, c_yy, k_xx, k_xy, k_yy, wx, wy FROM routes ORDER BY number");
  const int count = memory.graph.landmarks();
  while (rows.step()) {
    Route route;
    route.source = number_at(rows, 1, 0, count, "a route");
    route.target = number_at(rows, 2, 0, count, "a route");
    if (rows.integer(0) != memory.graph.routes()) refuse("a route that is misnumbered");
    route.traversals = count_at(rows, 3, 1, "a route");
    route.stretch = finite(rows, 4, "a route");
    route.orientation = finite(rows, 5, "a route");
    route.displacement = vector_at(rows, 6, "a route");
    route.covariance = matrix_at(rows, 8, "a route");
    memory.graph.set_route(memory.graph.add_route(route.source, route.target), route);
    if (weighed && rows.is_null(11)) {  // of legs in the robot's own axes alone
      memory.weighed.emplace_back();
    } else if (weighed) {
      memory.weighed.push_back({matrix_at(rows, 11, "a bar"), vector_at(rows, 14, "a bar")});
    }
    written_.routes.push_back({route.traversals, route.orientation});
  }
}

void MemoryRows::load_reckoned(BuilderMemory& memory) {
  const int routes = memory.graph.routes();
  const int count = memory.graph.landmarks();
  Statement corners(database_,
                    "SELECT number, i, j, k, angles, angle, variance, arm FROM corners ORDER BY "
                    "number");
  while (corners.step()) {
    if (corners.integer(0) != std::ssize(memory.corners)) refuse("a corner that is misnumbered");
    CornerAverage one;
    one.i = number_at(corners, 1, 0, count, "a corner");
    one.j = number_at(corners, 2, 0, count, "a corner");
    one.k = number_at(corners, 3, 0, count, "a corner");
    one.angle = average_at(corners, 4, 1, "a corner");
    one.arm = finite(corners, 7, "a corner");
    if (!(one.arm > 0.0)) refuse("a corner without arms");
    if (one.i >= one.k || !memory.graph.route_between(one.i, one.j) ||
        !memory.graph.route_between(one.j, one.k)) {
      refuse("a corner between routes that are not there");
    }
    memory.corners.push_back(one);
  }
  Statement rows(database_,
                 "SELECT number, route, lengths, length, length_variance, directions, direction, "
                 "direction_variance, corner, traversals, stretch, orientation, dx, dy, c_xx, "
                 "c_xy, c_yy FROM reckoned ORDER BY number");
  std::vector<bool> taken(idx(routes), false);
  while (rows.step()) {
    if (rows.integer(0) != std::ssize(memory.reckoned)) refuse("a length that is misnumbered");
    ReckonedRoute one;
    one.route = number_at(rows, 1, 0, routes, "a length");
    if (taken[idx(one.route)]) refuse("two lengths of a route");
    taken[idx(one.route)] = true;
    one.length = average_at(rows, 2, 1, "a length");
    one.direction = average_at(rows, 5, 0, "a direction");
    one.corner = number_at(rows, 8, -1, static_cast<int>(memory.corners.size()), "a corner");
    one.bar.source = memory.graph.route(one.route).source;
    one.bar.target = memory.graph.route(one.route).target;
    one.bar.traversals = count_at(rows, 9, 0, "a bar");
    one.bar.stretch = finite(rows, 10, "a bar");
    one.bar.orientation = finite(rows, 11, "a bar");
    one.bar.displacement = vector_at(rows, 12, "a bar");
    if (one.bar.traversals > 0) one.bar.covariance = matrix_at(rows, 14, "a bar");
    memory.reckoned.push_back(one);
  }
  written_.corners = memory.corners;
  written_.reckoned = memory.reckoned;
}

void MemoryRows::load_rest(BuilderMemory& memory) {
  const int count = memory.graph.landmarks();
  Statement chain(database_, "SELECT landmark FROM chain ORDER BY place");
  while (chain.step()) written_.chain.push_back(number_at(chain, 0, 0, count, "a chain"));
  memory.chain = OpenChain(written_.chain, written_.roots);
  Statement misfits(database_, "SELECT squared FROM misfits ORDER BY place");
  while (misfits.step()) {
    written_.misfits.push_back(finite(misfits, 0, "a misfit"));
    memory.gate.remember(written_.misfits.back());
  }
  Statement out(
      database_,
      "SELECT source, target, dx, dy, c_xx, c_xy, c_yy, sds FROM left_out ORDER BY place");
  while (out.step()) {
    LeftOutArrival one;
    one.from = memory.graph.landmark(number_at(out, 0, 0, count, "a leg")).name;
    one.to = memory.graph.landmark(number_at(out, 1, 0, count, "a leg")).name;
    one.leg = {vector_at(out, 2, "a leg"), matrix_at(out, 4, "a leg")};
    one.sds = finite(out, 7, "a leg");
    written_.left_out.push_back(one);
  }
  memory.left_out = written_.left_out;
}

void MemoryRows::load_state(BuilderMemory& memory) {
  const int count = memory.graph.landmarks();
  Statement state(database_,
                  "SELECT here, said, carried_dx, carried_dy, carried_c_xx, carried_c_xy, "
                  "carried_c_yy, frame, first_direction, ox, oy, o_xx, o_xy, o_yy, heading, "
                  "heading_variance, earlier, beta, beta_variance, beta_x, beta_y, reading, "
                  "reading_variance FROM state");
  if (!state.step()) refuse("no state");
  memory.here = number_at(state, 0, -1, count, "a state");
  memory.said = number_at(state, 1, -1, count, "a state");
  if (!state.is_null(2)) {
    memory.carried = Traversal{vector_at(state, 2, "a leg"), matrix_at(state, 4, "a leg")};
  }
  memory.frame = static_cast<Frame>(number_at(state, 7, 0, 3, "a frame"));
  memory.first_direction =
      number_at(state, 8, -1, static_cast<int>(memory.reckoned.size()), "a direction");
  memory.seen.offset_robot = vector_at(state, 9, "an offset");
  memory.seen.covariance_robot << finite(state, 11, "an offset"), finite(state, 12, "an offset"),
      finite(state, 12, "an offset"), finite(state, 13, "an offset");
  if (!state.is_null(14)) {
    memory.heading =
        HeadingEstimate{finite(state, 14, "a heading"), finite(state, 15, "a heading")};
  }
  if (!state.is_null(16)) {
    EarlierChord earlier;
    earlier.landmark = number_at(state, 16, 0, count, "a chord");
    earlier.beta = {finite(state, 17, "a chord"), finite(state, 18, "a chord"),
                    vector_at(state, 19, "a chord")};
    if (memory.here < 0 || !memory.graph.route_between(earlier.landmark, memory.here)) {
      refuse("a chord without a route");
    }
    memory.earlier = earlier;
  }
  if (!state.is_null(21)) {
    memory.reading =
        HeadingEstimate{finite(state, 21, "a reading"), finite(state, 22, "a reading")};
  }
}

void MemoryRows::save(const BuilderMemory& memory, const MapBuilderOptions& options) {
  save_landmarks(memory);
  save_routes(memory, weighs_each(options));
  save_reckoned(memory);
  save_chain(memory);
  save_gate(memory);
  save_state(memory);
}

void MemoryRows::save_landmarks(const BuilderMemory& memory) {
  const std::vector<int>& roots = memory.chain.roots();
  for (int k = 0; k < memory.graph.landmarks(); ++k) {
    const Landmark& landmark = memory.graph.landmark(k);
    const Vector2& at = landmark.position;
    const int root = idx(k) < roots.size() ? roots[idx(k)] : -1;
    if (idx(k) >= written_.positions.size()) {
      put_landmark_.bind(0, k).bind(1, landmark.name).bind(2, at.x()).bind(3, at.y()).bind(4, root);
      put_landmark_.run();
      written_.positions.push_back(at);
      written_.roots.push_back(root);
    } else if (at != written_.positions[idx(k)] || root != written_.roots[idx(k)]) {
      move_landmark_.bind(0, at.x()).bind(1, at.y()).bind(2, root).bind(3, k).run();
      written_.positions[idx(k)] = at;
      written_.roots[idx(k)] = root;
    }
  }
}

void MemoryRows::save_routes(const BuilderMemory& memory, bool weighed) {
  for (int number = 0; number < memory.graph.routes(); ++number) {
    const Route& route = memory.graph.route(number);
    const Written::RouteRow now{route.traversals, route.orientation};
    const bool there = idx(number) < written_.routes.size();
    if (there && written_.routes[idx(number)] == now) continue;
    put_route_.bind(0, number).bind(1, route.source).bind(2, route.target);
    put_route_.bind(3, route.traversals).bind(4, route.stretch).bind(5, route.orientation);
    put_route_.bind(6, route.displacement);
    put_route_.bind(8, route.covariance);
    if (weighed && memory.weighed[idx(number)].information(0, 0) > 0.0) {
      put_route_.bind(11, memory.weighed[idx(number)].information);
      put_route_.bind(14, memory.weighed[idx(number)].mean);
    }
    put_route_.run();
    if (!there) written_.routes.emplace_back();
    written_.routes[idx(number)] = now;
  }
}

void MemoryRows::save_reckoned(const BuilderMemory& memory) {
  for (std::size_t n = 0; n < memory.reckoned.size(); ++n) {
    const ReckonedRoute& one = memory.reckoned[n];
    if (n < written_.reckoned.size() && same(one, written_.reckoned[n])) continue;
    put_reckoned_.bind(0, static_cast<std::int64_t>(n)).bind(1, one.route);
    bind_average(put_reckoned_, 2, one.length);
    bind_average(put_reckoned_, 5, one.direction);
    put_reckoned_.bind(8, one.corner).bind(9, one.bar.traversals).bind(10, one.bar.stretch);
    put_reckoned_.bind(11, one.bar.orientation).bind(12, one.bar.displacement);
    put_reckoned_.bind(14, one.bar.covariance).run();
    if (n == written_.reckoned.size()) written_.reckoned.emplace_back();
    written_.reckoned[n] = one;
  }
  for (std::size_t n = 0; n < memory.corners.size(); ++n) {
    const CornerAverage& one = memory.corners[n];
    if (n < written_.corners.size() && same(one.angle, written_.corners[n].angle)) continue;
    put_corner_.bind(0, static_cast<std::int64_t>(n)).bind(1, one.i).bind(2, one.j).bind(3, one.k);
    bind_average(put_corner_, 4, one.angle);
    put_corner_.bind(7, one.arm).run();
    if (n == written_.corners.size()) written_.corners.emplace_back();
    written_.corners[n] = one;
  }
}

void MemoryRows::save_chain(const BuilderMemory& memory) {
  const std::vector<int>& chain = memory.chain.landmarks();
  std::vector<int>& written = written_.chain;
  if (chain.size() < written.size()) {
    cut_chain_.bind(0, static_cast<std::int64_t>(chain.size())).run();
    written.resize(chain.size());
  }
  for (std::size_t place = 0; place < chain.size(); ++place) {
    if (place < written.size() && written[place] == chain[place]) continue;
    put_link_.bind(0, static_cast<std::int64_t>(place)).bind(1, chain[place]).run();
  }
  written = chain;
}

void MemoryRows::save_gate(const BuilderMemory& memory) {
  const auto& misfits = memory.gate.remembered();  // never fewer than before
  if (!std::equal(misfits.begin(), misfits.end(), written_.misfits.begin(),
                  written_.misfits.end())) {
    written_.misfits.assign(misfits.begin(), misfits.end());
    for (std::size_t k = 0; k < misfits.size(); ++k) {
      put_misfit_.bind(0, static_cast<std::int64_t>(k)).bind(1, written_.misfits[k]).run();
    }
  }
  if (std::equal(memory.left_out.begin(), memory.left_out.end(), written_.left_out.begin(),
                 written_.left_out.end(), same_arrival)) {
    return;
  }
  database_.run("DELETE FROM left_out");
  for (std::size_t k = 0; k < memory.left_out.size(); ++k) {
    const LeftOutArrival& one = memory.left_out[k];
    put_left_out_.bind(0, static_cast<std::int64_t>(k));
    put_left_out_.bind(1, *memory.graph.find(one.from)).bind(2, *memory.graph.find(one.to));
    put_left_out_.bind(3, one.leg.displacement);
    put_left_out_.bind(5, one.leg.covariance);
    put_left_out_.bind(8, one.sds).run();
  }
  written_.left_out = memory.left_out;
}

void MemoryRows::save_state(const BuilderMemory& memory) {
  put_state_.bind(0, memory.here).bind(1, memory.said);
  if (memory.carried) {
    put_state_.bind(2, memory.carried->displacement);
    put_state_.bind(4, memory.carried->covariance);
  }
  put_state_.bind(7, static_cast<int>(memory.frame)).bind(8, memory.first_direction);
  put_state_.bind(9, memory.seen.offset_robot).bind(11, memory.seen.covariance_robot);
  if (memory.heading) {
    put_state_.bind(14, memory.heading->heading).bind(15, memory.heading->variance);
  }
  if (memory.earlier) {
    const SharedAngle& beta = memory.earlier->beta;
    put_state_.bind(16, memory.earlier->landmark).bind(17, beta.value).bind(18, beta.variance);
    put_state_.bind(19, beta.by_offset);
  }
  if (memory.reading) {
    put_state_.bind(21, memory.reading->heading).bind(22, memory.reading->variance);
  }
  put_state_.run();
}

}  // namespace trussmap
