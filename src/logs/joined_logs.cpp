// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/joined_logs.hpp"

#include "logs/mat_file.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

std::string without_xz(const std::string& name) {
  return name.ends_with(".xz") ? name.substr(0, name.size() - 3) : name;
}

/// Whether a path ends so, at a folder's border.
bool ends_at_border(const std::string& path, const std::string& end) {
  if (end.empty() || !path.ends_with(end)) return false;
  return path.size() == end.size() || path[path.size() - end.size() - 1] == '/';
}

/// The last `parts` names of a path.
std::string tail_of(const fs::path& path, std::size_t parts) {
  std::vector<fs::path> names(path.begin(), path.end());
  fs::path tail;
  for (std::size_t k = names.size() - std::min(parts, names.size()); k < names.size(); ++k) {
    tail /= names[k];
  }
  return tail.generic_string();
}

/// A log, or the tables of a file that has several.
void add_file(const fs::path& file, std::vector<fs::path>& logs) {
  std::error_code ignored;
  if (is_mat_file(file) && fs::is_regular_file(file, ignored)) {
    const std::vector<fs::path> tables = mat_logs(file);
    logs.insert(logs.end(), tables.begin(), tables.end());
  } else {
    logs.push_back(file);
  }
}

void add_folder(const fs::path& folder, std::vector<fs::path>& logs) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& one : fs::directory_iterator(folder)) {
    if (one.is_regular_file() && is_message_log(one.path())) found.push_back(one.path());
  }
  if (found.empty()) {
    throw InputError(
        folder.string(), 0,
        "is a folder without logs, expected tables (.csv, .tsv, .txt, .mat) or bags in it");
  }
  std::sort(found.begin(), found.end());
  for (const fs::path& one : found) add_file(one, logs);
}

}  // namespace

GivenDefinitions given_definitions(const LogOptions& options) {
  if (options.definitions.empty()) return nullptr;
  return std::make_shared<const MessageDefinitions>(options.definitions);
}

std::vector<LogCount> counts_of(const std::vector<PassedOver>& passed_over) {
  std::vector<LogCount> counts;
  counts.reserve(passed_over.size());
  for (const PassedOver& one : passed_over) {
    counts.push_back({static_cast<std::size_t>(one.number), one.what + ", passed over"});
  }
  return counts;
}

JoinedLogs::JoinedLogs(const std::vector<fs::path>& paths, GivenDefinitions definitions)
    : definitions_(std::move(definitions)) {
  std::error_code ignored;
  for (const fs::path& one : paths) {
    if (fs::is_directory(one, ignored) && !is_message_log(one)) {
      add_folder(one, logs_);
    } else {
      add_file(one, logs_);
    }
  }
  if (logs_.empty()) throw InputError("", 0, "no log is given, expected one or more");
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      if (logs_[j] == logs_[k] || fs::equivalent(logs_[j], logs_[k], ignored)) {
        throw InputError(logs_[k].string(), 0, "is given twice, expected each log once");
      }
    }
    tables_.push_back(is_table_log(logs_[k]));
  }
  for (const fs::path& one : logs_) {
    std::size_t parts = 1;
    const auto others = [&] {
      return std::count_if(logs_.begin(), logs_.end(), [&](const fs::path& other) {
        return tail_of(other, parts) == tail_of(one, parts);
      });
    };
    while (others() > 1 && tail_of(one, parts) != tail_of(one, parts + 1)) ++parts;
    names_.push_back(tail_of(one, parts));
  }
}

std::string JoinedLogs::all_names() const {
  if (logs_.size() == 1) return logs_.front().string();
  std::string text;
  for (const std::string& one : names_) text += (text.empty() ? "" : ", ") + one;
  return text;
}

std::size_t JoinedLogs::named(const std::string& file) const {
  const std::string wanted = without_xz(fs::path(file).lexically_normal().generic_string());
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const std::string path = without_xz(logs_[k].lexically_normal().generic_string());
    if (path == wanted) return k;
    if (ends_at_border(path, wanted)) found.push_back(k);
  }
  if (found.size() == 1) return found.front();
  throw std::invalid_argument("file = \"" + file + "\" is " +
                              (found.empty() ? "none" : "the name of several") +
                              " of the files that are read, expected one of " + all_names());
}

LogEnd JoinedLogs::read(const LogVisit& visit,
                        const std::function<bool(std::size_t)>& needed) const {
  LogEnd all;
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    if (!needed(k)) continue;
    const std::size_t before = all.topics.size();
    const auto own = [&](LogTopic topic) {
      topic.file = names_[k];
      topic.input = k;
      return topic;
    };
    std::map<std::size_t, LogTopic> topics;
    LogVisit one;
    one.elements = visit.elements;
    one.definitions = definitions_.get();
    if (visit.wanted) {
      one.wanted = [&](const LogTopic& topic) { return visit.wanted(own(topic)); };
    }
    if (visit.message) {
      one.message = [&](const LogMessage& message) {
        auto known = topics.find(message.number);
        if (known == topics.end() || known->second.type != message.topic.type) {
          known = topics.insert_or_assign(message.number, own(message.topic)).first;
        }
        visit.message({known->second, before + message.number, message.has_time, message.log_time,
                       message.publish_time, message.fields, message.line, message.row});
      };
    }
    LogEnd end = read_message_log(logs_[k], one);
    require_messages(logs_[k], end);
    for (LogTopic& topic : end.topics) all.topics.push_back(own(std::move(topic)));
    const std::string where = logs_.size() > 1 ? " (" + names_[k] + ")" : "";
    for (const PassedOver& one_kind : end.passed_over) {
      all.passed_over.push_back({one_kind.number, one_kind.what + where});
    }
    if (end.cut_off.empty()) continue;
    all.cut_off += (all.cut_off.empty() ? "" : "; ") + end.cut_off + where;
  }
  return all;
}

}  // namespace trussmap::logs
