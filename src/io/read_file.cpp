// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "files/present.hpp"
#include "io/read_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>
#include <system_error>

#include <lzma.h>

namespace trussmap {
using namespace io;

namespace {

namespace fs = std::filesystem;

std::atomic<std::size_t> most_bytes{ReadLimits().bytes};
std::atomic<int> most_nesting{ReadLimits().nesting};

// Tables of numbers shrink to a tenth or so: what grows so much more is no such table.
constexpr Growth kOfXz{64, 200};

constexpr const char* kRemedy = "; allow more with --max-input-mib";

std::string more_than_bytes(std::size_t most) {
  const bool whole = most % kMebibyte == 0;
  return "more than " + std::to_string(whole ? most / kMebibyte : most) +
         (whole ? " MiB" : " bytes") + kRemedy;
}

std::string decompressed(const std::string& bytes, const fs::path& path) {
  lzma_stream stream = LZMA_STREAM_INIT;
  const auto fail = [&](const std::string& what) -> InputError {
    lzma_end(&stream);
    return InputError(path.string(), 0, what);
  };
  constexpr std::uint64_t kMemory = 256;  // MiB; xz -9 needs 65 MiB
  const std::uint64_t memory = std::max<std::uint64_t>(kMemory, most_bytes / kMebibyte);
  const std::size_t most = most_grown(kOfXz, bytes.size());
  if (lzma_stream_decoder(&stream, memory * kMebibyte, LZMA_CONCATENATED) != LZMA_OK) {
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
    if (text.size() > most) throw fail("the xz data grow to " + more_than(kOfXz));
  }
  if (status == LZMA_MEMLIMIT_ERROR) {
    throw fail("the xz data need more than " + std::to_string(memory) +
               " MiB of memory to be read; allow more with --max-input-mib");
  }
  if (status != LZMA_STREAM_END) throw fail("the xz data are damaged or cut off");
  lzma_end(&stream);
  return text;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::io {

std::size_t most_grown(const Growth& growth, std::size_t size) {
  if (const std::size_t set = most_bytes; set > 0) return set;
  return std::max(growth.mebibytes * kMebibyte, growth.times * size);
}

std::size_t most_read(const fs::path& file) {
  constexpr std::size_t kMostOfStream = std::size_t{1024} * kMebibyte;
  if (const std::size_t set = most_bytes; set > 0) return set;
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? std::numeric_limits<std::size_t>::max()
                                            : kMostOfStream;
}

InputError too_long(const std::string& name, std::size_t most) {
  return {name, 0, "is " + more_than_bytes(most)};
}

std::string more_than(const Growth& growth) {
  if (const std::size_t set = most_bytes; set > 0) return more_than_bytes(set);
  return "more than " + std::to_string(growth.mebibytes) + " MiB and " +
         std::to_string(growth.times) + " times their size" + kRemedy;
}

}  // namespace trussmap::io

namespace trussmap {

void set_read_limits(const ReadLimits& limits) {
  constexpr int kDeepest = 10000;  // elements end one within the other, on the stack
  if (limits.nesting < 1 || limits.nesting > kDeepest) {
    throw std::invalid_argument("the depth of elements is " + std::to_string(limits.nesting) +
                                ", expected 1 to " + std::to_string(kDeepest));
  }
  most_bytes = limits.bytes;
  most_nesting = limits.nesting;
}

ReadLimits read_limits() {
  return {most_bytes, most_nesting};
}

std::string read_file(const fs::path& path) try {
  files::require_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw files::unreadable(path.string());
  const std::size_t most = most_read(path);
  std::string bytes;
  std::array<char, 1U << 16U> buffer{};
  while (stream) {  // a pipe does not tell its size
    stream.read(buffer.data(), buffer.size());
    bytes.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > most) throw too_long(path.string(), most);
  }
  if (stream.bad()) throw InputError(path.string(), 0, "cannot be read to its end");
  return path.extension() == ".xz" ? decompressed(bytes, path) : bytes;
} catch (const std::bad_alloc&) {
  throw InputError(path.string(), 0, "needs more memory than there is");
}

}  // namespace trussmap
