// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Temporaries: files and folders that stand beside what they are to become, until a rename.
//
//   .NAME.k3w7qzm5ahc2.trussmap-part
//
// NAME is what they are to become, cut where it is long; the rest is drawn anew each time, so that
// nobody can lay something in the way. A run holds an advisory lock (flock) on each of its own: one
// that can be locked is left from a run that was killed, and anyone may remove it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <sys/types.h>

namespace trussmap::files {

/// An open file or folder, closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { static_cast<void>(close()); }
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool valid() const { return number_ >= 0; }
  /// False, with errno, where the system could not keep what was written.
  [[nodiscard]] bool close();

 private:
  int number_;
};

/// A temporary's path for `target`, another one at every call.
[[nodiscard]] std::filesystem::path temporary_for(const std::filesystem::path& target);

[[nodiscard]] bool is_temporary_name(std::string_view name);

/// Makes it, locked, for writing; throws nothing: not valid, with errno, where that fails. EEXIST
/// says that the name is taken, or that the new file was lost to somebody: another name will do.
[[nodiscard]] Descriptor make_temporary_file(const std::filesystem::path& temporary);
[[nodiscard]] Descriptor make_temporary_folder(const std::filesystem::path& temporary);

/// Writes all of it, to the disk where `lasting`. False, with errno, where that fails.
[[nodiscard]] bool write_all(int descriptor, std::string_view content, bool lasting);

/// Renames within the folder last from here on. Done, too, where the file system knows no such
/// thing. False, with errno, where the disk fails.
[[nodiscard]] bool keep_folder(const std::filesystem::path& folder);

/// Removes the temporaries of killed runs of this user from a folder: regular files, and folders
/// with the files in them (never with folders in them). What cannot be removed stays.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace trussmap::files
