// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "measure.hpp"
#include "parts.hpp"
#include "trussmap/recording_files.hpp"

#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <unistd.h>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

Recording random_drive(int rows) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.drive.covariates.push_back({"temperature", {}});
  for (int row = 1; row <= rows; ++row) {
    recording.drive.t.push_back(0.02 * row);
    recording.drive.left.push_back(0.01 + 1e-4 * normal(random));
    recording.drive.right.push_back(0.01 + 1e-4 * normal(random));
    recording.drive.heading.push_back(normal(random));
    recording.drive.covariates[0].values.push_back(20.0 + normal(random));
  }
  recording.sightings = {{recording.drive.t.front(), "a"}, {recording.drive.t.back(), "b"}};
  return recording;
}

/// What anybody would write first: the whole file, then number after number, nothing checked.
double read_with_strtod(const std::filesystem::path& file, int columns) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = content.str();
  std::vector<std::vector<double>> values(static_cast<std::size_t>(columns));
  const char* at = text.c_str() + text.find('\n') + 1;
  while (*at != '\0') {
    for (auto& column : values) {
      char* end = nullptr;
      column.push_back(std::strtod(at, &end));
      at = end + 1;
    }
  }
  return static_cast<double>(values[0].size());
}

}  // namespace

void input_part(int rows, int repetitions) {
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("trussmap_input_{}", getpid());
  write_recording(folder, random_drive(rows));
  fmt::print("\nInput: drive.csv, {} rows of 5 columns, {:.0f} MB (least of {})\n", rows,
             static_cast<double>(std::filesystem::file_size(folder / "drive.csv")) / 1e6,
             repetitions);
  const std::vector<Rival> rivals{{"a plain strtod loop",
                                   [&](Stages& s) {
                                     const double read = read_with_strtod(folder / "drive.csv", 5);
                                     s.end("read");
                                     return read;
                                   }},
                                  {"trussmap, checked", [&](Stages& s) {
                                     const Recording recording = read_recording(folder);
                                     s.end("read");
                                     return static_cast<double>(recording.drive.rows());
                                   }}};
  const std::vector<Run> runs = race(rivals, repetitions);
  print(rivals, runs);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    fmt::print("  {}: {:.2f} million rows per second\n", rivals[k].name,
               1e-6 * rows / runs[k].stages.total());
  }
  std::filesystem::remove_all(folder);
}

}  // namespace trussmap::bench
