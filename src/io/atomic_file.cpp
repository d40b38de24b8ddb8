// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>
#include <unistd.h>

#include <lzma.h>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

std::string decompressed(const std::string& bytes, const fs::path& path) {
  lzma_stream stream = LZMA_STREAM_INIT;
  const auto fail = [&](const char* what) -> InputError {
    lzma_end(&stream);
    return InputError(path.string(), 0, what);
  };
  constexpr std::uint64_t kMemory = std::uint64_t{256} << 20U;  // bytes; xz -9 needs 65 MiB
  // Tables of numbers shrink to a tenth or so: what grows so much more is no such table.
  constexpr std::size_t kGrowth = 200;
  constexpr std::size_t kGrownBytes = std::size_t{64} << 20U;
  const std::size_t most = std::max(kGrownBytes, kGrowth * bytes.size());
  if (lzma_stream_decoder(&stream, kMemory, LZMA_CONCATENATED) != LZMA_OK) {
    throw fail("cannot be decompressed, expected an xz file");
  }
  stream.next_in = reinterpret_cast<const std::uint8_t*>(bytes.data());
  stream.avail_in = bytes.size();
  std::string text;
  std::array<std::uint8_t, 1U << 16U> buffer{};
  lzma_ret status = LZMA_OK;
  while (status == LZMA_OK) {
    stream.next_out = buffer.data();
    stream.avail_out = buffer.size();
    status = lzma_code(&stream, LZMA_FINISH);
    text.append(reinterpret_cast<const char*>(buffer.data()), buffer.size() - stream.avail_out);
    if (text.size() > most) {
      throw fail("the xz data grow to more than 64 MiB and 200 times their size");
    }
  }
  if (status == LZMA_MEMLIMIT_ERROR) throw fail("the xz data need more than 256 MiB to be read");
  if (status != LZMA_STREAM_END) throw fail("the xz data are damaged or cut off");
  lzma_end(&stream);
  return text;
}

fs::path temporary_for(const fs::path& path) {
  fs::path temporary = path;
  temporary += ".part" + std::to_string(::getpid());
  return temporary;
}

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

/// Where a file really goes.
struct Target {
  fs::path place;       // links followed
  bool stream = false;  // a terminal, pipe or device: written to as it is, never replaced
};

Target target_of(const fs::path& path, const std::vector<Target>& others) {
  std::error_code ignored;
  Target target{path, false};
  if (fs::is_symlink(path, ignored)) {
    const fs::path followed = fs::weakly_canonical(path, ignored);
    if (!ignored) target.place = followed;
  }
  if (fs::is_directory(target.place, ignored)) {
    throw InputError(path.string(), 0, "is a folder, expected a file to write");
  }
  target.stream = fs::exists(target.place, ignored) && !fs::is_regular_file(target.place, ignored);
  for (const Target& other : others) {
    if (!target.stream &&
        fs::weakly_canonical(other.place, ignored) == fs::weakly_canonical(target.place, ignored)) {
      throw InputError(path.string(), 0, "is to be written twice, expected different files");
    }
  }
  return target;
}

void write_whole(const fs::path& place, const fs::path& named, std::string_view content,
                 bool temporary) {
  std::ofstream stream(place, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (stream) return;
  const int reason = errno;
  std::error_code ignored;
  if (temporary) fs::remove(place, ignored);
  throw InputError(named.string(), 0, std::string("cannot be written: ") + std::strerror(reason));
}

}  // namespace

std::string read_file(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw InputError(path.string(), 0, "is a folder, expected a file");
  }
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) throw InputError(path.string(), 0, "cannot be opened, expected a readable file");
  std::string bytes(static_cast<std::size_t>(stream.tellg()), '\0');
  stream.seekg(0);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(path.string(), 0, "cannot be read to its end");
  return path.extension() == ".xz" ? decompressed(bytes, path) : bytes;
}

void write_file(const fs::path& path, std::string_view content) {
  write_files({{path, std::string(content)}});
}

void write_files(const std::vector<std::pair<fs::path, std::string>>& files) {
  std::vector<Target> targets;
  targets.reserve(files.size());
  for (const auto& [path, content] : files) targets.push_back(target_of(path, targets));
  Names names;
  for (const Target& target : targets) {
    if (!target.stream) names.push_back(temporary_for(target.place).string());
  }
  const UnderWay known(std::move(names));
  std::vector<fs::path> temporaries;
  const auto clean_up = [&temporaries] {
    std::error_code ignored;
    for (const fs::path& temporary : temporaries) fs::remove(temporary, ignored);
  };
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (targets[k].stream) continue;
    try {
      write_whole(temporary_for(targets[k].place), files[k].first, files[k].second, true);
    } catch (...) {
      clean_up();
      throw;
    }
    temporaries.push_back(temporary_for(targets[k].place));
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (targets[k].stream) {
      write_whole(targets[k].place, files[k].first, files[k].second, false);
      continue;
    }
    std::error_code failed;
    fs::rename(temporary_for(targets[k].place), targets[k].place, failed);
    if (failed) {
      clean_up();
      throw InputError(files[k].first.string(), 0, "cannot be written: " + failed.message());
    }
  }
}

void discard_temporaries() noexcept {
  const Names* names = under_way.load();
  if (names == nullptr) return;
  for (const std::string& name : *names) ::unlink(name.c_str());
}

}  // namespace trussmap
