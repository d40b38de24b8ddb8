// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::store.
//
// A map that grows for weeks: a map builder (map_builder.hpp) whose memory is a file.
//
//   MapStore store("map.db");              // made, or gone on with where it stopped
//   store.start("dock");
//   store.arrive("door", {displacement, covariance});     // once this returns, the leg is kept
//   store.builder().position(...)
//
// What a call has returned from survives the end of the program, kill -9 and the loss of power; a
// call that was under way then has either happened or not. Every leg is kept as it was given, so
// that a better map can be made of them later. A call writes a row per landmark that it moved:
// where groups move at every scale (map_builder.hpp) that may be all of them, some microseconds
// each; a session by append() writes each once. Opening costs what the map costs, not its history:
// landmarks, routes and the list of sessions are read, legs are not.
//
// The file is an SQLite database (write-ahead log, synchronous in full), and no program but one
// writes it at a time, which holds a lock on the file NAME-lock; others may read meanwhile. Who
// reads needs the right to write in its folder, unless the store was closed cleanly. Its tables:
//
//   map        landmark, x, y                                     where the landmarks are now, m
//   routes     source, target (numbers of landmarks), traversals, stretch, orientation, dx, dy,
//              c_xx, c_xy, c_yy                                   as landmark_map.hpp has them
//   legs       number, session, kind (0 start, 1 arrive, 2 observe, 3 compass, 4 relax), source,
//              target, own_axes (1: the robot's), dx, dy, turn, c_xx, c_xy, c_yy, c_xt, c_yt, c_tt,
//              ox, oy, o_xx, o_xy, o_yy (the landmark from the robot), outcome
//                                                                every call, in order; m, rad; of
//                                                                compass turn and c_tt
//   sessions   number, key, name, first_leg, legs                 those that append() took in
//   landmarks, reckoned, corners, chain, misfits, left_out, state, facts
//                                                                what else the builder remembers
//
// Link trussmap::store. All of this throws InputError, naming the file, where the file cannot be
// read or written, is no store or a damaged one, or is being written by another program.
#pragma once

#include "trussmap/map_builder.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// A call of the builder, as it was made. Names are empty where the kind has none.
struct StoredLeg {
  enum class Kind { start, arrive, observe, compass, relax };
  Kind kind = Kind::start;
  std::string from;  ///< where the robot said that it was, be that left out of the map or not
  std::string to;
  Traversal leg;          ///< of start its position alone
  bool own_axes = false;  ///< arrive and observe: by `motion` and `seen`, not by `leg`
  Motion motion;          ///< of compass the heading: reading and variance
  LandmarkOffset seen;    ///< of start, too
  /// Of arrive and observe: what it did to the map then (what was left out may have come back
  /// since).
  std::optional<Arrival::Kind> outcome = {};
  int session = -1;  ///< its place in sessions(), -1: none
};

/// Many calls that were taken in as one.
struct StoredSession {
  std::string key;   ///< what tells it from others
  std::string name;  ///< for people
  std::int64_t first_leg = 0;
  std::int64_t legs = 0;
};

/// Whether the file's name ends like a store's: .db, .sqlite or .sqlite3.
[[nodiscard]] bool is_map_store(const std::filesystem::path& file);

/// A call that throws leaves the store and its builder as they were. One thread at a time,
/// const calls included.
class MapStore {
 public:
  /// Goes on with the store, or makes one where there is no file or an empty one. A store with
  /// landmarks keeps its method and its law (std::invalid_argument for others); its other
  /// options are the given ones from now on, or where none are given those it had: a new one's are
  /// then `if_new`.
  explicit MapStore(const std::filesystem::path& file,
                    const std::optional<MapBuilderOptions>& options = {},
                    const MapBuilderOptions& if_new = {});
  ~MapStore();
  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;

  /// A new store that begins with a map made elsewhere (read_map_graphml, say), as
  /// MapBuilder(map, options) does. Throws as that does, and where the file is there already.
  [[nodiscard]] static MapStore create(const std::filesystem::path& file, const LandmarkGraph& map,
                                       const MapBuilderOptions& options = {});

  // As MapBuilder's, and kept once they return.
  void start(const std::string& landmark, const Vector2& position = Vector2::Zero());
  Arrival arrive(const std::string& landmark, const Traversal& leg);
  Arrival observe(const std::string& landmark, const Traversal& from_here);
  void start(const std::string& landmark, const LandmarkOffset& seen,
             const Vector2& position = Vector2::Zero());
  void compass(double reading, double sd);
  Arrival arrive(const std::string& landmark, const Motion& motion,
                 const LandmarkOffset& seen = {});
  Arrival observe(const std::string& landmark, const LandmarkOffset& seen);
  double relax();

  /// A new store that goes on with a builder as it is, with all that it remembers. Throws where the
  /// file is there already. read_builder() has it back.
  [[nodiscard]] static MapStore create(const std::filesystem::path& file,
                                       const MapBuilder& builder);

  /// Many calls as one: what `drive` does to the builder is kept as a whole or, where it throws,
  /// not at all. It calls the builder, which stays the store's, and not the store
  /// (std::logic_error; neither does a visitor of legs). `key` tells the session from others;
  /// throws std::invalid_argument if it is empty or there already.
  void append(const std::string& key, const std::string& name,
              const std::function<void(MapBuilder&)>& drive);

  /// The map and all that can be asked of it.
  [[nodiscard]] const MapBuilder& builder() const;

  [[nodiscard]] std::vector<StoredSession> sessions() const;
  [[nodiscard]] bool has_session(const std::string& key) const;

  /// Calls kept so far.
  [[nodiscard]] std::int64_t legs() const;

  /// All of them, in order.
  void for_each_leg(const std::function<void(const StoredLeg&)>& visit) const;

  /// What a program wants to know of its map next time: a text per name; empty: none.
  [[nodiscard]] std::string note(const std::string& name) const;
  void set_note(const std::string& name, const std::string& text);

 private:
  class Impl;
  explicit MapStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The builder that a store holds, as of the last call kept, also while another program writes it:
/// it goes on by itself, and what it does is not kept.
[[nodiscard]] MapBuilder read_builder(const std::filesystem::path& file);

/// What a store holds.
struct StoredMap {
  LandmarkGraph map;
  Method method = Method::elastic;
  std::vector<StoredSession> sessions;
  std::int64_t legs = 0;
};

/// Reads a store, also while another program writes it: the map as of the last call kept.
[[nodiscard]] StoredMap read_map_store(const std::filesystem::path& file);

}  // namespace trussmap
