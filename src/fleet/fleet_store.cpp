// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/present.hpp"
#include "files/temporary.hpp"
#include "fleet/fleet_rows.hpp"
#include "store/database.hpp"
#include "store/schema.hpp"
#include "store/store_file.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"

#include <cerrno>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>
#include <unistd.h>
#include <utility>

namespace trussmap {
using namespace fleet;

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kApplication = 0x74736674;  // "tsft"
constexpr std::int64_t kVersion = 1;
constexpr const char* kPatience = "PRAGMA busy_timeout = 60000";  // ms, for others that add

template <typename Call>
auto naming(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const store::DatabaseError& error) {
    if (error.busy()) {
      throw InputError(file.string(), 0,
                       "has been written by another program for a minute, expected to get a turn");
    }
    if (error.no_database()) throw InputError(file.string(), 0, "is no fleet store");
    throw InputError(file.string(), 0,
                     text::joined("cannot be read or written as a fleet store: ", error.what()));
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, text::joined("is a damaged fleet store: ", error.what()));
  }
}

std::vector<std::string> tables_of(const store::Database& database) {
  return store::schema_of(database, {"model", "days", "metadata"});
}

const std::vector<std::string>& made_tables() {
  static const std::vector<std::string> kTables = [] {
    const store::Database memory(":memory:", store::Database::Access::write);
    make_fleet_tables(memory);
    return tables_of(memory);
  }();
  return kTables;
}

/// Statements of other tables, views or triggers could do anything.
void check_kind(const store::Database& database, const fs::path& file) {
  database.run("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON");
  if (database.number("PRAGMA application_id") != kApplication) {
    throw InputError(file.string(), 0, "is no fleet store");
  }
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version != kVersion) {
    throw InputError(
        file.string(), 0,
        text::joined("is a fleet store of version ", version, ", expected version ", kVersion));
  }
  if (tables_of(database) != made_tables()) {
    throw InputError(file.string(), 0, "is damaged: its tables are not those of a fleet store");
  }
}

bool is_same(const FleetRow& a, const FleetRow& b) {
  const auto facts = [](const FleetRow& r) {
    return std::tie(r.metadata, r.recordings, r.chi2, r.dof, r.held_out_legs, r.held_out_rms,
                    r.held_out_stretch, r.held_out_orientation, r.columns, r.reference, r.prior_sd,
                    r.largest, r.whole);
  };
  return facts(a) == facts(b) && a.g == b.g && a.S == b.S;
}

/// A transaction that takes its turn among those who write.
template <typename Call>
void in_turn(const store::Database& database, const Call& call) {
  database.run(kPatience);
  database.run("BEGIN IMMEDIATE");
  try {
    call();
    database.run("COMMIT");
  } catch (...) {
    if (database.in_transaction()) database.run("ROLLBACK");
    throw;
  }
}

/// Within a transaction: makes what is fresh, and refuses what is no store, or of another model.
void expect_model(const store::Database& database, const fs::path& file, const FleetRow& row) {
  const bool fresh = database.number("SELECT count(*) FROM sqlite_schema") == 0 &&
                     database.number("PRAGMA application_id") == 0;
  if (fresh) {
    make_fleet_tables(database);
    database.run(text::joined("PRAGMA application_id = ", kApplication));
    database.run(text::joined("PRAGMA user_version = ", kVersion));
    store::Statement model(database, "INSERT INTO model VALUES (1, ?)");
    model.bind(0, row.model).run();
  }
  check_kind(database, file);
  if (fleet_model_in(database) == row.model) return;
  throw InputError(file.string(), 0,
                   text::joined("is of another model than robot ", row.robot, " on ", row.date,
                                ", and these do not pool, expected the same model"));
}

/// Calls `write` with the store's database. One that is not there yet is made under another name:
/// what fails leaves nothing behind, and others see it whole.
template <typename Write>
void writing(const fs::path& place, const Write& write) {
  if (!files::is_present(place)) {
    const fs::path part = files::temporary_for(place);
    const auto unwritten = [&place](int reason) {
      return InputError(place.string(), 0,
                        std::string("cannot be written: ") + std::strerror(reason));
    };
    const files::Descriptor held = files::make_temporary_file(part);
    if (!held.valid()) throw unwritten(errno);
    const store::FreshFile gone(part, true);
    write(store::Database(part, store::Database::Access::write));
    if (::link(part.c_str(), place.c_str()) == 0) {
      if (!files::keep_folder(place.parent_path())) throw unwritten(errno);
      return;
    }
    // Another program has made one meanwhile, or the file system knows no links: it gets this row.
    if (errno != EEXIST && errno != EPERM && errno != ENOTSUP) throw unwritten(errno);
  }
  write(store::Database(place, store::Database::Access::write));
}

using DayKey = std::pair<std::string, std::string>;  // robot, date

struct ShardRow {
  FleetRow row;
  fs::path shard;
};

/// Takes rows that are new; throws where one that is known is other than before.
void gather(std::map<DayKey, ShardRow>& rows, const fs::path& shard,
            const std::vector<FleetRow>& more) {
  for (const FleetRow& row : more) {
    if (!rows.empty() && rows.begin()->second.row.model != row.model) {
      throw InputError(
          shard.string(), 0,
          text::joined("is of another model than ", rows.begin()->second.shard.string(),
                       ", and these do not pool, expected the same model"));
    }
    const auto [found, is_new] = rows.try_emplace({row.robot, row.date}, ShardRow{row, shard});
    if (is_new || is_same(found->second.row, row)) continue;
    throw InputError(
        shard.string(), 0,
        text::joined("has other figures for robot ", row.robot, " on ", row.date, " than ",
                     found->second.shard.string(), ", expected the same or only one"));
  }
}

}  // namespace

void add_to_fleet(const fs::path& file, const FleetRow& row, bool replace) {
  const fs::path place = store::place_of_database(file, "fleet store");
  check_fleet_row(row);
  const auto add = [&](const store::Database& database) {
    expect_model(database, file, row);
    store::Statement there(database, "SELECT 1 FROM days WHERE robot = ? AND date = ?");
    there.bind(0, row.robot).bind(1, row.date);
    const bool known = there.step();
    there.reset();
    if (known && !replace) {
      throw InputError(file.string(), 0,
                       text::joined("has robot ", row.robot, " on ", row.date,
                                    " already, expected a new day or --replace"));
    }
    put_fleet_row(database, row);
  };
  naming(file, [&] {
    writing(place,
            [&](const store::Database& database) { in_turn(database, [&] { add(database); }); });
  });
}

std::vector<FleetRow> read_fleet(const fs::path& file) {
  const fs::path place = store::place_of_database(file, "fleet store");
  if (!files::is_present(place)) {
    throw InputError(file.string(), 0, "is missing, expected a fleet store");
  }
  return naming(file, [&] {
    const store::Database database(place, store::Database::Access::read);
    database.run(kPatience);
    check_kind(database, file);
    return fleet_rows_in(database);
  });
}

std::size_t merge_fleets(const fs::path& out, const std::vector<fs::path>& shards) {
  std::map<DayKey, ShardRow> rows;
  for (const fs::path& shard : shards) gather(rows, shard, read_fleet(shard));
  if (rows.empty()) {
    throw InputError(out.string(), 0, "would have no rows, expected some in shards");
  }
  const fs::path place = store::place_of_database(out, "fleet store");
  const auto merge = [&](const store::Database& database) {
    expect_model(database, out, rows.begin()->second.row);
    const std::vector<FleetRow> had = fleet_rows_in(database);
    std::set<DayKey> known;
    for (const FleetRow& row : had) known.emplace(row.robot, row.date);
    gather(rows, out, had);
    for (const auto& [key, one] : rows) {
      if (!known.contains(key)) put_fleet_row(database, one.row);
    }
  };
  naming(out, [&] {
    writing(place,
            [&](const store::Database& database) { in_turn(database, [&] { merge(database); }); });
  });
  return rows.size();
}

}  // namespace trussmap
