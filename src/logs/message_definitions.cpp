// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/message_definitions.hpp"

#include "logs/byte_reader.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <system_error>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestMsgFile = std::uintmax_t{1} << 20U;  // bytes
constexpr std::size_t kLargestMsgFiles = std::size_t{32} << 20U;      // all together

/// PACKAGE/NAME of a file; empty: it lies in no folder that is a package.
std::string type_of_file(const fs::path& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  fs::path package = whole.parent_path();
  if (package.filename() == "msg") package = package.parent_path();
  if (package.filename().empty()) return {};
  return package.filename().string() + "/" + whole.stem().string();
}

std::string without_returns(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
  return text;
}

}  // namespace

MessageDefinitions::MessageDefinitions(const std::vector<fs::path>& paths) {
  for (const fs::path& one : paths) {
    std::error_code ignored;
    if (fs::is_directory(one, ignored)) {
      add_folder(one);
    } else if (!fs::exists(one, ignored)) {
      throw InputError(one.string(), 0, "does not exist, expected a .msg file or a folder of them");
    } else if (one.extension() != ".msg") {
      throw InputError(one.string(), 0, "is no .msg file, expected PACKAGE/NAME.msg or a folder");
    } else {
      add_file(one);
    }
  }
}

void MessageDefinitions::add_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator
           entry(folder, fs::directory_options::skip_permission_denied, error),
       end;
       !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().extension() == ".msg" && entry->is_regular_file(ignored)) {
      files.push_back(entry->path());
    }
  }
  if (files.empty()) {
    throw InputError(folder.string(), 0,
                     "is a folder without .msg files, expected PACKAGE/NAME.msg or "
                     "PACKAGE/msg/NAME.msg in it");
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) add_file(file);
}

void MessageDefinitions::add_file(const fs::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = fs::file_size(file, ignored);
  bytes_ += static_cast<std::size_t>(std::min(size, kLargestMsgFile + 1));
  if (size > kLargestMsgFile || bytes_ > kLargestMsgFiles) {
    throw InputError(file.string(), 0,
                     size > kLargestMsgFile
                         ? "has more than " + std::to_string(kLargestMsgFile) +
                               " bytes, expected the definition of a message"
                         : "makes definitions of more than " + std::to_string(kLargestMsgFiles) +
                               " bytes, expected fewer at once");
  }
  const std::string type = type_of_file(file);
  if (type.empty()) {
    throw InputError(file.string(), 0, "lies in no folder, expected one that is its package");
  }
  Definition one{without_returns(read_file(file)), file.string()};
  const auto [known, is_new] = by_type_.try_emplace(type, std::move(one));
  // Both the sources and what is installed of them may lie in a workspace.
  if (is_new || known->second.text == without_returns(read_file(file))) return;
  throw InputError(file.string(), 0,
                   "defines " + in_a_line(type) + " otherwise than " + known->second.file +
                       ", expected one of the two");
}

const MessageDefinitions::Definition* MessageDefinitions::find(const std::string& type) const {
  const auto known = by_type_.find(type);
  return known == by_type_.end() ? nullptr : &known->second;
}

}  // namespace trussmap::logs
