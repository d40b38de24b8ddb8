// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is every landmark tied to a fixed one? Each process joins what hangs together in its share; the
// parts, few, are joined across processes by the first.
#include "distributed/truss_share.hpp"
#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

constexpr std::int64_t kGround = -1;  // what fixed landmarks are joined to

using Tie = std::pair<std::int64_t, std::int64_t>;

bool joins(const ShareBar& bar) {
  return bar.xx != 0.0 || bar.xy != 0.0 || bar.yy != 0.0;
}

/// Per landmark of this process: the lowest number of those that hang together with it here.
std::vector<std::int64_t> own_parts(const Placing& placing, const std::vector<ShareBar>& bars) {
  linalg::DisjointSets sets(static_cast<int>(placing.own().size()));
  for (const ShareBar& bar : bars) {
    if (joins(bar) && placing.mine(bar.from) && placing.mine(bar.to)) {
      sets.join(static_cast<int>(placing.local(bar.from)), static_cast<int>(placing.local(bar.to)));
    }
  }
  std::vector<std::int64_t> parts(placing.own().size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k] = placing.first() + sets.lowest(static_cast<int>(k));
  }
  return parts;
}

/// A part that no tie leads from to the ground, if there is one: the lowest.
std::optional<std::int64_t> loose_part(const std::vector<Tie>& ties) {
  std::map<std::int64_t, int> places;
  for (const auto& [a, b] : ties) {
    places.emplace(a, 0);
    places.emplace(b, 0);
  }
  int next = 0;
  for (auto& [part, place] : places) place = next++;
  linalg::DisjointSets sets(next);
  for (const auto& [a, b] : ties) sets.join(places.at(a), places.at(b));
  const auto ground = places.find(kGround);
  for (const auto& [part, place] : places) {
    if (ground == places.end() || sets.lowest(place) != sets.lowest(ground->second)) return part;
  }
  return std::nullopt;
}

}  // namespace

void require_support(const Communicator& all, const Placing& placing,
                     const std::vector<ShareBar>& bars) {
  const std::vector<std::int64_t> parts = own_parts(placing, bars);
  std::vector<std::int64_t> far;
  std::vector<std::int64_t> near;
  std::vector<int> whom;
  for (const ShareBar& bar : bars) {
    if (!joins(bar) || (placing.mine(bar.from) && placing.mine(bar.to))) continue;
    const bool from_here = placing.mine(bar.from);
    near.push_back(parts[placing.local(from_here ? bar.from : bar.to)]);
    far.push_back(from_here ? bar.to : bar.from);
    whom.push_back(placing.owner(far.back()));
  }
  const std::vector<std::int64_t> theirs =
      all.ask(far, whom, [&](const std::int64_t& number) { return parts[placing.local(number)]; });
  std::vector<Tie> ties;
  for (std::size_t k = 0; k < theirs.size(); ++k) ties.emplace_back(near[k], theirs[k]);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (placing.first() + static_cast<std::int64_t>(k) == parts[k]) {
      ties.emplace_back(parts[k], parts[k]);
    }
    if (placing.own()[k].fixed == 1) ties.emplace_back(kGround, parts[k]);
  }
  std::sort(ties.begin(), ties.end());
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
  struct Letter {
    std::int64_t a;
    std::int64_t b;
  };
  std::vector<std::vector<Letter>> letters(idx(all.count()));
  for (const auto& [a, b] : ties) letters.front().push_back({a, b});
  ties.clear();
  for (const Letter& one : all.exchange(letters)) ties.emplace_back(one.a, one.b);
  const std::optional<std::int64_t> loose = all.rank() == 0 ? loose_part(ties) : std::nullopt;
  constexpr std::int64_t kNone = -2;
  const std::int64_t number = all.all_of(loose.value_or(kNone)).front();
  if (number == kNone) return;
  const int who = placing.owner(number);
  const bool here = who == all.rank();
  const std::string id =
      all.from(who, here ? fmt::format("{}", placing.own()[placing.local(number)].id) : "");
  throw SolveError(
      fmt::format("vertex {} is tied to nothing that is held: no chain of measurements leads from "
                  "it to a fixed "
                  "vertex; FIX one of its part, or measure a route to it",
                  id));
}

}  // namespace trussmap::distributed
