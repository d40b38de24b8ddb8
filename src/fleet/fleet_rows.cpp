// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fleet/fleet_rows.hpp"

#include "fleet/day.hpp"
#include "text/number_text.hpp"
#include "text/plain_text.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace trussmap::fleet {
namespace {

constexpr char kField = '\x1f';
constexpr char kRecord = '\x1e';
constexpr std::size_t kMostColumns = 2000;

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
    text += text::joined(one.of_model ? 1 : 0, kField, one.effect, kField, one.channel, kField,
                         one.shape, kField, one.place, kRecord);
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
    columns.push_back({fields[0] == "1", fields[1], fields[2], fields[3],
                       static_cast<int>(std::strtol(fields[4].c_str(), nullptr, 10))});
  }
  return columns;
}

int count_in(const store::Statement& row, int column) {
  const std::int64_t count = row.integer(column);
  if (count < 0 || count > std::numeric_limits<int>::max()) {
    throw std::invalid_argument(text::joined("a count is ", count, ", expected 0 or more"));
  }
  return static_cast<int>(count);
}

FleetRow row_in(const store::Statement& day) {
  FleetRow row;
  row.robot = day.text(0);
  row.date = day.text(1);
  row.recordings = count_in(day, 2);
  row.chi2 = day.real(3);
  row.dof = count_in(day, 4);
  row.held_out_legs = count_in(day, 5);
  row.held_out_rms = day.real(6);
  row.held_out_stretch = day.real(7);
  row.held_out_orientation = day.real(8);
  row.columns = columns_in(day.text(9));
  const std::size_t count = row.columns.size();
  const std::vector<double> facts = numbers_in(day.bytes(10), 4 * count);
  for (std::size_t k = 0; k < count; ++k) {
    row.reference.push_back(facts[4 * k]);
    row.prior_sd.push_back(facts[4 * k + 1]);
    row.largest.push_back(facts[4 * k + 2]);
    row.whole.push_back(facts[4 * k + 3]);
  }
  const std::vector<double> g = numbers_in(day.bytes(11), count);
  row.g = Eigen::Map<const Eigen::VectorXd>(g.data(), static_cast<Eigen::Index>(count));
  row.S = unpacked(numbers_in(day.bytes(12), count * (count + 1) / 2),
                   static_cast<Eigen::Index>(count));
  return row;
}

}  // namespace

void make_fleet_tables(const store::Database& database) {
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

void check_fleet_row(const FleetRow& row) {
  const auto plain = [](const std::string& text, const char* what) {
    if (!text::is_plain_text(text)) {
      throw std::invalid_argument(
          text::joined(what, " holds a control character, expected printable text"));
    }
  };
  const auto at_least_0 = [](double value, const char* what) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument(text::joined(what, " is no number of 0 or more"));
    }
  };
  if (!day_in(row.date)) throw std::invalid_argument("the day is none, expected YYYY-MM-DD");
  if (row.robot.empty()) throw std::invalid_argument("a robot has no name");
  plain(row.robot, "the robot's name");
  for (const auto& [key, value] : row.metadata) {
    plain(key, "a key");
    plain(value, "a value");
  }
  for (const FleetColumn& one : row.columns) {
    plain(one.effect, "an effect's name");
    plain(one.channel, "a channel");
    plain(one.shape, "a shape");
  }
  for (const double one : {row.chi2, row.held_out_rms, row.held_out_stretch,
                           row.held_out_orientation, static_cast<double>(row.recordings),
                           static_cast<double>(row.dof), static_cast<double>(row.held_out_legs)}) {
    at_least_0(one, "a figure of the day");
  }
  if (!row.g.allFinite() || !row.S.allFinite()) {
    throw std::invalid_argument("a number is not finite");
  }
  for (Eigen::Index k = 0; k < row.S.rows(); ++k) at_least_0(row.S(k, k), "a sum of squares");
}

std::string fleet_model_in(const store::Database& database) {
  store::Statement get(database, "SELECT text FROM model");
  return get.step() ? get.text(0) : std::string();
}

void put_fleet_row(const store::Database& database, const FleetRow& row) {
  std::vector<double> facts;
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    facts.insert(facts.end(), {row.reference[k], row.prior_sd[k], row.largest[k], row.whole[k]});
  }
  const std::vector<double> S = packed(row.S);
  store::Statement day(database,
                       "REPLACE INTO days VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  day.bind(0, row.robot).bind(1, row.date).bind(2, row.recordings).bind(3, row.chi2);
  day.bind(4, row.dof).bind(5, row.held_out_legs).bind(6, row.held_out_rms);
  day.bind(7, row.held_out_stretch).bind(8, row.held_out_orientation);
  day.bind(9, text_of(row.columns)).bind_bytes(10, bytes_of(facts.data(), facts.size()));
  day.bind_bytes(11, bytes_of(row.g.data(), static_cast<std::size_t>(row.g.size())));
  day.bind_bytes(12, bytes_of(S.data(), S.size()));
  day.run();
  store::Statement clear(database, "DELETE FROM metadata WHERE robot = ? AND date = ?");
  clear.bind(0, row.robot).bind(1, row.date).run();
  store::Statement one(database, "INSERT INTO metadata VALUES (?, ?, ?, ?)");
  for (const auto& [key, value] : row.metadata) {
    one.bind(0, row.robot).bind(1, row.date).bind(2, key).bind(3, value).run();
  }
}

std::vector<FleetRow> fleet_rows_in(const store::Database& database) {
  const std::string model = fleet_model_in(database);
  std::vector<FleetRow> rows;
  store::Statement days(database, "SELECT * FROM days ORDER BY robot, date");
  store::Statement metadata(database,
                            "SELECT key, value FROM metadata WHERE robot = ? AND date = ?");
  while (days.step()) {
    try {
      FleetRow row = row_in(days);
      row.model = model;
      metadata.bind(0, row.robot).bind(1, row.date);
      while (metadata.step()) row.metadata[metadata.text(0)] = metadata.text(1);
      metadata.reset();
      check_fleet_row(row);
      rows.push_back(std::move(row));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          text::joined("row ", rows.size() + 1, " of days: ", error.what()));
    }
  }
  return rows;
}

}  // namespace trussmap::fleet
