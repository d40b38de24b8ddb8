// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/io/atomic_file.hpp"

#include "trussmap/core/error.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include <lzma.h>

namespace trussmap {
namespace {

std::string decompressed(const std::string& packed, const std::string& path) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, std::numeric_limits<std::uint64_t>::max(), LZMA_CONCATENATED) !=
      LZMA_OK) {
    throw std::bad_alloc();
  }
  std::string text(packed.size() * 8 + 4096, '\0');
  std::size_t filled = 0;
  stream.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  lzma_ret status = LZMA_OK;
  while (status == LZMA_OK) {
    if (filled == text.size()) text.resize(2 * text.size());
    stream.next_out = reinterpret_cast<std::uint8_t*>(text.data() + filled);
    stream.avail_out = text.size() - filled;
    status = lzma_code(&stream, LZMA_FINISH);
    filled = text.size() - stream.avail_out;
  }
  lzma_end(&stream);
  if (status != LZMA_STREAM_END) throw InputError(path, 0, "is not a whole .xz file");
  text.resize(filled);
  return text;
}

}  // namespace

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) {
    throw InputError(path, 0, "cannot be read, a file was expected");
  }
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  return path.ends_with(".xz") ? decompressed(text, path) : text;
}

void write_file(const std::string& path, const std::string& content) {
  const std::string temporary = path + ".part";
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream << content << std::flush;
    if (!stream) throw InputError(path, 0, "cannot be written");
  }
  std::filesystem::rename(temporary, path);
}

}  // namespace trussmap
