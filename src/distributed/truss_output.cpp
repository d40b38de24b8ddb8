// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_output.hpp"

#include "files/temporary.hpp"
#include "geometry/index.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <unistd.h>

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

namespace fs = std::filesystem;

/// What a process adds to each of the three parts of the file.
using Parts = std::array<fmt::memory_buffer, 3>;

struct Place {
  double x;
  double y;
};

Parts formatted(const Communicator& all, Placing& placing, const std::vector<double>& x,
                const std::vector<double>& y, const fs::path& graph) {
  const TrussLines lines = parse_truss_lines(read_own_lines(all, graph), graph.string());
  std::vector<std::int64_t> ids;
  for (const LandmarkLine& one : lines.landmarks) ids.push_back(one.id);
  const std::vector<Entry> entries = placing.look_up(ids);
  std::vector<std::int64_t> numbers;
  std::vector<int> whom;
  for (const Entry& one : entries) {
    if (one.number < 0) continue;
    numbers.push_back(one.number);
    whom.push_back(placing.owner(one.number));
  }
  const bool same = !lines.fault && numbers.size() == ids.size() &&
                    all.sum(static_cast<std::int64_t>(ids.size())) == placing.count();
  all.agree(graph.string(),
            all.all(same) ? std::nullopt : std::optional<Fault>({0, "has changed meanwhile"}));
  const std::vector<Place> places = all.ask(numbers, whom, [&](const std::int64_t& number) {
    return Place{x[placing.local(number)], y[placing.local(number)]};
  });
  Parts parts;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    fmt::format_to(std::back_inserter(parts[0]), "VERTEX_XY {} {} {}\n", ids[k], places[k].x,
                   places[k].y);
  }
  for (const FixedLine& one : lines.fixed) {
    fmt::format_to(std::back_inserter(parts[1]), "FIX {}\n", one.id);
  }
  for (const RouteLine& one : lines.routes) {
    fmt::format_to(std::back_inserter(parts[2]), "EDGE_POINTXY {} {} {} {} {} {} {}\n", one.from,
                   one.to, one.dx, one.dy, one.xx, one.xy, one.yy);
  }
  return parts;
}

/// 0, or errno.
int write_at(int file, const fmt::memory_buffer& text, std::int64_t at) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::pwrite(file, text.data() + done, text.size() - done,
                               static_cast<off_t>(at) + static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

/// Throws in all processes where one of them has an errno.
void agree_on(const Communicator& all, const fs::path& path, int error) {
  all.agree(path.string(),
            error == 0 ? std::nullopt
                       : std::optional<Fault>(
                             {0, fmt::format("cannot be written: {}", std::strerror(error))}));
}

/// The file of a name, removed in the end unless it has been renamed.
class Temporary {
 public:
  Temporary(const Communicator& all, const fs::path& path) : first_(all.rank() == 0) {
    int error = 0;
    if (first_) {
      name_ = files::temporary_for(path);
      made_ = files::make_temporary_file(name_);
      if (!made_.valid()) error = errno;
    }
    const bool folder = fs::is_directory(path);
    agree_on(all, path, folder ? EISDIR : error);
    name_ = all.from(0, name_.string());
  }
  ~Temporary() {
    if (first_ && made_.valid() && !renamed_) ::unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  [[nodiscard]] const fs::path& name() const { return name_; }
  /// At the first process; 0, or errno.
  [[nodiscard]] int rename_to(const fs::path& path) {
    if (!first_) return 0;
    if (::rename(name_.c_str(), path.c_str()) != 0) return errno;
    renamed_ = true;
    return files::keep_folder(path.parent_path()) ? 0 : errno;
  }

 private:
  bool first_;
  fs::path name_;
  files::Descriptor made_;
  bool renamed_ = false;
};

}  // namespace

void write_truss(const Communicator& all, Placing& placing, const std::vector<double>& x,
                 const std::vector<double>& y, const fs::path& graph, const fs::path& path) {
  const Parts parts = formatted(all, placing, x, y, graph);
  Temporary temporary(all, path);
  files::Descriptor file(::open(temporary.name().c_str(), O_WRONLY | O_CLOEXEC));
  int error = file.valid() ? 0 : errno;
  std::int64_t begin = 0;
  for (const fmt::memory_buffer& part : parts) {
    const auto size = static_cast<std::int64_t>(part.size());
    const std::int64_t at = begin + all.sum_before(size);
    if (error == 0) error = write_at(file.number(), part, at);
    begin += all.sum(size);
  }
  if (error == 0 && ::fsync(file.number()) != 0) error = errno;
  agree_on(all, path, error);
  agree_on(all, path, temporary.rename_to(path));
}

}  // namespace trussmap::distributed
