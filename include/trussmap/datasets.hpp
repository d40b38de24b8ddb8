// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::datasets.
//
// Public data sets as recordings: one table of formats, one function that reads any of them. What
// each file's columns are stands at the top of its reader (src/datasets).
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

/// What a reader counted or measured: rows kept, merged, dropped, and why.
struct DatasetFigure {
  std::string key;  ///< "merged_times"
  double value = 0.0;
  std::string
      words;  ///< "odometry rows merged: their time repeats or runs backwards"; "": of a note
};

struct Dataset {
  Recording recording;  ///< times from 0 on, in s
  Model model;          ///< the robot as its makers state it, and noise that suits the set

  double epoch = 0.0;                   ///< s, of t = 0, where the set counts from elsewhere
  std::string comment;                  ///< lines on where it comes from and where its times begin
  std::vector<DatasetFigure> figures;   ///< in the order in which they are told; zeros, too
  std::vector<std::string> notes = {};  ///< what else was done, a sentence each

  /// By its key; throws std::out_of_range where there is none.
  [[nodiscard]] double figure(std::string_view key) const;
};

struct DatasetFormat {
  std::string_view name;      ///< "MRCLAM"
  std::string_view expected;  ///< what is given to read it: "DIR/RobotN of an MRCLAM data set"
  bool (*is)(const std::filesystem::path&);  ///< by names, or a first line; complete or not
  Dataset (*read)(const std::filesystem::path&);
};

/// All that there are, in the order in which they are tried.
[[nodiscard]] std::span<const DatasetFormat> dataset_formats();

/// The first whose files these are; nullptr where none is.
[[nodiscard]] const DatasetFormat* dataset_format(const std::filesystem::path& path);

/// Reads it, files plain or with .xz. Throws InputError, with file and line where there is one;
/// also where it is none of the formats.
[[nodiscard]] Dataset read_dataset(const std::filesystem::path& path);

}  // namespace trussmap
