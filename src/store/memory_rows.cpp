// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/memory_rows.hpp"

#include "geometry/index.hpp"
#include "text/number_text.hpp"
#include "text/plain_text.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace trussmap::store {
namespace {

class DatabaseTables final : public map::MemoryTables {
 public:
  explicit DatabaseTables(const Database& database) : database_(database) {}

  int rows(const map::MemoryTable& table) override {
    return static_cast<int>(database_.number(text::joined("SELECT count(*) FROM ", table.name)));
  }
  void each(const map::MemoryTable& table,
            const std::function<void(const text::RowReader&)>& visit) override {
    const std::string columns = table.columns;
    const std::string first = columns.substr(0, columns.find(','));
    Statement rows(database_,
                   text::joined("SELECT ", columns, " FROM ", table.name, " ORDER BY ", first));
    for (std::int64_t row = 1; rows.step(); ++row) {
      try {
        visit(rows);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(
            text::joined(error.what(), " (row ", row, " of ", table.name, ")"));
      }
    }
  }

 private:
  const Database& database_;
};

/// A name that is shown to people, and that files of maps can hold.
void check_name(const std::string& name) {
  if (!name.empty() && text::is_plain_text(name)) return;
  throw std::invalid_argument(
      "a landmark whose name is empty or holds a control character, expected printable text");
}

bool same(const map::Average& a, const map::Average& b) {
  return a.count == b.count && a.mean == b.mean && a.variance == b.variance;
}

bool same(const map::ReckonedRoute& a, const map::ReckonedRoute& b) {
  return same(a.length, b.length) && same(a.direction, b.direction) && a.corner == b.corner &&
         a.bar.traversals == b.bar.traversals;
}

bool same_arrival(const LeftOutArrival& a, const LeftOutArrival& b) {
  return a.from == b.from && a.to == b.to && a.sds == b.sds && a.own_axes == b.own_axes &&
         a.leg.displacement == b.leg.displacement && a.leg.covariance == b.leg.covariance;
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
                         variance REAL NOT NULL);
    CREATE TABLE chain(place INTEGER PRIMARY KEY, landmark INTEGER NOT NULL);
    CREATE TABLE misfits(place INTEGER PRIMARY KEY, squared REAL NOT NULL);
    CREATE TABLE left_out(place INTEGER PRIMARY KEY, source INTEGER NOT NULL,
                          target INTEGER NOT NULL, dx REAL NOT NULL, dy REAL NOT NULL,
                          c_xx REAL NOT NULL, c_xy REAL NOT NULL, c_yy REAL NOT NULL,
                          sds REAL NOT NULL, own_axes INTEGER NOT NULL);
    CREATE TABLE state(one INTEGER PRIMARY KEY CHECK (one = 1), here INTEGER NOT NULL,
                       said INTEGER NOT NULL, carried_dx REAL, carried_dy REAL, carried_c_xx REAL,
                       carried_c_xy REAL, carried_c_yy REAL, frame INTEGER NOT NULL,
                       first_direction INTEGER NOT NULL, ox REAL NOT NULL, oy REAL NOT NULL,
                       o_xx REAL NOT NULL, o_xy REAL NOT NULL, o_yy REAL NOT NULL, heading REAL,
                       heading_variance REAL, earlier INTEGER, beta REAL, beta_variance REAL,
                       beta_x REAL, beta_y REAL, reading REAL, reading_variance REAL,
                       driven_x REAL, driven_y REAL, driven_turn REAL, driven_xx REAL,
                       driven_xy REAL, driven_xt REAL, driven_yy REAL, driven_yt REAL,
                       driven_tt REAL, said_x REAL, said_y REAL, said_xx REAL, said_xy REAL,
                       said_yy REAL, said_reading REAL, said_reading_variance REAL);
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
      put_corner_(database, "REPLACE INTO corners VALUES (?, ?, ?, ?, ?, ?, ?)"),
      put_link_(database, "REPLACE INTO chain VALUES (?, ?)"),
      cut_chain_(database, "DELETE FROM chain WHERE place >= ?"),
      put_misfit_(database, "REPLACE INTO misfits VALUES (?, ?)"),
      put_left_out_(database, "INSERT INTO left_out VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      put_state_(database,
                 "UPDATE state SET here = ?, said = ?, carried_dx = ?, carried_dy = ?, "
                 "carried_c_xx = ?, carried_c_xy = ?, carried_c_yy = ?, frame = ?, "
                 "first_direction = ?, ox = ?, oy = ?, o_xx = ?, o_xy = ?, o_yy = ?, heading = ?, "
                 "heading_variance = ?, earlier = ?, beta = ?, beta_variance = ?, beta_x = ?, "
                 "beta_y = ?, reading = ?, reading_variance = ?, driven_x = ?, driven_y = ?, "
                 "driven_turn = ?, driven_xx = ?, driven_xy = ?, driven_xt = ?, driven_yy = ?, "
                 "driven_yt = ?, driven_tt = ?, said_x = ?, said_y = ?, said_xx = ?, said_xy = ?, "
                 "said_yy = ?, said_reading = ?, said_reading_variance = ?") {}

map::BuilderMemory MemoryRows::load(const MapBuilderOptions& options) {
  DatabaseTables tables(database_);
  written_ = {};
  map::BuilderMemory memory = map::load_memory(tables, options);
  for (int k = 0; k < memory.graph.landmarks(); ++k) {
    check_name(memory.graph.landmark(k).name);
    written_.positions.push_back(memory.graph.landmark(k).position);
    written_.roots.push_back(map::root_of(memory, k));
  }
  for (int number = 0; number < memory.graph.routes(); ++number) {
    const Route& route = memory.graph.route(number);
    written_.routes.push_back({route.traversals, route.orientation});
  }
  written_.reckoned = memory.reckoned;
  written_.corners = memory.corners;
  written_.chain = memory.chain.landmarks();
  written_.misfits.assign(memory.gate.remembered().begin(), memory.gate.remembered().end());
  written_.left_out = memory.left_out;
  return memory;
}

void MemoryRows::save(const map::BuilderMemory& memory, const MapBuilderOptions& options) {
  save_landmarks(memory);
  save_routes(memory, map::weighs_each(options));
  save_reckoned(memory);
  save_chain(memory);
  save_gate(memory);
  save_state(memory);
}

void MemoryRows::save_landmarks(const map::BuilderMemory& memory) {
  for (int k = 0; k < memory.graph.landmarks(); ++k) {
    const Vector2& at = memory.graph.landmark(k).position;
    const int root = map::root_of(memory, k);
    if (idx(k) >= written_.positions.size()) {
      check_name(memory.graph.landmark(k).name);
      map::put_landmark(put_landmark_, memory, k);
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

void MemoryRows::save_routes(const map::BuilderMemory& memory, bool weighed) {
  for (int number = 0; number < memory.graph.routes(); ++number) {
    const Route& route = memory.graph.route(number);
    const Written::RouteRow now{route.traversals, route.orientation};
    const bool there = idx(number) < written_.routes.size();
    if (there && written_.routes[idx(number)] == now) continue;
    map::put_route(put_route_, memory, number, weighed);
    put_route_.run();
    if (!there) written_.routes.emplace_back();
    written_.routes[idx(number)] = now;
  }
}

void MemoryRows::save_reckoned(const map::BuilderMemory& memory) {
  for (std::size_t n = 0; n < memory.reckoned.size(); ++n) {
    const map::ReckonedRoute& one = memory.reckoned[n];
    if (n < written_.reckoned.size() && same(one, written_.reckoned[n])) continue;
    map::put_reckoned(put_reckoned_, memory, static_cast<int>(n));
    put_reckoned_.run();
    if (n == written_.reckoned.size()) written_.reckoned.emplace_back();
    written_.reckoned[n] = one;
  }
  for (std::size_t n = 0; n < memory.corners.size(); ++n) {
    const map::CornerAverage& one = memory.corners[n];
    if (n < written_.corners.size() && same(one.angle, written_.corners[n].angle)) continue;
    map::put_corner(put_corner_, memory, static_cast<int>(n));
    put_corner_.run();
    if (n == written_.corners.size()) written_.corners.emplace_back();
    written_.corners[n] = one;
  }
}

void MemoryRows::save_chain(const map::BuilderMemory& memory) {
  const std::vector<int>& chain = memory.chain.landmarks();
  std::vector<int>& written = written_.chain;
  if (chain.size() < written.size()) {
    cut_chain_.bind(0, static_cast<std::int64_t>(chain.size())).run();
    written.resize(chain.size());
  }
  for (std::size_t place = 0; place < chain.size(); ++place) {
    if (place < written.size() && written[place] == chain[place]) continue;
    map::put_link(put_link_, memory, static_cast<int>(place));
    put_link_.run();
  }
  written = chain;
}

void MemoryRows::save_gate(const map::BuilderMemory& memory) {
  const auto& misfits = memory.gate.remembered();  // never fewer than before
  if (!std::equal(misfits.begin(), misfits.end(), written_.misfits.begin(),
                  written_.misfits.end())) {
    written_.misfits.assign(misfits.begin(), misfits.end());
    for (std::size_t k = 0; k < misfits.size(); ++k) {
      map::put_misfit(put_misfit_, memory, static_cast<int>(k));
      put_misfit_.run();
    }
  }
  if (std::equal(memory.left_out.begin(), memory.left_out.end(), written_.left_out.begin(),
                 written_.left_out.end(), same_arrival)) {
    return;
  }
  database_.run("DELETE FROM left_out");
  for (std::size_t k = 0; k < memory.left_out.size(); ++k) {
    map::put_left_out(put_left_out_, memory, static_cast<int>(k));
    put_left_out_.run();
  }
  written_.left_out = memory.left_out;
}

void MemoryRows::save_state(const map::BuilderMemory& memory) {
  map::put_state(put_state_, memory);
  put_state_.run();
}

}  // namespace trussmap::store
