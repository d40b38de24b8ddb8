// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap convert: maps between formats, foreign recordings to recordings, recordings to bags.
#include "commands.hpp"
#include "convert_log.hpp"
#include "convert_odometer.hpp"
#include "convert_recording.hpp"
#include "map_yaml_output.hpp"
#include "path_checks.hpp"
#include "private_folder.hpp"
#include "trussmap/datasets.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::vector<std::string> in;
  std::string out;
  std::string map;
  std::vector<std::string> definitions;
  bool inspect = false;
  ConvertRecordingOptions bag;
  ConvertOdometerOptions odometer;
  MapYamlOptions yaml;
};

void print_figure(const DatasetFigure& one) {
  if (one.value == 0.0 || one.words.empty()) return;
  if (one.value == std::floor(one.value)) {
    fmt::print("  {:>7.0f} {}\n", one.value, one.words);
  } else {
    fmt::print("  {:>7.4f} {}\n", one.value, one.words);
  }
}

void convert_dataset(const DatasetFormat& format, const fs::path& in, const fs::path& out) {
  const Dataset read = format.read(in);
  write_recording(out, read.recording, read.comment, {{"model.toml", format_model(read.model)}});
  fmt::print("converted: {} {} to the recording {}\n\n", format.name, in.string(), out.string());
  for (const DatasetFigure& one : read.figures) print_figure(one);
  for (const std::string& note : read.notes) fmt::print("  {}\n", note);
}

/// A recording is a folder; a map's or bag's name for it is a mistake.
void check_folder(const fs::path& out) {
  if (is_map_file(out)) {
    throw UsageError(out.string() + " is named like a map, expected a folder for the recording");
  }
  if (out.extension() == ".mcap") {
    throw UsageError(out.string() +
                     " is named like a bag, expected a folder for the recording, "
                     "which a second convert makes a bag of");
  }
}

/// The map's text, which its reader takes: what a format cannot hold, a map may.
std::string readable_map(const LandmarkGraph& map, const fs::path& in, const fs::path& out) {
  std::string text = format_map(map, out, "");
  const bool graph = out.extension() == ".g2o";
  if (!graph && out.extension() != ".graphml") return text;
  const PrivateFolder folder;
  const fs::path file = folder.path() / ("map" + out.extension().string());
  write_file(file, text);
  try {
    if (graph) {
      static_cast<void>(read_g2o(file.string()));
    } else {
      static_cast<void>(read_map(file));
    }
  } catch (const InputError& error) {
    throw InputError(
        in.string(), 0,
        "makes a map that could not be read again: " + folder.without_it(error.what()));
  }
  return text;
}

void make_store(const LandmarkGraph& map, const fs::path& in, const fs::path& out) {
  try {
    static_cast<void>(MapStore::create(out, map, {.method = Method::gauss_markov}));
  } catch (const std::invalid_argument& error) {
    throw InputError(in.string(), 0, std::string("makes no map store: ") + error.what());
  }
}

void convert_map(const fs::path& in, const fs::path& out, const MapYamlOptions& yaml) {
  const LandmarkGraph map = is_map_store(in) ? read_map_store(in).map : read_map(in);
  if (is_map_store(out)) {
    make_store(map, in, out);
  } else if (is_yaml_file(out)) {
    write_map_yaml(map, out, yaml);
  } else {
    write_file(out, readable_map(map, in, out));
  }
  fmt::print("converted: {} landmarks and {} routes to {}\n", map.landmarks(), map.routes(),
             out.string());
}

/// The last name is that of what is written; with --inspect all are read.
void part_out(ConvertOptions& options) {
  if (options.inspect || !options.out.empty() || options.in.size() < 2) return;
  options.out = options.in.back();
  options.in.pop_back();
}

LogOptions log_options(const ConvertOptions& options) {
  if (!options.definitions.empty() && !options.inspect && options.map.empty()) {
    throw UsageError("--definitions is for logs, expected --map or --inspect with it");
  }
  return {{options.definitions.begin(), options.definitions.end()}};
}

void run_convert(ConvertOptions options) {
  part_out(options);
  const fs::path in = options.in.front();
  const fs::path out = options.out;
  const std::vector<fs::path> logs(options.in.begin(), options.in.end());
  const LogOptions given = log_options(options);
  if (options.inspect) {
    if (logs.size() > 1 && !fs::exists(logs.back()) && !is_log(logs.back())) {
      throw UsageError("convert --inspect writes a map.toml alone, expected no OUT (--map FILE)");
    }
    inspect_log_files(logs, options.map, given);
    return;
  }
  if (options.out.empty()) throw UsageError("convert has nowhere to write to, expected OUT");
  check_output(out, "IN", logs);
  if (logs.size() > 1 && options.map.empty()) {
    throw UsageError(
        "several files become one recording by a map, expected --map map.toml (a first one: "
        "trussmap convert --inspect, with the same files)");
  }
  check_map_yaml(out, options.yaml);
  if (!options.odometer.second.empty()) {
    check_folder(out);
    convert_odometer(in, out, options.odometer);
    return;
  }
  if (is_recording_to_bag(in, out)) {
    convert_recording(in, out, options.map, options.bag);
    return;
  }
  if (!options.map.empty()) {
    check_folder(out);
    convert_logs(logs, out, options.map, given);
    return;
  }
  const DatasetFormat* const format = dataset_format(in);
  // A map, unless it is to become a recording.
  const bool graph = in.extension() == ".g2o" || in.string().ends_with(".g2o.xz");
  if (format != nullptr && (!graph || out.extension().empty())) {
    check_folder(out);
    convert_dataset(*format, in, out);
    return;
  }
  if (in.extension() != ".graphml" && in.extension() != ".g2o" && !is_map_store(in)) {
    if (is_log(in)) {
      throw UsageError(
          in.string() +
          " is a log, expected --map map.toml, which says what its fields are (a first "
          "one: trussmap convert --inspect " +
          in.string() + ")");
    }
    std::string expected = "a map (.graphml, .g2o, .db)";
    for (const DatasetFormat& one : dataset_formats())
      expected += fmt::format(", {}", one.expected);
    throw UsageError("cannot tell what " + in.string() + " is: expected " + expected +
                     "; files plain or .xz");
  }
  convert_map(in, out, options.yaml);
}

}  // namespace

void setup_convert(const Command& app) {
  auto options = std::make_shared<ConvertOptions>();
  const Command command = app.add_subcommand(
      "convert",
      "Convert maps between formats, foreign recordings to recordings, and recordings to bags");
  command
      .add_option(
          "IN", options->in,
          "A map (.graphml, .g2o, .db), a recording's folder, a log or several that belong "
          "together "
          "(tables, a bag and tables, or a folder of them; with --map or --inspect), "
          "DIR/RobotN of an MRCLAM data set, an "
          "OptiOdom run "
          "..._run-NN.csv, DIR/NAME of ranges to radio beacons, of places that look "
          "alike (TUC SLAM) or of a truck with steering and GPS (Victoria Park), dataset1.csv of a "
          "robot on a line, a log of a tricycle's encoders, or DIR/trial_N of PHIL's Turtlebot "
          "(plain or .xz files)")
      .required()
      .type_name("FILE");
  command
      .add_option("OUT", options->out,
                  "A map (.graphml, .g2o, .geojson, .dot, .yaml, .db), a bag of a recording "
                  "(.mcap), or the recording's folder (of a "
                  "pose graph, too: a name without an ending)")
      .type_name("FILE|DIR");
  command
      .add_option(
          "--map", options->map,
          "IN is a log: MCAP, a rosbag2 (.db3 or its folder), a bag of ROS 1 (.bag), .wpilog, Road "
          "Runner's .log, "
          "or a table (.csv, .tsv, .txt, .mat); FILE (map.toml) says which of its fields are what, "
          "and "
          "of several logs by file = \"NAME\" in which one they are. Of a "
          "recording to a bag: FILE is written, and reads the bag back")
      .type_name("FILE");
  command.add_flag("--inspect", options->inspect,
                   "List topics, fields and columns of the log IN, and write a first map (--map, "
                   "else map.toml) with guesses; of several logs also which clock is which, by "
                   "the motion that they have in common");
  command
      .add_option("--definitions", options->definitions,
                  "IN is a bag of ROS 2 that has no definitions of its own types: their .msg files "
                  "(PACKAGE/NAME.msg or PACKAGE/msg/NAME.msg), or a folder of packages; may be "
                  "given again")
      .type_name("DIR|FILE")
      .one_value_each();
  add_map_yaml(command, options->yaml);
  add_convert_recording(command, options->bag);
  add_convert_odometer(command, options->odometer);
  command.callback([options] { run_convert(*options); });
}

}  // namespace trussmap::app
