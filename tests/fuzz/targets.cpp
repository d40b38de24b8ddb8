// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fuzz/targets.hpp"

#include "datasets/formats.hpp"
#include "trussmap/check.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/shape.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/test_path.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

namespace trussmap::fuzz {
using namespace datasets;
namespace {

namespace fs = std::filesystem;

/// A folder of this process alone, gone when it ends.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("trussmap_fuzz_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] fs::path write(const std::string& name, std::string_view bytes) const {
    const fs::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  void remove(const std::string& name) const {
    std::error_code ignored;
    fs::remove(path_ / name, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

const Folder& folder() {
  static const Folder kFolder;
  return kFolder;
}

/// Files in one input lie between lines of "====".
std::vector<std::string_view> parts_of(std::string_view bytes) {
  constexpr std::string_view kBetween = "====\n";
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = bytes.find(kBetween);
    parts.push_back(bytes.substr(0, at));
    if (at == std::string_view::npos) return parts;
    bytes.remove_prefix(at + kBetween.size());
  }
}

/// Each part as the file of its name; those without a part are absent.
void write_parts(std::string_view bytes, const std::vector<std::string>& names) {
  const std::vector<std::string_view> parts = parts_of(bytes);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k < parts.size() && !parts[k].empty()) {
      static_cast<void>(folder().write(names[k], parts[k]));
    } else {
      folder().remove(names[k]);
    }
  }
}

template <typename Call>
void may_refuse(const Call& call) {
  try {
    call();
  } catch (const InputError&) {
  }
}

void fuzz_recording(std::string_view bytes) {
  write_parts(bytes,
              {"drive.csv", "sightings.csv", "survey.csv", "truth.csv", "fixes.csv", "loops.csv"});
  may_refuse([] {
    const Recording recording = read_recording(folder().path());
    Model model;
    if (recording.drive.left.empty()) {
      // Its columns are the wheels of whatever drive has so many.
      model.robot.drive =
          recording.drive.covariates.size() == 2 ? DriveKind::ackermann : DriveKind::omni3;
      model.robot.length = 0.3;
      for (const Covariate& one : recording.drive.covariates) {
        model.robot.columns.push_back(one.name);
      }
      if (model.robot.columns.size() < 2 || model.robot.columns.size() > 3) return;
    }
    for (const CheckFinding& one : check_recordings({recording}, &model, "model.toml")) {
      if (in_words(one).find('\n') != std::string::npos) throw std::logic_error("two lines");
    }
    static_cast<void>(check_recordings({recording, recording}));
  });
}

/// What has been read is written, and read again the same.
void fuzz_model(std::string_view bytes) {
  may_refuse([bytes] {
    const Model model = read_model(folder().write("model.toml", bytes));
    const std::string text = format_model(model);
    const Model again = read_model(folder().write("again.toml", text));
    if (format_model(again) != text) throw std::logic_error("model changed on the way");
  });
}

void fuzz_graphml(std::string_view bytes) {
  may_refuse([bytes] {
    const LandmarkGraph map = read_map_graphml(folder().write("map.graphml", bytes));
    const std::string text = format_map_graphml(map);
    static_cast<void>(read_map_graphml(folder().write("again.graphml", text)));
    static_cast<void>(format_geojson(map));
    static_cast<void>(format_dot(map));
  });
}

void fuzz_g2o(std::string_view bytes) {
  may_refuse([bytes] {
    const PoseGraph graph = parse_g2o(bytes, "graph.g2o");
    static_cast<void>(format_g2o(graph));
  });
  const fs::path file = folder().write("graph.g2o", bytes);
  may_refuse([&file] { static_cast<void>(read_graph_recording(file)); });
}

void fuzz_mrclam(std::string_view bytes) {
  write_parts(bytes, {"Robot1_Odometry.dat", "Robot1_Measurement.dat", "Barcodes.dat",
                      "Landmark_Groundtruth.dat", "Robot1_Groundtruth.dat"});
  may_refuse([] { static_cast<void>(read_mrclam(folder().path() / "Robot1")); });
}

void fuzz_optiodom(std::string_view bytes) {
  write_parts(bytes, {"a_run-01.csv", "a_metadata.csv"});
  may_refuse([] { static_cast<void>(read_optiodom(folder().path() / "a_run-01.csv")); });
}

void fuzz_ranges(std::string_view bytes) {
  write_parts(bytes, {"a_DR.txt", "a_TD.txt", "a_GT.csv"});
  may_refuse([] { static_cast<void>(read_radio_ranges(folder().path() / "a")); });
}

void fuzz_loops(std::string_view bytes) {
  write_parts(bytes, {"a_Input.txt"});
  may_refuse([] { static_cast<void>(read_place_loops(folder().path() / "a")); });
}

void fuzz_phil(std::string_view bytes) {
  write_parts(bytes, {"kobuki_data.csv", "rio_data.csv", "mocap_robot.csv"});
  may_refuse([] { static_cast<void>(read_phil(folder().path())); });
}

void fuzz_truck(std::string_view bytes) {
  write_parts(bytes, {"a_dr.mat", "a_gpsx.mat", "victoriaPark.txt"});
  may_refuse([] { static_cast<void>(read_steered_truck(folder().path() / "a")); });
  folder().remove("victoriaPark.txt");
}

void fuzz_line(std::string_view bytes) {
  const fs::path file = folder().write("dataset1.csv", bytes);
  may_refuse([&file] { static_cast<void>(read_line_robot(file)); });
}

void fuzz_encoders(std::string_view bytes) {
  const fs::path file = folder().write("log.txt", bytes);
  may_refuse([&file] {
    if (is_encoder_log(file)) static_cast<void>(read_encoder_log(file));
  });
}

void fuzz_runs(std::string_view bytes) {
  const fs::path file = folder().write("runs.csv", bytes);
  may_refuse([&file] { static_cast<void>(read_square_runs(file, 16.0)); });
  may_refuse([&file] { static_cast<void>(read_end_errors(file, 16.0)); });
  may_refuse([&file] { static_cast<void>(read_taped_runs(file)); });
}

void fuzz_words(std::string_view bytes) {
  const std::string text(bytes);
  const auto ask = [](const auto& call) {
    try {
      call();
    } catch (const std::invalid_argument&) {
    }
  };
  ask([&text] { static_cast<void>(Shape(text)); });
  ask([&text] { static_cast<void>(parse_path(text)); });
  ask([&text] { static_cast<void>(parse_mesh_size(text)); });
  ask([&text] { static_cast<void>(parse_rough(text)); });
}

void fuzz_xz(std::string_view bytes) {
  may_refuse(
      [bytes] { static_cast<void>(read_square_runs(folder().write("runs.csv.xz", bytes), 16.0)); });
}

/// All that a store says of itself; its map as of now.
std::string all_of(const MapStore& store) {
  std::string text = format_map_graphml(store.builder().map()) + std::to_string(store.legs());
  const std::vector<StoredSession> sessions = store.sessions();
  store.for_each_leg([&](const StoredLeg& one) {
    text += one.from + one.to + static_cast<char>('0' + static_cast<int>(one.kind));
    if (one.session >= 0) text += sessions.at(static_cast<std::size_t>(one.session)).key;
  });
  for (const StoredSession& one : sessions) text += one.key + one.name;
  return text + store.note("page");
}

/// A call that the builder may refuse; the store is then as it was.
template <typename Call>
void may_decline(const MapStore& store, const Call& call) {
  const std::string before = all_of(store);
  try {
    call();
    return;
  } catch (const InputError&) {
    throw;
  } catch (const SolveError&) {
  } catch (const std::invalid_argument&) {
  }
  if (all_of(store) != before) throw std::logic_error("a call that threw changed the store");
}

/// One is read, goes on for some calls, and is then read again as it was left.
void fuzz_store(std::string_view bytes) {
  for (const char* beside : {"map.db-wal", "map.db-shm", "map.db-journal", "map.db-lock"}) {
    folder().remove(beside);
  }
  const fs::path file = folder().write("map.db", bytes);
  may_refuse([&file] { static_cast<void>(read_map_store(file)); });
  may_refuse([&file] {
    std::string left;
    {
      MapStore store(file);
      const MapBuilder& builder = store.builder();
      const Traversal leg{{1.0, 0.5}, 0.01 * Matrix2::Identity()};
      may_decline(store, [&] { store.arrive("on", leg); });
      const std::string first = builder.landmarks() > 0 ? builder.map().landmark(0).name : "a";
      may_decline(store, [&] { store.start(first); });
      may_decline(store, [&] { store.arrive("b", leg); });
      may_decline(store, [&] { store.observe("c", leg); });
      may_decline(store, [&] {
        store.append("fuzzed", "a session", [&](MapBuilder& session) {
          session.arrive("d", leg);
          session.arrive(first, leg);
        });
      });
      may_decline(store, [&] { store.compass(0.1, 0.05); });
      may_decline(store, [&] { store.relax(); });
      store.set_note("page", "p");
      left = all_of(store);
    }
    if (all_of(MapStore(file)) != left)
      throw std::logic_error("a store changed when it was closed");
  });
}

}  // namespace

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> kTargets = [] {
    std::map<std::string, Target> all = {
        {"recording", &fuzz_recording}, {"model", &fuzz_model},
        {"graphml", &fuzz_graphml},     {"g2o", &fuzz_g2o},
        {"mrclam", &fuzz_mrclam},       {"optiodom", &fuzz_optiodom},
        {"ranges", &fuzz_ranges},       {"loops", &fuzz_loops},
        {"phil", &fuzz_phil},           {"truck", &fuzz_truck},
        {"line", &fuzz_line},           {"encoders", &fuzz_encoders},
        {"runs", &fuzz_runs},           {"store", &fuzz_store},
        {"words", &fuzz_words},         {"xz", &fuzz_xz}};
    all.insert(log_targets().begin(), log_targets().end());
    all.merge(bag_targets());
    return all;
  }();
  return kTargets;
}

}  // namespace trussmap::fuzz
