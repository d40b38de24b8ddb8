// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/placing.hpp"

#include "distributed/hilbert.hpp"
#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

/// A landmark on its way to its process.
struct Placed {
  std::uint64_t place;
  PlacedLandmark landmark;
};

bool before(const Placed& a, const Placed& b) {
  return std::tie(a.place, a.landmark.line) < std::tie(b.place, b.landmark.line);
}

/// The process that knows an id: ids that follow each other are with different ones.
int who_knows(std::int64_t id, int processes) {
  return static_cast<int>(static_cast<std::uint64_t>(id) % static_cast<std::uint64_t>(processes));
}

std::vector<Placed> on_curve(const Communicator& all, const std::vector<LandmarkLine>& lines) {
  constexpr double kFar = std::numeric_limits<double>::max();
  double low_x = kFar;
  double low_y = kFar;
  double high_x = -kFar;
  double high_y = -kFar;
  for (const LandmarkLine& one : lines) {
    low_x = std::min(low_x, one.x);
    low_y = std::min(low_y, one.y);
    high_x = std::max(high_x, one.x);
    high_y = std::max(high_y, one.y);
  }
  low_x = all.least(low_x);
  low_y = all.least(low_y);
  const double width = std::max(-all.least(-high_x) - low_x, -all.least(-high_y) - low_y);
  constexpr std::uint32_t kLast = (std::uint32_t{1} << kHilbertBits) - 1;
  const auto cell = [&](double value, double low) {
    const double share = width > 0.0 && std::isfinite(width) ? (value - low) / width : 0.0;
    return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * kLast);
  };
  std::vector<Placed> placed;
  placed.reserve(lines.size());
  for (const LandmarkLine& one : lines) {
    placed.push_back({hilbert_place(cell(one.x, low_x), cell(one.y, low_y)),
                      {one.id, one.x, one.y, one.line, 0}});
  }
  std::sort(placed.begin(), placed.end(), before);
  return placed;
}

/// Where on the curve each process but the first begins, so that shares are equal: bisection for
/// all of them at once. Landmarks in one place stay together.
std::vector<std::uint64_t> borders(const Communicator& all, const std::vector<Placed>& placed) {
  const std::int64_t count = all.sum(static_cast<std::int64_t>(placed.size()));
  const auto parts = idx(all.count() - 1);
  std::vector<std::uint64_t> low(parts, 0);
  std::vector<std::uint64_t> high(parts, std::uint64_t{1} << (2 * kHilbertBits));
  for (int bit = 0; bit <= 2 * kHilbertBits && parts > 0; ++bit) {
    std::vector<std::int64_t> below(parts);
    for (std::size_t k = 0; k < parts; ++k) {
      const Placed middle{low[k] + (high[k] - low[k]) / 2, {.line = -1}};
      below[k] = std::lower_bound(placed.begin(), placed.end(), middle, before) - placed.begin();
    }
    below = all.sums(below);
    for (std::size_t k = 0; k < parts; ++k) {
      const std::uint64_t middle = low[k] + (high[k] - low[k]) / 2;
      const auto share = static_cast<std::int64_t>(k + 1);
      const std::int64_t wanted =
          count / all.count() * share + count % all.count() * share / all.count();
      if (low[k] == high[k]) continue;
      if (below[k] < wanted) {
        low[k] = middle + 1;
      } else {
        high[k] = middle;
      }
    }
  }
  return low;
}

}  // namespace

Placing::Placing(const Communicator& all, const TrussLines& lines, const std::string& file)
    : all_(all) {
  share(lines);
  number();
  make_directory(file);
  fix(lines, file);
}

void Placing::share(const TrussLines& lines) {
  std::vector<Placed> placed = on_curve(all_, lines.landmarks);
  const std::vector<std::uint64_t> begins = borders(all_, placed);
  std::vector<std::vector<Placed>> letters(idx(all_.count()));
  for (const Placed& one : placed) {
    const auto to = std::upper_bound(begins.begin(), begins.end(), one.place) - begins.begin();
    letters[idx(to)].push_back(one);
  }
  placed = all_.exchange(std::exchange(letters, {}));
  std::sort(placed.begin(), placed.end(), before);
  own_.reserve(placed.size());
  for (const Placed& one : placed) own_.push_back(one.landmark);
}

void Placing::number() {
  starts_ = {0};
  for (const std::int64_t count : all_.all_of(static_cast<std::int64_t>(own_.size()))) {
    starts_.push_back(starts_.back() + count);
  }
  first_ = starts_[idx(all_.rank())];
}

int Placing::owner(std::int64_t number) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), number);
  return static_cast<int>(after - starts_.begin()) - 1;
}

void Placing::make_directory(const std::string& file) {
  std::vector<std::vector<Known>> letters(idx(all_.count()));
  for (std::size_t k = 0; k < own_.size(); ++k) {
    const PlacedLandmark& one = own_[k];
    const Entry entry{first_ + static_cast<std::int64_t>(k), one.x, one.y, 0};
    letters[idx(who_knows(one.id, all_.count()))].push_back({one.id, entry, one.line});
  }
  directory_ = all_.exchange(std::exchange(letters, {}));
  std::sort(directory_.begin(), directory_.end(), [](const Known& a, const Known& b) {
    return std::tie(a.id, a.line) < std::tie(b.id, b.line);
  });
  std::optional<Fault> fault;
  for (std::size_t k = 1; k < directory_.size(); ++k) {
    const Known& one = directory_[k];
    if (one.id != directory_[k - 1].id || (fault && fault->line <= idx(one.line))) continue;
    fault = Fault{idx(one.line),
                  fmt::format("vertex {} is defined a second time, expected it once", one.id)};
  }
  all_.agree(file, fault);
}

std::vector<Entry> Placing::look_up(const std::vector<std::int64_t>& ids) {
  std::vector<int> whom;
  whom.reserve(ids.size());
  for (const std::int64_t id : ids) whom.push_back(who_knows(id, all_.count()));
  return all_.ask(ids, whom, [this](const std::int64_t& id) {
    const auto known = find(id);
    return known != directory_.end() ? known->entry : Entry{};
  });
}

std::vector<Placing::Known>::iterator Placing::find(std::int64_t id) {
  const auto known =
      std::lower_bound(directory_.begin(), directory_.end(), id,
                       [](const Known& one, std::int64_t sought) { return one.id < sought; });
  return known != directory_.end() && known->id == id ? known : directory_.end();
}

void Placing::fix(const TrussLines& lines, const std::string& file) {
  std::vector<std::int64_t> ids;
  for (const FixedLine& one : lines.fixed) ids.push_back(one.id);
  const std::vector<Entry> entries = look_up(ids);
  std::optional<Fault> fault;
  std::vector<std::vector<std::int64_t>> letters(idx(all_.count()));
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (entries[k].number >= 0) {
      letters[idx(owner(entries[k].number))].push_back(entries[k].number);
    } else if (!fault) {
      fault = Fault{idx(lines.fixed[k].line),
                    fmt::format("vertex {} is fixed but has no VERTEX line, expected one that "
                                "says where",
                                ids[k])};
    }
  }
  all_.agree(file, fault);
  for (const std::int64_t number : all_.exchange(letters)) own_[local(number)].fixed = 1;
  if (all_.sum(static_cast<std::int64_t>(ids.size())) == 0) fix_first();
  tell_directory();
}

void Placing::fix_first() {
  std::int64_t line = std::numeric_limits<std::int64_t>::max();
  for (const PlacedLandmark& one : own_) line = std::min(line, one.line);
  line = all_.least(line);
  for (PlacedLandmark& one : own_) one.fixed = one.line == line ? 1 : 0;
}

void Placing::tell_directory() {
  std::vector<std::vector<std::int64_t>> letters(idx(all_.count()));
  for (const PlacedLandmark& one : own_) {
    if (one.fixed == 1) letters[idx(who_knows(one.id, all_.count()))].push_back(one.id);
  }
  for (const std::int64_t id : all_.exchange(letters)) find(id)->entry.fixed = 1;
}

}  // namespace trussmap::distributed
