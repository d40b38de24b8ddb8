// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/decompress.hpp"

#include "files/present.hpp"
#include "files/temporary.hpp"
#include "io/read_limits.hpp"
#include "logs/byte_reader.hpp"
#include "logs/message_log.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <bzlib.h>
#include <cerrno>
#include <fstream>
#include <lz4frame.h>
#include <system_error>
#include <vector>
#include <zlib.h>
#include <zstd.h>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFirst = std::uint64_t{4} << 20U;  // bytes made without a proof
constexpr std::uint64_t kUsualGrowth = 16;                 // times the compressed size
constexpr std::string_view kZstdMagic("\x28\xB5\x2F\xFD", 4);

// Recordings of cameras in the dark shrink to a hundredth.
constexpr io::Growth kOfBag{1024, 200};

/// What one call of a library made of how much.
struct Progress {
  std::size_t read = 0;
  std::size_t written = 0;
  bool at_end = false;  // of a frame
};

/// As much as these libraries count.
unsigned at_most_a_gibibyte(std::size_t bytes) {
  return static_cast<unsigned>(std::min<std::size_t>(bytes, std::size_t{1} << 30U));
}

/// Streams of bzip2, one after the other.
class Bzip2Stream {
 public:
  Bzip2Stream() = default;
  ~Bzip2Stream() { end(); }
  Bzip2Stream(const Bzip2Stream&) = delete;
  Bzip2Stream& operator=(const Bzip2Stream&) = delete;

  Progress step(std::string_view from, char* to, std::size_t room) {
    if (!open_ && BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
    open_ = true;
    const unsigned given = at_most_a_gibibyte(from.size());
    const unsigned space = at_most_a_gibibyte(room);
    stream_.next_in = const_cast<char*>(from.data());  // read alone
    stream_.avail_in = given;
    stream_.next_out = to;
    stream_.avail_out = space;
    const int status = BZ2_bzDecompress(&stream_);
    if (status == BZ_MEM_ERROR) throw std::bad_alloc();
    if (status != BZ_OK && status != BZ_STREAM_END) {
      throw DecompressError("its bzip2 data are damaged");
    }
    const Progress made{given - stream_.avail_in, space - stream_.avail_out,
                        status == BZ_STREAM_END};
    if (made.at_end) end();
    return made;
  }

 private:
  void end() {
    if (open_) BZ2_bzDecompressEnd(&stream_);
    open_ = false;
  }

  bz_stream stream_{};
  bool open_ = false;
};

/// One stream of zlib; what follows it is damage.
class ZlibStream {
 public:
  ZlibStream() {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~ZlibStream() { inflateEnd(&stream_); }
  ZlibStream(const ZlibStream&) = delete;
  ZlibStream& operator=(const ZlibStream&) = delete;

  Progress step(std::string_view from, char* to, std::size_t room) {
    if (at_end_) throw DecompressError("has bytes behind its zlib data");
    const unsigned given = at_most_a_gibibyte(from.size());
    const unsigned space = at_most_a_gibibyte(room);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));  // read alone
    stream_.avail_in = given;
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = space;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
      throw DecompressError("its zlib data are damaged");
    }
    at_end_ = status == Z_STREAM_END;
    return {given - stream_.avail_in, space - stream_.avail_out, at_end_};
  }

 private:
  z_stream stream_{};
  bool at_end_ = false;
};

}  // namespace

struct Decompressor::Contexts {
  LZ4F_dctx* lz4 = nullptr;
  ZSTD_DCtx* zstd = nullptr;

  Contexts() = default;
  ~Contexts() {
    LZ4F_freeDecompressionContext(lz4);
    ZSTD_freeDCtx(zstd);
  }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
};

Decompressor::Decompressor() : contexts_(std::make_unique<Contexts>()) {}
Decompressor::~Decompressor() = default;

template <typename Step>
std::string_view Decompressor::grown(std::string_view bytes, std::uint64_t most, const Step& step) {
  const std::uint64_t first =
      std::min(most, std::max<std::uint64_t>(kFirst, kUsualGrowth * bytes.size()));
  if (buffer_.size() < first) buffer_.resize(static_cast<std::size_t>(first));
  std::size_t written = 0;
  bool at_end = true;
  char beyond = 0;  // takes what must not be there
  while (!bytes.empty() || !at_end) {
    const std::size_t room =
        static_cast<std::size_t>(std::min<std::uint64_t>(most, buffer_.size()) - written);
    const Progress made = room > 0 ? step(bytes, buffer_.data() + written, room)
                                   : step(bytes, &beyond, std::size_t{1});
    bytes.remove_prefix(made.read);
    at_end = made.at_end;
    if (room == 0 && made.written > 0) {
      throw DecompressError("its data have more than " + std::to_string(most) +
                            " bytes once decompressed");
    }
    written += made.written;
    if (made.read == 0 && made.written == 0 && !at_end) {
      throw DecompressError("its compressed data end too soon");
    }
    if (written == buffer_.size() && written < most) {
      buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, 2 * written)));
    }
  }
  return std::string_view(buffer_).substr(0, written);
}

std::string_view Decompressor::exactly(std::string_view made, std::uint64_t size) {
  if (made.size() == size) return made;
  throw DecompressError("its data have " + std::to_string(made.size()) +
                        " bytes once decompressed, expected " + std::to_string(size));
}

std::string_view Decompressor::lz4(std::string_view bytes, std::uint64_t size) {
  if (contexts_->lz4 == nullptr &&
      LZ4F_isError(LZ4F_createDecompressionContext(&contexts_->lz4, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  LZ4F_resetDecompressionContext(contexts_->lz4);
  const std::string_view made =
      grown(bytes, size, [this](std::string_view from, char* to, std::size_t room) {
        Progress progress{from.size(), room, false};
        const std::size_t left = LZ4F_decompress(contexts_->lz4, to, &progress.written, from.data(),
                                                 &progress.read, nullptr);
        if (LZ4F_isError(left) != 0) {
          throw DecompressError(std::string("its lz4 data are damaged (") +
                                LZ4F_getErrorName(left) + ")");
        }
        progress.at_end = left == 0;
        return progress;
      });
  return exactly(made, size);
}

std::string_view Decompressor::zstd_of_any_size(std::string_view bytes, std::uint64_t most) {
  if (contexts_->zstd == nullptr) contexts_->zstd = ZSTD_createDCtx();
  if (contexts_->zstd == nullptr) throw std::bad_alloc();
  ZSTD_DCtx_reset(contexts_->zstd, ZSTD_reset_session_only);
  return grown(bytes, most, [this](std::string_view from, char* to, std::size_t room) {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{to, room, 0};
    const std::size_t left = ZSTD_decompressStream(contexts_->zstd, &out, &in);
    if (ZSTD_isError(left) != 0) {
      throw DecompressError(std::string("its zstd data are damaged (") + ZSTD_getErrorName(left) +
                            ")");
    }
    return Progress{in.pos, out.pos, left == 0};
  });
}

std::string_view Decompressor::zstd(std::string_view bytes, std::uint64_t size) {
  return exactly(zstd_of_any_size(bytes, size), size);
}

std::string_view Decompressor::bzip2(std::string_view bytes, std::uint64_t size) {
  Bzip2Stream stream;
  return exactly(grown(bytes, size,
                       [&stream](std::string_view from, char* to, std::size_t room) {
                         return stream.step(from, to, room);
                       }),
                 size);
}

std::string_view Decompressor::zlib_of_any_size(std::string_view bytes, std::uint64_t most) {
  ZlibStream stream;
  return grown(bytes, most, [&stream](std::string_view from, char* to, std::size_t room) {
    return stream.step(from, to, room);
  });
}

bool is_zstd(std::string_view bytes) {
  return bytes.starts_with(kZstdMagic);
}

struct DecompressedFile::Held {
  files::Descriptor descriptor;  // locked: no leftover of a killed run
};

namespace {

/// Writes what `file` decompresses to; whether it is whole.
bool decompress_to(const fs::path& file, int descriptor) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw files::unreadable(file.string());
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                        &ZSTD_freeDCtx);
  if (context == nullptr) throw std::bad_alloc();
  std::error_code ignored;
  const std::uintmax_t size = fs::file_size(file, ignored);
  const std::size_t most = io::most_grown(kOfBag, ignored ? 0 : static_cast<std::size_t>(size));
  std::string from(ZSTD_DStreamInSize(), '\0');
  std::string to(ZSTD_DStreamOutSize(), '\0');
  std::uint64_t before = 0;
  std::uint64_t written = 0;
  bool at_end = false;
  while (in.read(from.data(), static_cast<std::streamsize>(from.size())), in.gcount() > 0) {
    ZSTD_inBuffer piece{from.data(), static_cast<std::size_t>(in.gcount()), 0};
    bool full = false;
    while (piece.pos < piece.size || full) {
      ZSTD_outBuffer made{to.data(), to.size(), 0};
      const std::size_t left = ZSTD_decompressStream(context.get(), &made, &piece);
      if (ZSTD_isError(left) != 0) {
        fail_at(file.string(), before + piece.pos,
                std::string("the zstd data are damaged (") + ZSTD_getErrorName(left) + ")");
      }
      at_end = left == 0;
      full = made.pos == made.size && !at_end;
      written += made.pos;
      if (written > most) {
        throw InputError(file.string(), 0, "the zstd data grow to " + io::more_than(kOfBag));
      }
      if (!files::write_all(descriptor, std::string_view(to).substr(0, made.pos), false)) {
        throw InputError(file.string(), 0,
                         "cannot be decompressed into the folder of temporary files (" +
                             std::system_category().message(errno) + ")");
      }
    }
    before += piece.size;
  }
  if (in.bad()) throw InputError(file.string(), 0, "cannot be read to its end");
  return at_end;
}

}  // namespace

DecompressedFile::DecompressedFile(const fs::path& file) : held_(std::make_unique<Held>()) {
  const fs::path folder = fs::temp_directory_path();
  files::remove_leftovers(folder);
  constexpr int kTries = 10;
  for (int k = 0; k < kTries && !held_->descriptor.valid(); ++k) {
    path_ = files::temporary_for(folder / file.stem());
    held_->descriptor = files::make_temporary_file(path_);
  }
  if (!held_->descriptor.valid()) {
    throw InputError(file.string(), 0,
                     "cannot be decompressed, no temporary file can be made in " + folder.string());
  }
  try {
    if (!decompress_to(file, held_->descriptor.number())) {
      cut_off_ = "the zstd data end too soon";
    }
  } catch (...) {
    remove();
    throw;
  }
}

DecompressedFile::~DecompressedFile() {
  remove();
}

void DecompressedFile::remove() noexcept {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
}

}  // namespace trussmap::logs
