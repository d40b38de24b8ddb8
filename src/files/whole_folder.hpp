// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A folder of files that becomes another at once.
//
//   stage     a temporary folder beside it takes the new files, and hard links of those that stay
//   rename    onto its place, where nothing or an empty folder is; else in exchange with what is
//             there (renameat2), and the old one is emptied under the temporary name
//
// Killed at any moment, the folder is as it was or as it is to be; a temporary may be left.
#pragma once

#include "files/temporary.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <sys/stat.h>
#include <vector>

namespace trussmap::files {

enum class Staged {
  yes,
  name_taken,  ///< somebody has the temporary name: another one will do
  refused      ///< the new folder cannot have the old one's group, or links to what is to stay
};

class WholeFolder {
 public:
  /// Nothing where the folder at `place` has to stay the one that it is: we stand in it, it has
  /// folders in it, links among the files to write, an access list, another owner, far too many
  /// files, or its parent lets us add nothing. Throws InputError where `place` is no folder.
  [[nodiscard]] static std::unique_ptr<WholeFolder> at(const std::filesystem::path& place,
                                                       const FolderOfFiles& what);
  ~WholeFolder();
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }
  /// A further file of it. Throws InputError where it has one of that name.
  void add(const std::string& name, const std::string& content);

  /// Whatever may stand at the temporary name: files, then the folder.
  [[nodiscard]] std::vector<std::string> temporaries() const;
  /// Whether there is a folder at its place.
  [[nodiscard]] bool exists() const { return old_.has_value(); }
  /// Writes all files to the disk. Throws InputError where that fails.
  [[nodiscard]] Staged stage();
  /// Puts it in its place. On a file system without exchange a folder that is not empty gets its
  /// files one by one: the first one of all goes first and comes last. Throws InputError.
  void rename();
  /// Removes what was there before.
  void finish();

 private:
  WholeFolder(std::filesystem::path place, const FolderOfFiles& what);

  struct File {
    std::string name;
    const std::string* content;
  };

  [[nodiscard]] bool is_ours(const std::string& name) const;
  void make_parents();
  [[nodiscard]] bool like_the_old() const;
  void write(const File& file) const;
  void rename_one_by_one() const;
  void clear_stage() const;

  std::filesystem::path place_;
  std::filesystem::path named_;
  std::vector<File> files_;
  std::vector<std::string> gone_;
  std::optional<struct stat> old_;              ///< of the folder that is there
  std::vector<std::string> staying_;            ///< files in it that are none of ours
  std::vector<std::filesystem::path> parents_;  ///< made for it, outermost first
  std::filesystem::path stage_;
  Descriptor descriptor_;
  bool staged_ = false;
  bool exchanged_ = false;
  bool done_ = false;
};

/// Where a folder really is: links followed, no slash at the end. Throws InputError for "".
[[nodiscard]] std::filesystem::path place_of_folder(const std::filesystem::path& folder);

}  // namespace trussmap::files
