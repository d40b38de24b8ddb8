// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

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

}  // namespace trussmap
