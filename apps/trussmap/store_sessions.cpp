// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store_sessions.hpp"

#include "build_output.hpp"
#include "command_line.hpp"
#include "model_recordings.hpp"
#include "recording_warnings.hpp"
#include "results/json.hpp"
#include "results/maps.hpp"
#include "terminal.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

constexpr const char* kAxes = "axes";  // a note of the store: in which frame its map is

std::string option_of(Method method) {
  std::string name = name_of(method);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

MapStore opened(const StoreSessions& options) {
  if (!is_map_store(options.store)) {
    throw UsageError(options.store + " is no name of a store, expected one that ends in .db");
  }
  MapBuilderOptions fresh;
  fresh.method = options.method.value_or(Method::gauss_markov);
  fresh.scope = options.build.scope;
  fresh.law = options.build.law;
  std::optional<MapBuilderOptions> given;
  if (options.method || options.scope_given) given = fresh;
  try {
    return MapStore(options.store, given, fresh);
  } catch (const std::invalid_argument&) {
    throw UsageError(
        fmt::format("{0} keeps the method and the law that it was made with: "
                    "{1}, expected --method {1} or none",
                    options.store, option_of(read_map_store(options.store).method)));
  }
}

/// The first session says in which frame the map is.
MapAxes axes_of(MapStore& store, const DrivenRecording& recording) {
  if (store.builder().landmarks() == 0) {
    store.set_note(kAxes, recording.drive.has_compass() ? "compass" : "landmarks");
  }
  return store.note(kAxes) == "compass" ? MapAxes::compass : MapAxes::landmarks;
}

BuiltMap added(MapStore& store, const std::string& key, const DrivenRecording& recording,
               const Model& model, const StoreSessions& options) {
  const MapAxes axes = axes_of(store, recording);
  BuiltMap built;
  store.append(key, recording.name, [&](MapBuilder& builder) {
    try {
      built = extend_map(builder, recording, model, axes, options.build);
    } catch (const std::invalid_argument& error) {  // an effect that it cannot have
      throw InputError(options.model, 0, error.what());
    }
  });
  return built;
}

/// The map as a whole is older than this recording: how good it is, nothing of it tells.
std::string verdict_of_session(const BuiltMap& built) {
  if (!built.good()) return verdict_in_words(built);
  if (!built.extended) return "good: nothing speaks against it";
  return fmt::format(
      "good: adjusted by itself it puts its landmarks {:.3f} m (rms) from where the map has them",
      built.quality.from_adjusted);
}

void print_session(const DrivenRecording& recording, const BuiltMap& built) {
  fmt::print("{}: {} legs, {} new landmarks\n", recording.name, built.legs, built.new_landmarks);
  fmt::print("  {}\n",
             verdict_text(built.good() ? Mood::good : Mood::doubt, verdict_of_session(built)));
  for (std::size_t k = 1; k < built.warnings.size(); ++k) {  // the verdict has the first
    fmt::print("  {}", warning_text(built.warnings[k]));
  }
  for (const std::string& note : built.notes) fmt::print("  note: {}\n", shortened_words(note));
  std::fflush(stdout);  // who reads it may rely on it
}

}  // namespace

void add_sessions(const StoreSessions& options) {
  const std::vector<Recording> read = read_recordings(options.recordings);
  const Model model = read_model(options.model, read);
  const std::vector<DrivenRecording> recordings = with_wheels(read, model.robot);
  warn_of_mistakes(read, model, options.model);
  MapStore store = opened(options);
  std::vector<std::unique_ptr<const BuiltMap>> built;
  std::vector<results::AddedSession> sessions;
  for (const DrivenRecording& recording : recordings) {
    const std::string key = fingerprint(recording);
    if (store.has_session(key)) {
      fmt::print("{}: is in the store already, nothing added\n", recording.name);
      continue;
    }
    built.push_back(std::make_unique<const BuiltMap>(added(store, key, recording, model, options)));
    print_session(recording, *built.back());
    sessions.push_back({{built.back().get(), option_of(built.back()->method)}, recording.name});
  }

  const MapBuilder& builder = store.builder();
  const LandmarkGraph map = builder.map();
  const std::string method = option_of(builder.options().method);
  const std::size_t count = store.sessions().size();
  Files files;
  if (!options.out.empty()) {
    files.emplace_back(options.out, format_map(map, options.out,
                                               "trussmap build, from a store, method " + method));
  }
  if (!options.csv.empty()) files.emplace_back(options.csv, format_positions(map));
  if (!options.json_file.empty()) {
    files.emplace_back(options.json_file, results::json_text(results::StoreReport{
                                              options.store, method, &map, count, store.legs(),
                                              builder.left_out().size(), std::move(sessions)}));
  }
  files.write();
  fmt::print(
      "\nmap of {} landmarks and {} routes in {}, method {}: {} sessions, {} arrivals left "
      "out\n",
      map.landmarks(), map.routes(), options.store, method, count, builder.left_out().size());
  print_written(files);
}

}  // namespace trussmap::app
