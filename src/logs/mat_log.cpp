// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/mat_file.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

/// The file of a table's path; empty: it is none.
fs::path file_of(const fs::path& path) {
  std::error_code ignored;
  if (is_mat_file(path)) return fs::is_directory(path, ignored) ? fs::path() : path;
  const fs::path parent = path.parent_path();
  return is_mat_file(parent) && fs::is_regular_file(parent, ignored) ? parent : fs::path();
}

const MatTable& table_of(const MatFile& read, const fs::path& path, const fs::path& file) {
  if (read.tables.empty()) {
    std::string beside;
    for (const PassedOver& one : read.passed_over) {
      beside += (beside.empty() ? ": " : ", ") + std::to_string(one.number) + " " + one.what;
    }
    throw InputError(file.string(), 0,
                     "holds no two variables of one length" + beside +
                         ", expected columns of a table, as t, left and right");
  }
  if (path == file) return read.tables.front();
  const auto found = std::ranges::find(read.tables, path.filename().string(), &MatTable::name);
  if (found != read.tables.end()) return *found;
  throw InputError(path.string(), 0, "is no table of that file");
}

void add_cell(FieldTree& tree, const MatColumn& column, std::size_t row) {
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double value = column.values[row];
  if (column.whole && std::abs(value) < kExact) {
    tree.add_integer(column.name, static_cast<std::int64_t>(value));
  } else {
    tree.add_number(column.name, value);
  }
}

std::size_t fingerprint(const MatTable& table, std::size_t row) {
  std::string bytes;
  for (const MatColumn& one : table.columns) {
    bytes.append(reinterpret_cast<const char*>(&one.values[row]), sizeof(double));
  }
  return std::hash<std::string>()(bytes);
}

}  // namespace

bool is_mat_log(const fs::path& path) {
  return !file_of(path).empty();
}

std::vector<fs::path> mat_logs(const fs::path& file) {
  const MatFile read = read_mat_file(file);
  if (read.tables.size() < 2) return {file};
  std::vector<fs::path> paths;
  for (const MatTable& one : read.tables) paths.push_back(file / one.name);
  return paths;
}

LogEnd read_mat_log(const fs::path& path, const LogVisit& visit) {
  const fs::path file = file_of(path);
  MatFile read = read_mat_file(file);
  const MatTable& table = table_of(read, path, file);
  LogTopic topic{.name = "", .type = "", .encoding = "mat", .unread = "", .table = true};
  const bool wanted = visit.wanted == nullptr || visit.wanted(topic);
  FieldTree tree;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    ++topic.messages;
    if (!wanted || !visit.message) continue;
    tree.clear();
    const std::size_t group = tree.open_group("");
    for (const MatColumn& one : table.columns) add_cell(tree, one, row);
    tree.close(group);
    visit.message({topic, 0, false, 0, 0, tree.root(), row + 1, fingerprint(table, row)});
  }
  LogEnd end;
  end.topics.push_back(std::move(topic));
  if (&table == &read.tables.front()) end.passed_over = std::move(read.passed_over);  // said once
  return end;
}

}  // namespace trussmap::logs
