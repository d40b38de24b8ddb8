// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A log's gathering under way: what its parts have in common, and the parts of their own.
#pragma once

#include "logs/asked_paths.hpp"
#include "logs/gathered_log.hpp"
#include "logs/message_feed.hpp"

#include <set>
#include <string>

namespace trussmap::logs {

struct Gathering {
  const LogMap& map;
  const JoinedLogs& logs;
  GatheredLog& to;
  MessageFeeds feeds{map, logs};
  AskedPaths paths{map};
  std::set<std::string> tf_topics = {};
};

// Each adds feeds, which refer to all that is given.
void feed_fixes(Gathering& g, const FixMap& fixes);
void feed_sightings(Gathering& g, const SightingMap& sightings);

/// The transforms of this topic, and of its static ones, are of use.
void want_frames(Gathering& g, const std::string& topic);

}  // namespace trussmap::logs
