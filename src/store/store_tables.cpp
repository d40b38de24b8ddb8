// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/store_tables.hpp"

#include "store/facts.hpp"
#include "store/first_version.hpp"
#include "store/leg_rows.hpp"
#include "store/memory_rows.hpp"
#include "store/schema.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::store {
namespace {

constexpr std::int64_t kApplication = 0x7472736d;  // "trsm"
constexpr std::int64_t kVersion = 2;
constexpr std::int64_t kFirstVersion = 1;

std::vector<std::string> tables_of(const Database& database) {
  return schema_of(database, {"facts", "sessions", "legs", "landmarks", "routes", "reckoned",
                              "corners", "chain", "misfits", "left_out", "state", "map"});
}

/// A new store's.
const std::vector<std::string>& made_tables() {
  static const std::vector<std::string> kTables = [] {
    const Database memory(":memory:", Database::Access::write);
    create_store(memory, {});
    return tables_of(memory);
  }();
  return kTables;
}

const std::vector<std::string>& first_tables() {
  static const std::vector<std::string> kTables = [] {
    const Database memory(":memory:", Database::Access::write);
    create_first_version(memory);
    return tables_of(memory);
  }();
  return kTables;
}

}  // namespace

void create_store(const Database& database, const MapBuilderOptions& options) {
  database.run(text::joined("PRAGMA application_id = ", kApplication));
  database.run(text::joined("PRAGMA user_version = ", kVersion));
  create_facts_table(database);
  create_leg_tables(database);
  create_memory_tables(database);
  Facts facts(database);
  put_options_among(facts, options);
}

bool is_store(const std::filesystem::path& file, const Database& database) {
  const std::int64_t application = database.number("PRAGMA application_id");
  const std::int64_t version = database.number("PRAGMA user_version");
  if (application == 0 && database.number("SELECT count(*) FROM sqlite_schema") == 0) return false;
  if (application != kApplication) throw InputError(file.string(), 0, "is no map store");
  if (version != kVersion && version != kFirstVersion) {
    throw InputError(file.string(), 0,
                     text::joined("is a map store of version ", version, ", expected ", kVersion));
  }
  if (tables_of(database) != (version == kFirstVersion ? first_tables() : made_tables())) {
    throw InputError(file.string(), 0, "is damaged: its tables are not those of a map store");
  }
  return true;
}

bool is_of_first_version(const Database& database) {
  return database.number("PRAGMA user_version") == kFirstVersion;
}

}  // namespace trussmap::store
