// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/whole_folder.hpp"

#include "trussmap/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <set>
#include <stdexcept>
#include <sys/xattr.h>
#include <unistd.h>

namespace trussmap::files {
namespace {

namespace fs = std::filesystem;

// Links are made for all that stays: a folder with more is somebody's store.
constexpr std::size_t kMostStaying = 1000;
constexpr mode_t kRights = 07777;

InputError cannot_be(const char* what, const fs::path& path, int reason) {
  return {path.string(), 0, std::string("cannot be ") + what + ": " + std::strerror(reason)};
}

bool stands_in(const fs::path& place) {
  std::error_code failed;
  const fs::path here = fs::current_path(failed);
  if (failed) return false;
  const auto [end, rest] = std::mismatch(place.begin(), place.end(), here.begin(), here.end());
  return end == place.end();
}

bool has_access_list(const fs::path& place) {
  return ::getxattr(place.c_str(), "system.posix_acl_access", nullptr, 0) > 0 ||
         ::getxattr(place.c_str(), "system.posix_acl_default", nullptr, 0) > 0;
}

bool may_change(const fs::path& folder) {
  return ::access(folder.c_str(), W_OK | X_OK) == 0;
}

bool same_file(const fs::path& a, const fs::path& b) {
  struct stat first {};
  struct stat second {};
  return ::lstat(a.c_str(), &first) == 0 && ::lstat(b.c_str(), &second) == 0 &&
         first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

}  // namespace

fs::path place_of_folder(const fs::path& folder) {
  std::error_code failed;
  const fs::path whole = folder.empty() ? folder : fs::absolute(folder, failed);
  fs::path place = failed ? fs::path() : fs::weakly_canonical(whole, failed);
  if (folder.empty() || failed) throw cannot_be("made", folder, failed ? failed.value() : ENOENT);
  return place.has_filename() ? place : place.parent_path();
}

WholeFolder::WholeFolder(fs::path place, const FolderOfFiles& what)
    : place_(std::move(place)),
      named_(what.folder),
      gone_(what.gone),
      stage_(temporary_for(place_)) {
  for (const auto& [name, content] : what.files) add(name, content);
}

WholeFolder::~WholeFolder() {
  if (staged_ && !exchanged_) clear_stage();
  if (done_) return;
  for (auto parent = parents_.rbegin(); parent != parents_.rend(); ++parent) {
    ::rmdir(parent->c_str());
  }
}

void WholeFolder::add(const std::string& name, const std::string& content) {
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos) {
    throw std::invalid_argument("\"" + name + "\" is no file's name");
  }
  const bool twin = std::any_of(files_.begin(), files_.end(),
                                [&name](const File& file) { return file.name == name; });
  if (twin) {
    throw InputError((named_ / name).string(), 0,
                     "is to be written twice, expected different files");
  }
  files_.push_back({name, &content});
  std::erase(staying_, name);
}

bool WholeFolder::is_ours(const std::string& name) const {
  return std::find(gone_.begin(), gone_.end(), name) != gone_.end() ||
         std::any_of(files_.begin(), files_.end(),
                     [&name](const File& file) { return file.name == name; });
}

std::unique_ptr<WholeFolder> WholeFolder::at(const fs::path& place, const FolderOfFiles& what) {
  std::unique_ptr<WholeFolder> folder(new WholeFolder(place, what));
  struct stat old {};
  if (::stat(place.c_str(), &old) != 0) return folder;
  if (!S_ISDIR(old.st_mode)) {
    throw InputError(what.folder.string(), 0, "is a file, expected a folder");
  }
  folder->old_ = old;
  struct stat around {};
  const fs::path parent = place.parent_path();
  if (old.st_uid != ::geteuid() || stands_in(place) || has_access_list(place) ||
      !may_change(place) || !may_change(parent) || ::stat(parent.c_str(), &around) != 0 ||
      around.st_dev != old.st_dev) {
    return nullptr;
  }
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(place, failed)) {
    const std::string name = entry.path().filename().string();
    const bool ours = folder->is_ours(name);
    const bool file = !entry.is_symlink(failed) && entry.is_regular_file(failed);
    const bool stays = !ours && (file || entry.is_symlink(failed)) && !is_temporary_name(name);
    if (stays) folder->staying_.push_back(name);
    if (!(ours && file) && !stays) return nullptr;
    if (folder->staying_.size() > kMostStaying) return nullptr;
  }
  return failed ? nullptr : std::move(folder);
}

std::vector<std::string> WholeFolder::temporaries() const {
  std::vector<std::string> names;
  for (const File& file : files_) names.push_back((stage_ / file.name).string());
  for (const std::string& name : gone_) names.push_back((stage_ / name).string());
  for (const std::string& name : staying_) names.push_back((stage_ / name).string());
  names.push_back(stage_.string());
  return names;
}

void WholeFolder::make_parents() {
  std::error_code unseen;
  for (fs::path parent = place_.parent_path();
       !fs::exists(parent, unseen) && parent != parent.root_path(); parent = parent.parent_path()) {
    parents_.insert(parents_.begin(), parent);
  }
  for (const fs::path& parent : parents_) {
    std::error_code failed;
    fs::create_directory(parent, failed);
    if (failed) throw InputError(named_.string(), 0, "cannot be made: " + failed.message());
  }
}

bool WholeFolder::like_the_old() const {
  if (!old_) return true;
  struct stat fresh {};
  if (::fstat(descriptor_.number(), &fresh) != 0) return false;
  if (fresh.st_gid != old_->st_gid &&
      ::fchown(descriptor_.number(), static_cast<uid_t>(-1), old_->st_gid) != 0) {
    return false;
  }
  return ::fchmod(descriptor_.number(), old_->st_mode & kRights) == 0;
}

void WholeFolder::write(const File& file) const {
  constexpr mode_t kAnyone = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH;
  Descriptor opened(::openat(descriptor_.number(), file.name.c_str(),
                             O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kAnyone));
  if (!opened.valid() || !write_all(opened.number(), *file.content, true) || !opened.close()) {
    throw cannot_be("written", named_ / file.name, errno);
  }
}

Staged WholeFolder::stage() {
  make_parents();
  descriptor_ = make_temporary_folder(stage_);
  if (!descriptor_.valid() && errno == EEXIST) return Staged::name_taken;
  if (!descriptor_.valid()) throw cannot_be("made", named_, errno);
  staged_ = true;
  if (!like_the_old()) return Staged::refused;
  for (const std::string& name : staying_) {
    const std::string from = (place_ / name).string();
    if (::linkat(AT_FDCWD, from.c_str(), descriptor_.number(), name.c_str(), 0) != 0) {
      return Staged::refused;
    }
  }
  for (const File& file : files_) write(file);
  if (::fsync(descriptor_.number()) != 0 && errno != EINVAL && errno != ENOTSUP) {
    throw cannot_be("written", named_, errno);
  }
  return Staged::yes;
}

void WholeFolder::rename() {
  const bool vacant =
      staying_.empty() && ::renameat(AT_FDCWD, stage_.c_str(), AT_FDCWD, place_.c_str()) == 0;
  if (vacant) {
    staged_ = false;
  } else if (::renameat2(AT_FDCWD, stage_.c_str(), AT_FDCWD, place_.c_str(), RENAME_EXCHANGE) ==
             0) {
    exchanged_ = true;
  } else if (const int reason = errno; fs::is_directory(place_)) {
    rename_one_by_one();
  } else {
    throw cannot_be("made", named_, reason);
  }
  done_ = true;
}

void WholeFolder::rename_one_by_one() const {
  const auto put = [this](const File& file) {
    if (::renameat(descriptor_.number(), file.name.c_str(), AT_FDCWD,
                   (place_ / file.name).c_str()) != 0) {
      throw cannot_be("written", named_ / file.name, errno);
    }
  };
  if (!files_.empty()) ::unlink((place_ / files_.front().name).c_str());
  for (const std::string& name : gone_) ::unlink((place_ / name).c_str());
  for (std::size_t k = files_.size(); k-- > 0;) put(files_[k]);
}

void WholeFolder::clear_stage() const {
  for (const std::string& name : temporaries()) {
    if (name != stage_.string()) ::unlink(name.c_str());
  }
  ::rmdir(stage_.c_str());
}

// What came into the old folder after we had looked belongs to somebody, and goes on to the new.
void WholeFolder::finish() {
  if (!exchanged_) return;
  std::error_code ignored;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(stage_, ignored)) {
    names.push_back(entry.path().filename().string());
  }
  for (const std::string& name : names) {
    if (is_ours(name) || same_file(stage_ / name, place_ / name)) {
      ::unlink((stage_ / name).c_str());
    } else {
      ::renameat(AT_FDCWD, (stage_ / name).c_str(), AT_FDCWD, (place_ / name).c_str());
    }
  }
  ::rmdir(stage_.c_str());
}

}  // namespace trussmap::files
