// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Files whose last row lacks some of its characters, and can be read all the same. Many programs
// end no last line; where its last field is shorter than that of any other row, or a name of its
// own that others go on from, the file was cut off.
#include "io/csv.hpp"
#include "text/number_text.hpp"
#include "trussmap/check.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFewestOtherRows = 10;

bool lacks_line_end(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream || stream.tellg() <= 0) return false;
  stream.seekg(-1, std::ios::end);
  return stream.get() != '\n';
}

std::size_t decimals_of(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

/// The last column of a table.
struct LastColumn {
  std::string name;
  std::vector<std::string> fields;
  std::size_t line = 0;  ///< of the last row
};

LastColumn last_column(const fs::path& file) {
  const std::string text = read_file(file);
  io::CsvReader csv(text, file.string());
  const int column = static_cast<int>(csv.columns().size()) - 1;
  LastColumn result{csv.columns().back(), {}, 0};
  while (csv.next()) {
    result.fields.emplace_back(csv.field(column));
    result.line = csv.line();
  }
  return result;
}

/// What is wrong with a name; nothing, where it is as good as others.
std::string what_name_lacks(const LastColumn& column, const Recording& recording) {
  const std::string& name = column.fields.back();
  if (std::count(column.fields.begin(), column.fields.end(), name) > 1) return {};
  std::set<std::string_view> others(column.fields.begin(), column.fields.end() - 1);
  for (const SurveyPoint& one : recording.survey) others.insert(one.landmark);
  const auto after = others.lower_bound(name);
  if (after == others.end() || *after == name || !after->starts_with(name)) return {};
  return text::joined("its landmark \"", name,
                      "\" is found nowhere else, where others go on from there (", *after, ")");
}

std::string what_number_lacks(const LastColumn& column) {
  const std::string& last = column.fields.back();
  std::size_t least = std::string::npos;
  bool all = true;
  for (std::size_t k = 0; k + 1 < column.fields.size(); ++k) {
    least = std::min(least, decimals_of(column.fields[k]));
    all = all && !column.fields[k].empty();
  }
  if (last.empty())
    return all ? text::joined("its ", column.name, " is empty, as in no other row") : "";
  if (decimals_of(last) >= least) return {};
  return text::joined("its ", column.name, " is ", last, ", where all other rows have ", least,
                      " decimals at least");
}

std::optional<CheckFinding> cut_row_of(const fs::path& file, const Recording& recording) {
  if (!lacks_line_end(file)) return std::nullopt;
  const LastColumn column = last_column(file);
  if (column.fields.size() <= kFewestOtherRows) return std::nullopt;
  const std::string lacks =
      column.name == "landmark" ? what_name_lacks(column, recording) : what_number_lacks(column);
  if (lacks.empty()) return std::nullopt;
  return CheckFinding{file.string(), column.name, "cut off",
                      text::joined("the last line, ", column.line, ", has no end, and ", lacks),
                      "copy the file again, whole; or remove its last line"};
}

}  // namespace

std::vector<CheckFinding> check_read_recordings(const std::vector<Recording>& recordings,
                                                const Model* model, const std::string& model_file) {
  std::vector<CheckFinding> findings = check_recordings(recordings, model, model_file);
  for (const Recording& recording : recordings) {
    for (const char* name :
         {"drive.csv", "sightings.csv", "fixes.csv", "loops.csv", "survey.csv", "truth.csv"}) {
      if (auto found = cut_row_of(fs::path(recording.name) / name, recording)) {
        findings.push_back(*std::move(found));
      }
    }
  }
  return findings;
}

}  // namespace trussmap
