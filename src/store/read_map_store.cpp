// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/present.hpp"
#include "store/facts.hpp"
#include "store/first_version.hpp"
#include "store/leg_rows.hpp"
#include "store/memory_rows.hpp"
#include "store/store_file.hpp"
#include "store/store_tables.hpp"
#include "trussmap/map_store.hpp"

#include <system_error>

namespace trussmap {
using namespace store;

namespace {

namespace fs = std::filesystem;

/// Calls `read` with a store's database and options, within one transaction.
template <typename Read>
auto reading(const fs::path& file, const Read& read) {
  return naming_store(file, [&] {
    if (!files::is_present(file))
      throw InputError(file.string(), 0, "is missing, expected a map store");
    const Database database(place_of_store(file), Database::Access::read);
    database.run("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; BEGIN");
    if (!is_store(file, database)) {
      throw InputError(file.string(), 0, "is empty, expected a map store");
    }
    const auto read_tables = [&](const Database& present) {
      return undamaged_store(file, [&] {
        Facts facts(present);
        return read(present, options_among(facts));
      });
    };
    if (!is_of_first_version(database)) return read_tables(database);
    const Database copy(":memory:", Database::Access::write);
    copy.take_over(database);
    upgrade_first_version(copy);
    return read_tables(copy);
  });
}

}  // namespace

MapBuilder read_builder(const fs::path& file) {
  return reading(file, [](const Database& database, const MapBuilderOptions& options) {
    return BuilderAccess::restored(MemoryRows(database).load(options), options);
  });
}

StoredMap read_map_store(const fs::path& file) {
  return reading(file, [](const Database& database, const MapBuilderOptions& options) {
    StoredMap stored;
    stored.map = BuilderAccess::restored(MemoryRows(database).load(options), options).map();
    stored.method = options.method;
    stored.sessions = sessions_in(database);
    stored.legs = legs_in(database);
    return stored;
  });
}

}  // namespace trussmap
