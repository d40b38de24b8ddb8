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

bool same(const LeftOutArrival& a, const LeftOutArrival& b) {
  return a.from == b.from && a.to == b.to && a.sds == b.sds &&
         a.leg.displacement == b.leg.displacement && a.leg.covariance == b.leg.covariance;
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
                        k_xx REAL, k_xy REAL, k_yy REAL);
    CREATE TABLE chain(place INTEGER PRIMARY KEY, landmark INTEGER NOT NULL);
    CREATE TABLE misfits(place INTEGER PRIMARY KEY, squared REAL NOT NULL);
    CREATE TABLE left_out(place INTEGER PRIMARY KEY, source INTEGER NOT NULL,
                          target INTEGER NOT NULL, dx REAL NOT NULL, dy REAL NOT NULL,
                          c_xx REAL NOT NULL, c_xy REAL NOT NULL, c_yy REAL NOT NULL,
                          sds REAL NOT NULL);
    CREATE TABLE state(one INTEGER PRIMARY KEY CHECK (one = 1), here INTEGER NOT NULL,
                       said INTEGER NOT NULL,
                       offset_x REAL NOT NULL, offset_y REAL NOT NULL, carried_dx REAL,
                       carried_dy REAL, carried_c_xx REAL, carried_c_xy REAL, carried_c_yy REAL);
    INSERT INTO state(one, here, said, offset_x, offset_y) VALUES (1, -1, -1, 0, 0);
    CREATE VIEW map AS SELECT name AS landmark, x + offset_x AS x, y + offset_y AS y
                       FROM landmarks, state ORDER BY number;
  )sql");
}

MemoryRows::MemoryRows(const Database& database)
    : database_(database),
      put_landmark_(database, "INSERT INTO landmarks VALUES (?, ?, ?, ?, ?)"),
      move_landmark_(database, "UPDATE landmarks SET x = ?, y = ?, root = ? WHERE number = ?"),
      put_route_(database, "REPLACE INTO routes VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      put_link_(database, "REPLACE INTO chain VALUES (?, ?)"),
      cut_chain_(database, "DELETE FROM chain WHERE place >= ?"),
      put_misfit_(database, "REPLACE INTO misfits VALUES (?, ?)"),
      put_left_out_(database, "INSERT INTO left_out VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      put_state_(database,
                 "UPDATE state SET here = ?, offset_x = ?, offset_y = ?, carried_dx = ?, "
                 "carried_dy = ?, carried_c_xx = ?, carried_c_xy = ?, carried_c_yy = ?, said = ?") {
}

BuilderMemory MemoryRows::load(const MapBuilderOptions& options) {
  written_ = {};
  BuilderMemory memory(options.gate);
  load_landmarks(memory);
  load_routes(memory, options.method == Method::gauss_markov);
  load_rest(memory);
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

void MemoryRows::load_routes(BuilderMemory& memory, bool with_bars) {
  Statement rows(database_,
                 "SELECT number, source, target, traversals, stretch, orientation, dx, dy, c_xx, "
                 "c_xy, c_yy, k_xx, k_xy, k_yy FROM routes ORDER BY number");
  const int count = memory.graph.landmarks();
  std::vector<Bar> bars;
  while (rows.step()) {
    Route route;
    route.source = number_at(rows, 1, 0, count, "a route");
    route.target = number_at(rows, 2, 0, count, "a route");
    if (rows.integer(0) != memory.graph.routes()) refuse("a route that is misnumbered");
    const std::int64_t traversals = rows.integer(3);
    constexpr std::int64_t kMost = 1'000'000'000;
    if (traversals < 1 || traversals > kMost) refuse("a route without traversals");
    route.traversals = static_cast<int>(traversals);
    route.stretch = finite(rows, 4, "a route");
    route.orientation = finite(rows, 5, "a route");
    route.displacement = vector_at(rows, 6, "a route");
    route.covariance = matrix_at(rows, 8, "a route");
    memory.graph.set_route(memory.graph.add_route(route.source, route.target), route);
    if (with_bars) bars.push_back({route.source, route.target, matrix_at(rows, 11, "a bar")});
    written_.traversals.push_back(route.traversals);
  }
  if (with_bars) memory.increments = ExactIncrements(std::max(count, 1), std::move(bars));
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
  Statement state(database_,
                  "SELECT here, offset_x, offset_y, carried_dx, carried_dy, carried_c_xx, "
                  "carried_c_xy, carried_c_yy, said FROM state");
  if (!state.step()) refuse("no state");
  memory.here = number_at(state, 0, -1, count, "a state");
  memory.said = number_at(state, 8, -1, count, "a state");
  memory.offset = vector_at(state, 1, "a state");
  if (!state.is_null(3)) {
    memory.carried = Traversal{vector_at(state, 3, "a leg"), matrix_at(state, 5, "a leg")};
  }
}

void MemoryRows::save(const BuilderMemory& memory, const MapBuilderOptions& options) {
  save_landmarks(memory);
  save_routes(memory, options.method == Method::gauss_markov);
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

void MemoryRows::save_routes(const BuilderMemory& memory, bool with_bars) {
  for (int number = 0; number < memory.graph.routes(); ++number) {
    const Route& route = memory.graph.route(number);
    const bool there = idx(number) < written_.traversals.size();
    if (there && written_.traversals[idx(number)] == route.traversals) continue;
    put_route_.bind(0, number).bind(1, route.source).bind(2, route.target);
    put_route_.bind(3, route.traversals).bind(4, route.stretch).bind(5, route.orientation);
    put_route_.bind(6, route.displacement);
    put_route_.bind(8, route.covariance);
    if (with_bars) put_route_.bind(11, memory.increments.stiffness(number));
    put_route_.run();
    if (!there) written_.traversals.push_back(0);
    written_.traversals[idx(number)] = route.traversals;
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
                 written_.left_out.end(), same)) {
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
  put_state_.bind(0, memory.here).bind(8, memory.said);
  put_state_.bind(1, memory.offset);
  if (memory.carried) {
    put_state_.bind(3, memory.carried->displacement);
    put_state_.bind(5, memory.carried->covariance);
  }
  put_state_.run();
}

}  // namespace trussmap
