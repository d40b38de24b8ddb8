// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/temporary.hpp"
#include "files/whole_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <unistd.h>

namespace trussmap {
using namespace files;

namespace {

namespace fs = std::filesystem;

// What discard_temporaries() deletes: names that are complete before the first file is begun.
using Names = std::vector<std::string>;
std::atomic<const Names*> under_way{nullptr};
static_assert(std::atomic<const Names*>::is_always_lock_free);

/// Makes names known while it lives. Of several calls at once the last one's are.
class UnderWay {
 public:
  explicit UnderWay(Names names) : names_(std::move(names)) { under_way = &names_; }
  ~UnderWay() {
    const Names* mine = &names_;
    under_way.compare_exchange_strong(mine, nullptr);
  }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

 private:
  Names names_;
};

/// Ctrl-C waits while it lives: between two renames it would leave one file new and one old.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ending, signal);
    ::pthread_sigmask(SIG_BLOCK, &ending, &before_);
  }
  ~SignalsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_{};
};

InputError unwritten(const fs::path& named, int reason) {
  return {named.string(), 0, std::string("cannot be written: ") + std::strerror(reason)};
}

/// A file, and where it really goes.
struct Target {
  fs::path named;
  const std::string* content;
  fs::path place;        // links followed
  bool stream = false;   // a terminal, pipe or device: written to as it is, never replaced
  fs::path temporary{};  // removed in the end, unless renamed
  Descriptor lock{};     // on the temporary
  bool renamed = false;

  Target(fs::path name, const std::string& text)
      : named(std::move(name)), content(&text), place(named) {}
  Target(Target&&) = default;
  Target& operator=(Target&&) = delete;
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target() {
    if (lock.valid() && !renamed) ::unlink(temporary.c_str());
  }
};

Target target_of(const fs::path& path, const std::string& content) {
  std::error_code ignored;
  Target target(path, content);
  if (fs::is_symlink(path, ignored)) {
    const fs::path followed = fs::weakly_canonical(path, ignored);
    if (!ignored) target.place = followed;
  }
  if (fs::is_directory(target.place, ignored)) {
    throw InputError(path.string(), 0, "is a folder, expected a file to write");
  }
  target.stream = fs::exists(target.place, ignored) && !fs::is_regular_file(target.place, ignored);
  if (!target.stream) target.temporary = temporary_for(target.place);
  return target;
}

fs::path whole_path(const fs::path& path) {
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

void write_stream(const Target& target) {
  Descriptor opened(::open(target.place.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC | O_NOCTTY));
  if (!opened.valid() || !write_all(opened.number(), *target.content, false) || !opened.close()) {
    throw unwritten(target.named, errno);
  }
}

/// Why an attempt ends before anything was renamed: the next one draws other names, and does
/// without whole folders where links are refused.
struct Again {
  bool whole = true;
};

/// One attempt at files and folders: planned, written, renamed.
class Writing {
 public:
  Writing(const NamedContents& files, const std::vector<FolderOfFiles>& folders, bool whole);
  void write();
  void rename();

 private:
  void plan(const FolderOfFiles& folder, bool whole);
  void plan(const fs::path& path, const std::string& content);
  [[nodiscard]] std::set<fs::path> places() const;
  [[nodiscard]] Names names() const;

  std::vector<Target> targets_;
  std::vector<std::unique_ptr<WholeFolder>> folders_;
  std::vector<fs::path> going_;  ///< files that go before the first rename
  std::optional<UnderWay> known_;
};

Writing::Writing(const NamedContents& files, const std::vector<FolderOfFiles>& folders,
                 bool whole) {
  for (const FolderOfFiles& folder : folders) plan(folder, whole);
  for (const auto& [path, content] : files) plan(path, content);
}

void Writing::plan(const FolderOfFiles& folder, bool whole) {
  const fs::path place = place_of_folder(folder.folder);
  remove_leftovers(place);
  if (auto found = WholeFolder::at(place, folder); found && (whole || !found->exists())) {
    folders_.push_back(std::move(found));
    return;
  }
  for (auto file = folder.files.rbegin(); file != folder.files.rend(); ++file) {
    plan(folder.folder / file->first, file->second);
  }
  // What is there meanwhile cannot be taken for a whole: the first file goes first and comes last.
  if (folder.files.size() > 1 && !targets_.back().stream) going_.push_back(targets_.back().place);
  for (const std::string& name : folder.gone) going_.push_back(folder.folder / name);
}

void Writing::plan(const fs::path& path, const std::string& content) {
  Target target = target_of(path, content);
  const fs::path place = whole_path(target.place);
  for (const auto& folder : folders_) {
    if (target.stream || place.parent_path() != folder->place()) continue;
    folder->add(place.filename().string(), content);
    return;
  }
  for (const Target& other : targets_) {
    if (!target.stream && whole_path(other.place) == place) {
      throw InputError(path.string(), 0, "is to be written twice, expected different files");
    }
  }
  targets_.push_back(std::move(target));
}

/// The folders in which something is renamed.
std::set<fs::path> Writing::places() const {
  std::set<fs::path> places;
  for (const Target& target : targets_) {
    if (!target.stream) places.insert(target.place.parent_path());
  }
  for (const auto& folder : folders_) places.insert(folder->place().parent_path());
  return places;
}

Names Writing::names() const {
  Names names;
  for (const Target& target : targets_) {
    if (!target.stream) names.push_back(target.temporary.string());
  }
  for (const auto& folder : folders_) {
    for (std::string& name : folder->temporaries()) names.push_back(std::move(name));
  }
  return names;
}

void Writing::write() {
  for (const fs::path& place : places()) remove_leftovers(place);
  known_.emplace(names());
  for (const auto& folder : folders_) {
    const Staged staged = folder->stage();
    if (staged != Staged::yes) throw Again{staged == Staged::name_taken};
  }
  for (Target& target : targets_) {
    if (target.stream) continue;
    target.lock = make_temporary_file(target.temporary);
    if (!target.lock.valid() && errno == EEXIST) throw Again{};
    if (!target.lock.valid() || !write_all(target.lock.number(), *target.content, true)) {
      throw unwritten(target.named, errno);
    }
  }
}

void Writing::rename() {
  for (const Target& target : targets_) {  // may wait for a reader: Ctrl-C leaves nothing then
    if (target.stream) write_stream(target);
  }
  {
    const SignalsWait wait;
    for (const auto& folder : folders_) folder->rename();
    for (const fs::path& gone : going_) ::unlink(gone.c_str());
    for (Target& target : targets_) {
      if (target.stream) continue;
      if (::rename(target.temporary.c_str(), target.place.c_str()) != 0) {
        throw unwritten(target.named, errno);
      }
      target.renamed = true;
    }
  }
  for (const fs::path& place : places()) {
    if (!keep_folder(place)) throw unwritten(place, errno);
  }
  for (const auto& folder : folders_) folder->finish();
}

}  // namespace

void write_file(const fs::path& path, std::string_view content) {
  write_files({{path, std::string(content)}});
}

void write_files(const NamedContents& files, const std::vector<FolderOfFiles>& folders) {
  constexpr int kAttempts = 3;
  bool whole = true;
  for (int attempt = 1;; ++attempt) {
    try {
      Writing writing(files, folders, whole);
      writing.write();
      writing.rename();
      return;
    } catch (const Again& again) {
      whole = whole && again.whole;
      if (attempt < kAttempts) continue;
    }
    const fs::path& named = files.empty() ? folders.front().folder : files.front().first;
    throw unwritten(named, EEXIST);
  }
}

void discard_temporaries() noexcept {
  const Names* names = under_way.load();
  if (names == nullptr) return;
  for (const std::string& name : *names) {
    if (::unlink(name.c_str()) != 0) ::rmdir(name.c_str());
  }
}

}  // namespace trussmap
