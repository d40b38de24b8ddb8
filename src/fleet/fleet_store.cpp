// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/database.hpp"
#include "store/store_file.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kApplication = 0x74736674;  // "tsft"
constexpr std::int64_t kVersion = 1;
constexpr const char* kPatience = "PRAGMA busy_timeout = 60000";  // ms, for others that add
constexpr char kField = '\x1f';
constexpr char kRecord = '\x1e';
constexpr std::size_t kMostColumns = 2000;

template <typename Call>
auto naming(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const DatabaseError& error) {
    if (error.busy()) {
      throw InputError(file.string(), 0,
                       "has been written by another program for a minute, expected to get a turn");
    }
    if (error.no_database()) throw InputError(file.string(), 0, "is no fleet store");
    throw InputError(file.string(), 0,
                     joined("cannot be read or written as a fleet store: ", error.what()));
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, joined("is a damaged fleet store: ", error.what()));
  }
}

// Lists of numbers as their bytes, lists of columns as fields and records.

std::string bytes_of(const double* values, std::size_t count) {
  std::string bytes(count * sizeof(double), '\0');
  if (count > 0) std::memcpy(bytes.data(), values, bytes.size());
  return bytes;
}

std::vector<double> numbers_in(const std::string& bytes, std::size_t count) {
  if (bytes.size() != count * sizeof(double)) {
    throw std::invalid_argument("a list of numbers has a wrong length");
  }
  std::vector<double> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  for (const double one : values) {
    if (!std::isfinite(one)) throw std::invalid_argument("a number is not finite");
  }
  return values;
}

/// The lower triangle, row by row.
std::vector<double> packed(const Eigen::MatrixXd& S) {
  std::vector<double> values;
  for (Eigen::Index a = 0; a < S.rows(); ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) values.push_back(S(a, b));
  }
  return values;
}

Eigen::MatrixXd unpacked(const std::vector<double>& values, Eigen::Index count) {
  Eigen::MatrixXd S(count, count);
  auto next = values.begin();
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) S(a, b) = S(b, a) = *next++;
  }
  return S;
}

std::string text_of(const std::vector<FleetColumn>& columns) {
  std::string text;
  for (const FleetColumn& one : columns) {
    text += joined(one.of_model ? 1 : 0, kField, one.effect, kField, one.channel, kField, one.shape,
                   kField, one.place, kRecord);
  }
  return text;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::vector<FleetColumn> columns_in(const std::string& text) {
  std::vector<FleetColumn> columns;
  std::vector<std::string> records = split(text, kRecord);
  records.pop_back();
  if (records.size() > kMostColumns) throw std::invalid_argument("there are too many columns");
  for (const std::string& record : records) {
    const std::vector<std::string> fields = split(record, kField);
    if (fields.size() != 5 || fields[4].empty() || fields[4].size() > 4 ||
        fields[4].find_first_not_of("0123456789") != std::string::npos) {
      throw std::invalid_argument("a column is none");
    }
    columns.push_back({fields[0] == "1", fields[1], fields[2], fields[3], std::stoi(fields[4])});
  }
  return columns;
}

void make(const Database& database) {
  database.run(joined("PRAGMA application_id = ", kApplication));
  database.run(joined("PRAGMA user_version = ", kVersion));
  database.run(R"sql(
    CREATE TABLE model(number INTEGER PRIMARY KEY CHECK (number = 1), text TEXT NOT NULL);
    CREATE TABLE days(robot TEXT NOT NULL, date TEXT NOT NULL, recordings INTEGER NOT NULL,
                      chi2 REAL NOT NULL, dof INTEGER NOT NULL, held_out_legs INTEGER NOT NULL,
                      held_out_rms REAL NOT NULL, held_out_stretch REAL NOT NULL,
                      held_out_orientation REAL NOT NULL, columns TEXT NOT NULL,
                      facts BLOB NOT NULL, g BLOB NOT NULL, S BLOB NOT NULL,
                      PRIMARY KEY (robot, date)) WITHOUT ROWID;
    CREATE TABLE metadata(robot TEXT NOT NULL, date TEXT NOT NULL, key TEXT NOT NULL,
                          value TEXT NOT NULL, PRIMARY KEY (robot, date, key)) WITHOUT ROWID;
  )sql");
}

void check_kind(const Database& database, const fs::path& file) {
  if (database.number("PRAGMA application_id") != kApplication) {
    throw InputError(file.string(), 0, "is no fleet store");
  }
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version != kVersion) {
    throw InputError(
        file.string(), 0,
        joined("is a fleet store of version ", version, ", expected version ", kVersion));
  }
}

std::string model_in(const Database& database) {
  Statement get(database, "SELECT text FROM model");
  return get.step() ? get.text(0) : std::string();
}

void put(const Database& database, const FleetRow& row) {
  std::vector<double> facts;
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    facts.insert(facts.end(), {row.reference[k], row.prior_sd[k], row.largest[k], row.whole[k]});
  }
  const std::vector<double> S = packed(row.S);
  Statement day(database, "REPLACE INTO days VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  day.bind(0, row.robot).bind(1, row.date).bind(2, row.recordings).bind(3, row.chi2);
  day.bind(4, row.dof).bind(5, row.held_out_legs).bind(6, row.held_out_rms);
  day.bind(7, row.held_out_stretch).bind(8, row.held_out_orientation);
  day.bind(9, text_of(row.columns)).bind_bytes(10, bytes_of(facts.data(), facts.size()));
  day.bind_bytes(11, bytes_of(row.g.data(), static_cast<std::size_t>(row.g.size())));
  day.bind_bytes(12, bytes_of(S.data(), S.size()));
  day.run();
  Statement clear(database, "DELETE FROM metadata WHERE robot = ? AND date = ?");
  clear.bind(0, row.robot).bind(1, row.date).run();
  Statement one(database, "INSERT INTO metadata VALUES (?, ?, ?, ?)");
  for (const auto& [key, value] : row.metadata) {
    one.bind(0, row.robot).bind(1, row.date).bind(2, key).bind(3, value).run();
  }
}

std::vector<FleetRow> rows_in(const Database& database) {
  const std::string model = model_in(database);
  std::vector<FleetRow> rows;
  Statement days(database, "SELECT * FROM days ORDER BY robot, date");
  Statement metadata(database, "SELECT key, value FROM metadata WHERE robot = ? AND date = ?");
  while (days.step()) {
    FleetRow row;
    row.robot = days.text(0);
    row.date = days.text(1);
    row.model = model;
    row.recordings = static_cast<int>(days.integer(2));
    row.chi2 = days.real(3);
    row.dof = static_cast<int>(days.integer(4));
    row.held_out_legs = static_cast<int>(days.integer(5));
    row.held_out_rms = days.real(6);
    row.held_out_stretch = days.real(7);
    row.held_out_orientation = days.real(8);
    row.columns = columns_in(days.text(9));
    const std::size_t count = row.columns.size();
    const std::vector<double> facts = numbers_in(days.bytes(10), 4 * count);
    for (std::size_t k = 0; k < count; ++k) {
      row.reference.push_back(facts[4 * k]);
      row.prior_sd.push_back(facts[4 * k + 1]);
      row.largest.push_back(facts[4 * k + 2]);
      row.whole.push_back(facts[4 * k + 3]);
    }
    const std::vector<double> g = numbers_in(days.bytes(11), count);
    row.g = Eigen::Map<const Eigen::VectorXd>(g.data(), static_cast<Eigen::Index>(count));
    row.S = unpacked(numbers_in(days.bytes(12), count * (count + 1) / 2),
                     static_cast<Eigen::Index>(count));
    metadata.bind(0, row.robot).bind(1, row.date);
    while (metadata.step()) row.metadata[metadata.text(0)] = metadata.text(1);
    metadata.reset();
    rows.push_back(std::move(row));
  }
  return rows;
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
void in_turn(const Database& database, const Call& call) {
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
void expect_model(const Database& database, const fs::path& file, const FleetRow& row) {
  const bool fresh = database.number("SELECT count(*) FROM sqlite_schema") == 0 &&
                     database.number("PRAGMA application_id") == 0;
  if (fresh) {
    make(database);
    Statement model(database, "INSERT INTO model VALUES (1, ?)");
    model.bind(0, row.model).run();
  }
  check_kind(database, file);
  if (model_in(database) == row.model) return;
  throw InputError(file.string(), 0,
                   joined("is of another model than robot ", row.robot, " on ", row.date,
                          ", and these do not pool, expected the same model"));
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
      throw InputError(shard.string(), 0,
                       joined("is of another model than ", rows.begin()->second.shard.string(),
                              ", and these do not pool, expected the same model"));
    }
    const auto [found, is_new] = rows.try_emplace({row.robot, row.date}, ShardRow{row, shard});
    if (is_new || is_same(found->second.row, row)) continue;
    throw InputError(shard.string(), 0,
                     joined("has other figures for robot ", row.robot, " on ", row.date, " than ",
                            found->second.shard.string(), ", expected the same or only one"));
  }
}

}  // namespace

void add_to_fleet(const fs::path& file, const FleetRow& row, bool replace) {
  const fs::path place = place_of_database(file, "fleet store");
  naming(file, [&] {
    const Database database(place, Database::Access::write);
    in_turn(database, [&] {
      expect_model(database, file, row);
      Statement there(database, "SELECT 1 FROM days WHERE robot = ? AND date = ?");
      there.bind(0, row.robot).bind(1, row.date);
      const bool known = there.step();
      there.reset();
      if (known && !replace) {
        throw InputError(file.string(), 0,
                         joined("has robot ", row.robot, " on ", row.date,
                                " already, expected a new day or --replace"));
      }
      put(database, row);
    });
  });
}

std::vector<FleetRow> read_fleet(const fs::path& file) {
  const fs::path place = place_of_database(file, "fleet store");
  return naming(file, [&] {
    const Database database(place, Database::Access::read);
    database.run(kPatience);
    check_kind(database, file);
    return rows_in(database);
  });
}

std::size_t merge_fleets(const fs::path& out, const std::vector<fs::path>& shards) {
  std::map<DayKey, ShardRow> rows;
  for (const fs::path& shard : shards) gather(rows, shard, read_fleet(shard));
  if (rows.empty()) {
    throw InputError(out.string(), 0, "would have no rows, expected some in shards");
  }
  const fs::path place = place_of_database(out, "fleet store");
  return naming(out, [&] {
    const Database database(place, Database::Access::write);
    std::size_t count = 0;
    in_turn(database, [&] {
      expect_model(database, out, rows.begin()->second.row);
      std::vector<FleetRow> had = rows_in(database);
      std::set<DayKey> known;
      for (const FleetRow& row : had) known.emplace(row.robot, row.date);
      gather(rows, out, had);
      for (const auto& [key, one] : rows) {
        if (!known.contains(key)) put(database, one.row);
      }
      count = rows.size();
    });
    return count;
  });
}

}  // namespace trussmap
