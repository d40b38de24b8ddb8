// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The file of a store: where it lies, its lock, and how a user is told what is wrong with it.
#pragma once

#include "store/database.hpp"
#include "store/file_lock.hpp"
#include "trussmap/error.hpp"

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace trussmap::store {

/// With a folder in front: SQLite gives a meaning of its own to some names. `kind` of store in
/// words. Throws InputError where no file can be.
[[nodiscard]] std::filesystem::path place_of_database(const std::filesystem::path& file,
                                                      const std::string& kind);

/// Of a map store; SQLite takes a byte for nothing. Throws InputError where no store can be.
[[nodiscard]] std::filesystem::path place_of_store(const std::filesystem::path& file);

/// For as long as it is held nobody else writes. Throws InputError.
[[nodiscard]] std::unique_ptr<FileLock> lock_store(const std::filesystem::path& file);

[[nodiscard]] InputError said_of_store(const std::filesystem::path& file,
                                       const DatabaseError& error);

/// A store's file while it is being made: it goes again, with what SQLite lays beside it, unless it
/// is kept, or was there before. For who holds the store's lock.
class FreshFile {
 public:
  /// `made`: it is there already, and goes all the same.
  explicit FreshFile(std::filesystem::path place, bool made = false);
  ~FreshFile();
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;

  void keep() { goes_ = false; }

 private:
  std::filesystem::path place_;
  bool goes_;
};

/// Calls something; what the database throws becomes an InputError.
template <typename Call>
auto naming_store(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const DatabaseError& error) {
    throw said_of_store(file, error);
  } catch (const DamagedCell& error) {
    throw InputError(file.string(), 0, std::string("is damaged: it has ") + error.what());
  }
}

/// Calls something that reads rows: std::invalid_argument says what a store is damaged that has it.
template <typename Call>
auto undamaged_store(const std::filesystem::path& file, const Call& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, std::string("is damaged: it has ") + error.what());
  }
}

}  // namespace trussmap::store
