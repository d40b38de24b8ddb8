// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_share.hpp"

#include "geometry/index.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::distributed {

std::vector<ShareBar> share_bars(const Communicator& all, Placing& placing,
                                 const std::vector<RouteLine>& routes, const std::string& file) {
  std::vector<std::int64_t> ids;
  ids.reserve(2 * routes.size());
  for (const RouteLine& one : routes) {
    ids.push_back(one.from);
    ids.push_back(one.to);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const std::vector<Entry> entries = placing.look_up(ids);
  const auto entry_of = [&](std::int64_t id) -> const Entry& {
    return entries[idx(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin())];
  };
  std::optional<Fault> fault;
  std::vector<std::vector<ShareBar>> letters(idx(all.count()));
  for (const RouteLine& one : routes) {
    const Entry& from = entry_of(one.from);
    const Entry& to = entry_of(one.to);
    if (from.number < 0 || to.number < 0) {
      fault = Fault{idx(one.line),
                    fmt::format("vertex {} has no VERTEX line, expected one for every vertex",
                                from.number < 0 ? one.from : one.to)};
      break;
    }
    const ShareBar bar{from.number,
                       to.number,
                       one.dx - (to.x - from.x),
                       one.dy - (to.y - from.y),
                       one.xx,
                       one.xy,
                       one.yy,
                       static_cast<std::int32_t>(from.fixed),
                       static_cast<std::int32_t>(to.fixed)};
    const int near = placing.owner(from.number);
    const int far = placing.owner(to.number);
    letters[idx(near)].push_back(bar);
    if (far != near) letters[idx(far)].push_back(bar);
  }
  all.agree(file, fault);
  return all.exchange(letters);
}

}  // namespace trussmap::distributed
