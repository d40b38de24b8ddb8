// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which process has which landmark: equal shares along a Hilbert curve, numbered from 0 through all
// processes. And who knows the number of an id: a directory that is itself in parts.
#pragma once

#include "distributed/truss_lines.hpp"

#include <string>
#include <vector>

namespace trussmap::distributed {

struct PlacedLandmark {
  std::int64_t id = 0;
  double x = 0.0;  ///< of the file, m
  double y = 0.0;
  std::int64_t line = 0;
  std::int64_t fixed = 0;  ///< 1: held where it is
};

/// What the directory says of an id.
struct Entry {
  std::int64_t number = -1;  ///< -1: there is no such landmark
  double x = 0.0;
  double y = 0.0;
  std::int64_t fixed = 0;
};

class Placing {
 public:
  /// Throws InputError in all processes where an id is there twice, or a fixed one not at all. In a
  /// file without FIX its first landmark is fixed.
  Placing(const Communicator& all, const TrussLines& lines, const std::string& file);

  /// Of this process, in the order of their numbers.
  [[nodiscard]] const std::vector<PlacedLandmark>& own() const { return own_; }
  [[nodiscard]] std::int64_t first() const { return first_; }  ///< number of the first of these
  [[nodiscard]] std::int64_t count() const { return starts_.back(); }  ///< of all processes
  /// The process that has it.
  [[nodiscard]] int owner(std::int64_t number) const;
  [[nodiscard]] bool mine(std::int64_t number) const {
    return number >= first_ && number < first_ + static_cast<std::int64_t>(own_.size());
  }
  [[nodiscard]] std::size_t local(std::int64_t number) const {
    return static_cast<std::size_t>(number - first_);
  }

  /// Of each id, asked by all processes at once.
  [[nodiscard]] std::vector<Entry> look_up(const std::vector<std::int64_t>& ids);

 private:
  struct Known {
    std::int64_t id;
    Entry entry;
    std::int64_t line;
  };

  void share(const TrussLines& lines);
  void number();
  void make_directory(const std::string& file);
  void fix(const TrussLines& lines, const std::string& file);
  void fix_first();
  void tell_directory();
  /// The end where the id is not known.
  [[nodiscard]] std::vector<Known>::iterator find(std::int64_t id);

  const Communicator& all_;
  std::vector<PlacedLandmark> own_;
  std::int64_t first_ = 0;
  std::vector<std::int64_t> starts_;  ///< number of each process's first landmark, and of all
  std::vector<Known> directory_;      ///< by id: the ids that this process is to know
};

}  // namespace trussmap::distributed
