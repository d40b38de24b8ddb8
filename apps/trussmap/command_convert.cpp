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
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

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
  bool inspect = false;
  ConvertRecordingOptions bag;
  ConvertOdometerOptions odometer;
  MapYamlOptions yaml;
};

void count(int number, const char* what) {
  if (number > 0) fmt::print("  {:>7} {}\n", number, what);
}

void convert_mrclam(const fs::path& in, const fs::path& out) {
  const MrclamRecording foreign = read_mrclam(in);
  write_recording(out, foreign.recording,
                  fmt::format("t = 0 is {:.0f} s, Unix time", foreign.epoch),
                  {{"model.toml", format_model(foreign.model)}});
  const Recording& recording = foreign.recording;
  fmt::print("converted: MRCLAM {} to the recording {}\n\n", in.string(), out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows");
  count(static_cast<int>(recording.sightings.size()), "sightings");
  count(static_cast<int>(recording.survey.size()), "surveyed landmarks");
  count(static_cast<int>(recording.truth.size()), "truth rows");
  count(foreign.merged_times, "odometry rows merged: their time repeats or runs backwards");
  count(foreign.robots_seen, "sightings of other robots dropped");
  count(foreign.unknown_barcodes, "sightings of unknown barcodes dropped");
  count(foreign.outside_drive, "sightings outside of the drive dropped");
  count(foreign.unordered_sightings, "sightings were out of order in time");
  count(foreign.same_frame, "sightings set to the time of their camera frame (within 5 ms)");
}

void convert_optiodom(const fs::path& in, const fs::path& out) {
  const OptiOdomRecording foreign = read_optiodom(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("OptiOdom run {}", in.filename().string()),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: OptiOdom {} to the recording {}\n\n", in.string(), out.string());
  fmt::print("  {:>7} drive rows, each with the truth\n", recording.drive.rows());
  fmt::print("  {:>7.4f} mm a tick\n", 1000.0 * foreign.metre_per_tick);
}

void convert_radio_ranges(const fs::path& in, const fs::path& out) {
  const RangeRecording foreign = read_radio_ranges(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("t = 0 is {:.0f} s", foreign.epoch),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: ranges to radio beacons {} to the recording {}\n\n", in.string(),
             out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows, as of a wheelbase of 1 m");
  count(static_cast<int>(recording.sightings.size()), "ranges");
  count(static_cast<int>(recording.truth.size()), "truth rows");
  count(foreign.outside_drive, "ranges outside of the drive dropped");
  count(foreign.unordered_ranges, "ranges were out of order in time");
}

void convert_place_loops(const fs::path& in, const fs::path& out) {
  const PlaceLoopRecording foreign = read_place_loops(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("places that look alike, {}", in.string()),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: places that look alike {} to the recording {}\n\n", in.string(),
             out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows, as of a wheelbase of 1 m");
  count(static_cast<int>(recording.loops.size()), "loops");
  count(foreign.outside_drive, "loops outside of the drive dropped");
}

void convert_phil(const fs::path& in, const fs::path& out) {
  const PhilRecording foreign = read_phil(in);
  const Recording& recording = foreign.recording;
  const std::string clocks =
      foreign.aligned
          ? fmt::format(
                "the gyro's log is {:.3f} s later than the wheels', by their turns (correlation "
                "{:.3f}): set back",
                foreign.gyro_late, foreign.gyro_likeness)
          : fmt::format(
                "the gyro's clock stays as it is: its turns and the wheels' are too little alike "
                "(correlation {:.2f})",
                foreign.gyro_likeness);
  write_recording(out, recording,
                  fmt::format("t = 0 is {:.3f} s, Unix time\n{}", foreign.epoch, clocks),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: PHIL {} to the recording {}\n\n", in.string(), out.string());
  count(foreign.tick_rows, "rows of ticks, of which were made");
  count(static_cast<int>(recording.drive.rows()), "drive rows");
  count(static_cast<int>(recording.truth.size()), "truth rows");
  count(foreign.stale_samples, "rows that repeat a sample of the gyro skipped");
  count(foreign.lost_frames, "frames without the robot, or where it jumps, left out");
  fmt::print("  {}\n", clocks);
}

void convert_pose_graph(const fs::path& in, const fs::path& out) {
  const GraphRecording foreign = read_graph_recording(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("the pose graph {}, a second per pose", in.string()),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: the pose graph {} to the recording {}\n\n", in.string(), out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows, a second per pose");
  count(static_cast<int>(recording.loops.size()), "loops");
  count(static_cast<int>(recording.sightings.size()), "sightings");
  count(foreign.uneven_edges,
        "rows whose noise is not half to twice the median, which the model has");
}

void convert_steered_truck(const fs::path& in, const fs::path& out) {
  const TruckRecording foreign = read_steered_truck(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("a truck with steering and GPS, {}", in.string()),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: a truck with steering and GPS {} to the recording {}\n\n", in.string(),
             out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows, of one wheel and the steering");
  count(static_cast<int>(recording.fixes.size()), "fixes");
  count(foreign.repeated_fixes, "fixes whose time repeats or runs backwards dropped");
  count(foreign.graph_poses, "poses of victoriaPark.txt found in the drive");
  count(static_cast<int>(recording.sightings.size()), "sightings of trees from there");
}

void convert_line_robot(const fs::path& in, const fs::path& out) {
  const LineRecording foreign = read_line_robot(in);
  const Recording& recording = foreign.recording;
  write_recording(out, recording, fmt::format("a robot on a line, {}", in.string()),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: a robot on a line {} to the recording {}\n\n", in.string(), out.string());
  count(static_cast<int>(recording.drive.rows()), "drive rows, as of a wheelbase of 1 m");
  count(static_cast<int>(recording.sightings.size()), "ranges to the post");
  count(static_cast<int>(recording.truth.size()), "truth rows");
}

void convert_encoder_log(const fs::path& in, const fs::path& out) {
  const EncoderLogRecording foreign = read_encoder_log(in);
  write_recording(out, foreign.recording,
                  fmt::format("t = 0 is {:.3f} s, Unix time", foreign.epoch),
                  {{"model.toml", format_model(foreign.model)}});
  fmt::print("converted: a tricycle's encoders {} to the recording {}\n\n", in.string(),
             out.string());
  count(foreign.samples, "samples, of which five make one of the");
  count(static_cast<int>(foreign.recording.drive.rows()), "drive rows, each with the truth");
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

/// A kind of foreign recording: what tells it, and what converts it.
struct Foreign {
  bool (*is)(const fs::path& in);
  void (*convert)(const fs::path& in, const fs::path& out);
};

constexpr Foreign kForeign[] = {{&is_mrclam, &convert_mrclam},
                                {&is_optiodom, &convert_optiodom},
                                {&is_radio_ranges, &convert_radio_ranges},
                                {&is_place_loops, &convert_place_loops},
                                {&is_phil, &convert_phil},
                                {&is_steered_truck, &convert_steered_truck},
                                {&is_line_robot, &convert_line_robot},
                                {&is_encoder_log, &convert_encoder_log}};

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

void run_convert(ConvertOptions options) {
  part_out(options);
  const fs::path in = options.in.front();
  const fs::path out = options.out;
  const std::vector<fs::path> logs(options.in.begin(), options.in.end());
  if (options.inspect) {
    if (logs.size() > 1 && !fs::exists(logs.back()) && !is_log(logs.back())) {
      throw UsageError("convert --inspect writes a map.toml alone, expected no OUT (--map FILE)");
    }
    inspect_log_files(logs, options.map);
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
    convert_logs(logs, out, options.map);
    return;
  }
  for (const Foreign& one : kForeign) {
    if (!one.is(in)) continue;
    check_folder(out);
    one.convert(in, out);
    return;
  }
  const bool graph = in.extension() == ".g2o" || in.string().ends_with(".g2o.xz");
  if (graph && out.extension().empty()) {
    convert_pose_graph(in, out);
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
    throw UsageError("cannot tell what " + in.string() +
                     " is: expected a map (.graphml, .g2o, .db), DIR/RobotN of an MRCLAM data set, "
                     "an OptiOdom run (..._run-NN.csv, plain or .xz), DIR/NAME of ranges to radio "
                     "beacons (NAME_DR.txt, NAME_TD.txt), DIR/NAME of places that look alike "
                     "(NAME_Input.txt), DIR/NAME of a truck with steering and GPS (NAME_dr.mat, "
                     "NAME_gpsx.mat), a robot on a line (dataset1.csv), a log of a tricycle's "
                     "encoders (.txt), or a trial of PHIL's Turtlebot "
                     "(a folder with kobuki_data.csv)");
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
          "IN is a log: MCAP, a rosbag2 (.db3 or its folder), .wpilog, Road Runner's .log, "
          "or a table (.csv, .tsv, .txt); FILE (map.toml) says which of its fields are what, and "
          "of several logs by file = \"NAME\" in which one they are. Of a "
          "recording to a bag: FILE is written, and reads the bag back")
      .type_name("FILE");
  command.add_flag("--inspect", options->inspect,
                   "List topics, fields and columns of the log IN, and write a first map (--map, "
                   "else map.toml) with guesses; of several logs also which clock is which, by "
                   "the motion that they have in common");
  add_map_yaml(command, options->yaml);
  add_convert_recording(command, options->bag);
  add_convert_odometer(command, options->odometer);
  command.callback([options] { run_convert(*options); });
}

}  // namespace trussmap::app
