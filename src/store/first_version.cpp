// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/first_version.hpp"

#include "store/store_tables.hpp"

#include <string>

namespace trussmap::store {

void create_first_version(const Database& database) {
  database.run(R"sql(
    CREATE TABLE facts(name TEXT PRIMARY KEY, value) WITHOUT ROWID;
    CREATE TABLE sessions(number INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE,
                          name TEXT NOT NULL, first_leg INTEGER NOT NULL, legs INTEGER NOT NULL);
    CREATE TABLE legs(number INTEGER PRIMARY KEY, session INTEGER, kind INTEGER NOT NULL,
                      source INTEGER, target INTEGER, dx REAL, dy REAL, c_xx REAL, c_xy REAL,
                      c_yy REAL, gain REAL, outcome INTEGER);
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

void upgrade_first_version(const Database& database) {
  database.run("DROP VIEW map");
  for (const char* table : {"facts", "sessions", "legs", "landmarks", "routes", "chain", "misfits",
                            "left_out", "state"}) {
    database.run(std::string("ALTER TABLE ") + table + " RENAME TO first_" + table);
  }
  create_store(database, {});
  // A bar that weighs each traversal is at rest where the map has it: least squares goes on from
  // there as it would have.
  database.run(R"sql(
    INSERT INTO sessions SELECT * FROM first_sessions;
    INSERT INTO legs SELECT number, session, CASE WHEN kind >= 3 THEN 4 ELSE kind END, source,
                            target, 0, dx, dy, NULL, c_xx, c_xy, c_yy, NULL, NULL, NULL, NULL, NULL,
                            NULL, NULL, NULL, outcome FROM first_legs;
    INSERT INTO landmarks SELECT number, name, x + offset_x, y + offset_y, root
                          FROM first_landmarks, first_state;
    INSERT INTO routes SELECT r.*, CASE WHEN r.k_xx IS NULL THEN NULL ELSE b.x - a.x END,
                              CASE WHEN r.k_xx IS NULL THEN NULL ELSE b.y - a.y END
                       FROM first_routes r, first_landmarks a, first_landmarks b
                       WHERE a.number = r.source AND b.number = r.target;
    INSERT INTO chain SELECT * FROM first_chain;
    INSERT INTO misfits SELECT * FROM first_misfits;
    INSERT INTO left_out SELECT *, 0 FROM first_left_out;
    UPDATE state SET (here, said, carried_dx, carried_dy, carried_c_xx, carried_c_xy, carried_c_yy)
      = (SELECT here, said, carried_dx, carried_dy, carried_c_xx, carried_c_xy, carried_c_yy
         FROM first_state), frame = CASE WHEN (SELECT count(*) FROM routes) > 0 THEN 2 ELSE 0 END;
    REPLACE INTO facts SELECT name, value FROM first_facts
      WHERE name NOT IN ('eta', 'eta_count', 'hold_first', 'gain_limit');
    REPLACE INTO facts SELECT 'scope', CASE value WHEN 'fixed' THEN 'nearest' ELSE value END
      FROM first_facts WHERE name = 'eta';
    REPLACE INTO facts SELECT 'eta', value FROM first_facts WHERE name = 'eta_count';
    DROP TABLE first_facts; DROP TABLE first_sessions; DROP TABLE first_legs;
    DROP TABLE first_routes; DROP TABLE first_landmarks; DROP TABLE first_chain;
    DROP TABLE first_misfits; DROP TABLE first_left_out; DROP TABLE first_state;
  )sql");
}

}  // namespace trussmap::store
