// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Whole files in and out: read at once, written whole or not at all. Who only writes needs
// trussmap::map, who reads trussmap::trussmap.
//
// What is written goes to temporaries first, on the disk (fsync) before the first of them is
// renamed: .NAME.XXXXXXXXXXXX.trussmap-part beside its place, with letters that nobody can foresee.
// A run that is killed leaves them; the next one that writes into the same folder removes them, and
// knows by a lock (flock) which belong to a run that lives. Files get the rights that new files
// have, whatever those of the files that they replace.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

/// How large a file may be, and what one may become that is compressed, or that declares defaults
/// for its elements: a small one could fill the memory.
struct ReadLimits {
  /// Bytes, of a file as it is and of what it becomes. 0: any file as it is; a compressed one 64
  /// MiB or, if that is more, 200 times its size; a map's defaults 16 MiB or 10 times its size.
  std::size_t bytes = 0;
  int nesting = 100;  ///< depth of the elements of a map
};

/// For all files that are read from now on, in any thread. Throws std::invalid_argument unless
/// `nesting` is from 1 to 10000.
void set_read_limits(const ReadLimits& limits);
[[nodiscard]] ReadLimits read_limits();

/// The file's bytes; decompressed if the name ends in .xz, in 256 MiB of memory or the limit's
/// bytes. Throws InputError if it cannot be read, is no xz file, or exceeds the limits.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Files, by path and content.
using NamedContents = std::vector<std::pair<std::filesystem::path, std::string>>;

/// A folder whose files belong together.
struct FolderOfFiles {
  std::filesystem::path folder;  ///< made where it is missing, with its parents
  /// By name and content. The first is the one without which the folder is none of its kind.
  std::vector<std::pair<std::string, std::string>> files;
  std::vector<std::string> gone;  ///< further files that belonged to it, to be removed
};

/// Writes to a temporary file beside `path`, then renames it. Throws InputError if that fails;
/// `path` is then as it was.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Several files and folders at once: all temporaries are written before the first is renamed, so
/// that a full disk or a missing right leaves all of them as they were. Parents of files are not
/// made. A link is followed; a pipe or device (/dev/stdout) is written to as it is, before the
/// renames. Throws InputError, too, where a path is a folder or is named twice, and where a disk
/// fails so late that the renames are done but may not last; std::invalid_argument where a name in
/// a folder is none.
///
/// Whenever the run ends (SIGKILL, power), each file is old or new, and so is each folder as a
/// whole: a new folder takes the old one's place in one rename, with links to the files in it that
/// are nobody's concern here. Programs that stand in the old folder have to enter it anew. Two
/// things cannot be had:
/// - Different files, and different folders, are renamed one after the other.
/// - A folder stays the one that it is, and gets its files one after the other, where its parent
///   takes no new folder, where it is a mount point, another user's, the current folder or a
///   parent of it, where it has folders in it, links among the files to write, an access list or
///   more than a thousand files, and where the file system knows neither hard links nor an
///   exchange of names. Its first file then goes first and comes last: what is there meanwhile
///   lacks it.
void write_files(const NamedContents& files, const std::vector<FolderOfFiles>& folders = {});

/// Deletes the temporaries of a write_files() that is under way in any thread: for the handler
/// of a signal that ends the program, and safe there.
void discard_temporaries() noexcept;

}  // namespace trussmap
