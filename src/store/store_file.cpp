// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/store_file.hpp"

#include "trussmap/map_store.hpp"

#include <cstdint>
#include <system_error>
#include <utility>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTaken = "is being written by another program, expected one at a time";

/// Links followed, so that two names of one store are one lock.
fs::path lock_of(const fs::path& place) {
  std::error_code ignored;
  fs::path followed = fs::weakly_canonical(place, ignored);
  if (ignored) followed = place;
  followed += "-lock";
  return followed;
}

}  // namespace

bool is_map_store(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".db" || ending == ".sqlite" || ending == ".sqlite3";
}

}  // namespace trussmap

namespace trussmap::store {

fs::path place_of_database(const fs::path& file, const std::string& kind) {
  if (file.empty()) throw InputError(kind, 0, "has no name, expected a file");
  std::error_code failed;
  fs::path place = fs::absolute(file, failed);
  if (failed) throw InputError(file.string(), 0, "cannot be found: " + failed.message());
  if (fs::is_directory(place, failed)) {
    throw InputError(file.string(), 0, "is a folder, expected a " + kind);
  }
  return place;
}

fs::path place_of_store(const fs::path& file) {
  fs::path place = place_of_database(file, "map store");
  std::error_code failed;
  constexpr std::uintmax_t kHeader = 100;  // bytes of the smallest database
  const std::uintmax_t size = fs::file_size(place, failed);
  if (!failed && size > 0 && size < kHeader) throw InputError(file.string(), 0, "is no map store");
  return place;
}

FreshFile::FreshFile(fs::path place, bool made) : place_(std::move(place)) {
  std::error_code ignored;
  goes_ = made || !fs::exists(fs::symlink_status(place_, ignored));
}

FreshFile::~FreshFile() {
  if (!goes_) return;
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
    fs::path file = place_;
    file += ending;
    std::error_code ignored;
    fs::remove(file, ignored);
  }
}

std::unique_ptr<FileLock> lock_store(const fs::path& file) {
  try {
    return std::make_unique<FileLock>(lock_of(place_of_store(file)));
  } catch (const std::system_error& error) {
    const bool taken = error.code() == std::errc::operation_would_block;
    throw InputError(file.string(), 0,
                     taken ? kTaken : "cannot be locked: " + error.code().message());
  }
}

InputError said_of_store(const fs::path& file, const DatabaseError& error) {
  if (error.busy()) return {file.string(), 0, kTaken};
  if (error.no_database()) return {file.string(), 0, "is no map store"};
  return {file.string(), 0, std::string("cannot be read or written: ") + error.what()};
}

}  // namespace trussmap::store
