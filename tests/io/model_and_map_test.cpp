// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Models (TOML) and maps (GraphML, GeoJSON, DOT) out and in, and what is refused.
#include "scratch_folder.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::model_and_map_test {
namespace {

using testing::ScratchFolder;

struct Refused {
  const char* name;
  std::string content;
  const char* message;  // after the file's name
};

void PrintTo(const Refused& refused, std::ostream* stream) {
  *stream << refused.name;
}

template <class Read>
std::string message_of(const Read& read, const std::filesystem::path& file) {
  try {
    (void)read(file);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(file.string().size());
  }
  return "read without complaint";
}

class BadModel : public ::testing::TestWithParam<Refused> {};

TEST_P(BadModel, IsRefusedWithItsLine) {
  const ScratchFolder scratch;
  const auto file = scratch.write("m.toml", GetParam().content);
  const std::string message = message_of([](const auto& path) { return read_model(path); }, file);
  EXPECT_EQ(message.rfind(GetParam().message, 0), 0U) << message;
}

/// A model whose only process begins in line 4, its keys in line 5.
std::string process_of(const std::string& keys) {
  return "[noise]\nleft = 0.01\n\n[[noise.process]]\n" + keys;
}

const Refused kBadModels[] = {
    {"NoToml", "[robot\n", ":1: no TOML: "},
    {"UnknownTable", "[robto]\n", ":1: key \"robto\" is unknown, expected robot, noise or effect"},
    {"UnknownKey", "[robot]\nbase = 1\n",
     ":2: key \"base\" in [robot] is unknown for drive differential, expected drive, columns, "
     "wheelbase, sensor, antenna, tracked, scanner"},
    {"YawOfAnAntenna", "[robot.antenna]\nx = 1\nyaw = 0.1\n",
     ":3: key \"yaw\" in [robot.antenna] is unknown, expected x, y"},
    {"KeyOfASensor", "[robot.sensor]\nahead = 1\n",
     ":2: key \"ahead\" in [robot.sensor] is unknown, expected x, y, yaw"},
    {"PlaceInWords", "[robot]\nscanner = \"front\"\n", ":2: "},
    {"UnknownDrive", "[robot]\ndrive = \"hover\"\n",
     ":2: drive \"hover\" is unknown, expected one of differential, unicycle, skid-steer, "
     "tricycle, "
     "ackermann, omni3, mecanum, wheels"},
    {"KeyOfAnotherDrive", "[robot]\ndrive = \"omni3\"\nwheelbase = 0.3\n",
     ":3: key \"wheelbase\" in [robot] is unknown for drive omni3, expected drive, columns, "
     "radius, sensor, antenna, tracked, scanner"},
    {"LengthOfTricycle", "[robot]\ndrive = \"tricycle\"\n",
     ":1: [robot] has no length, expected one of drive tricycle"},
    {"NegativeLength", "[robot]\ndrive = \"tricycle\"\nlength = -1\n",
     ":3: length is -1, expected more than 0 (m)"},
    {"ColumnTwice", "[robot]\ndrive = \"tricycle\"\nlength = 1\ncolumns = [\"a\", \"a\"]\n",
     ":4: column \"a\" is named twice, expected each wheel once"},
    {"TooFewColumns", "[robot]\ndrive = \"omni3\"\nradius = 1\ncolumns = [\"a\", \"b\"]\n",
     ":1: drive omni3 has 2 columns, expected 3"},
    {"OddSkidSteer",
     "[robot]\ndrive = \"skid-steer\"\nwheelbase = 1\ncolumns = [\"a\", \"b\", \"c\"]\n",
     ":1: drive skid-steer has 3 columns, expected 2, 4 or 6, those of the left side first"},
    {"WheelsWithoutMatrix", "[robot]\ndrive = \"wheels\"\ncolumns = [\"a\", \"b\"]\n",
     ":1: drive wheels needs either [[robot.wheel]] or columns and a matrix, expected one"},
    {"ShortMatrix",
     "[robot]\ndrive = \"wheels\"\ncolumns = [\"a\", \"b\"]\nmatrix = [[1, 1], [0], [1, 1]]\n",
     ":4: a row of matrix is no list of 2 numbers, expected one per column"},
    {"WheelWithoutColumn", "[robot]\ndrive = \"wheels\"\n[[robot.wheel]]\ny = 1\n",
     ":3: a wheel has no column, expected the name of its column of drive.csv"},
    {"WheelsOnOneLine",
     "[robot]\ndrive = \"wheels\"\n[[robot.wheel]]\ncolumn = \"a\"\n[[robot.wheel]]\ncolumn = "
     "\"b\"\n",
     ":1: the wheels do not tell forward and turn apart, expected two at least that roll side by "
     "side"},
    {"ChannelOfAnotherDrive",
     "[robot]\n[[effect]]\nname = \"slip\"\nchannel = \"sideways\"\nshape = [\"1\"]\n",
     ":5: effect \"slip\": channel \"sideways\" is of another drive than differential"},
    {"Wheelbase", "[robot]\nwheelbase = 0\n", ":2: wheelbase is 0, expected more than 0 (m)"},
    {"TextWheelbase", "[robot]\nwheelbase = \"wide\"\n",
     ":2: wheelbase is no number, expected one"},
    {"NegativeNoise", "\n[noise]\nleft = -1\n", ":3: left is negative, expected 0 or more"},
    {"NaNNoise", "[noise]\nleft = nan\n", ":2: left is not finite, expected a number"},
    {"UnknownNoise", "[noise]\nlefft = 1\n",
     ":2: key \"lefft\" in [noise] is unknown, expected one of left, right, compass"},
    {"ProcessTable", "[noise]\n[noise.process]\nchannel = \"turn\"\n",
     ":2: process is no list of tables, expected [[noise.process]]"},
    {"UnknownProcess", process_of("channel = \"turn\"\nprocess = \"per lap\"\nsd = 0.01\n"),
     ":6: process \"per lap\" is unknown, expected one of white, per leg, per session, per pass, "
     "correlated in t, correlated in distance, walk in t, walk in distance"},
    {"ChannelOfProcess", process_of("channel = \"spin\"\nprocess = \"per leg\"\nsd = 0.01\n"),
     ":5: channel \"spin\" is unknown, expected one of travel, left,"},
    {"KeyOfProcess", process_of("channel = \"turn\"\nprocess = \"per leg\"\nsdd = 0.01\n"),
     ":7: key \"sdd\" in [[noise.process]] is unknown, expected channel, process, sd, length or "
     "tails"},
    {"ProcessWithoutChannel", process_of("process = \"per leg\"\nsd = 0.01\n"),
     ":4: a noise process has no channel, expected channel, process and sd"},
    {"ProcessWithoutProcess", process_of("channel = \"turn\"\nsd = 0.01\n"),
     ":4: a noise process has no process, expected channel, process and sd"},
    {"ProcessWithoutSd", process_of("channel = \"turn\"\nprocess = \"per leg\"\n"),
     ":4: a noise process has no sd, expected channel, process and sd"},
    {"TextChannelOfProcess", process_of("channel = 1\nprocess = \"per leg\"\nsd = 0.01\n"),
     ":5: channel is no text, expected \"...\""},
    {"ProcessSdOf0", process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = 0\n"),
     ":7: sd is 0, expected more than 0"},
    {"ProcessSdBelow0", process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = -0.5\n"),
     ":7: sd is -0.5, expected more than 0"},
    {"TextSdOfProcess", process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = \"1\"\n"),
     ":7: sd is no number, expected one"},
    {"EndlessSdOfProcess", process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = inf\n"),
     ":7: sd is not finite, expected a number"},
    {"ProcessTwice",
     process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = 0.01\n[[noise.process]]\n"
                "channel = \"turn\"\nprocess = \"per leg\"\nsd = 0.02\n"),
     ":8: a noise process turn per leg is there already, in line 4, expected one of each"},
    {"LengthOfALeg",
     process_of("channel = \"turn\"\nprocess = \"per leg\"\nsd = 0.01\nlength = 2\n"),
     ":8: a process per leg has a length, expected none"},
    {"LengthOfAWalk",
     process_of("channel = \"turn\"\nlength = 2\nprocess = \"walk in t\"\nsd = 0.01\n"),
     ":6: a process walk in t has a length, expected none"},
    {"NoLengthInTime", process_of("channel = \"turn\"\nprocess = \"correlated in t\"\nsd = 0.01\n"),
     ":4: a process correlated in t has no length, expected one (s)"},
    {"NoLengthOnTheWay",
     process_of("channel = \"turn\"\nprocess = \"correlated in distance\"\nsd = 0.01\n"),
     ":4: a process correlated in distance has no length, expected one (m)"},
    {"LengthOf0",
     process_of("channel = \"turn\"\nprocess = \"correlated in t\"\nsd = 0.01\nlength = 0\n"),
     ":8: length is 0, expected more than 0"},
    {"TailsTooHeavy", process_of("channel = \"turn\"\nprocess = \"white\"\nsd = 0.01\ntails = 2\n"),
     ":8: tails is 2, expected more than 2"},
    {"TurnOfAPass", process_of("channel = \"turn\"\nprocess = \"per pass\"\nsd = 0.01\n"),
     ":4: channel turn has no passes, expected lever, lever_left, range, range_scale, bearing or "
     "delay"},
    {"CompassOfAPass", process_of("channel = \"compass\"\nprocess = \"per pass\"\nsd = 0.01\n"),
     ":4: channel compass has no passes, expected lever, lever_left, range, range_scale, bearing "
     "or delay"},
    {"EffectTable", "[effect]\nname = \"x\"\n",
     ":1: effect is no list of tables, expected [[effect]]"},
    {"NamelessEffect", "[[effect]]\nchannel = \"turn\"\nshape = [\"1\"]\n",
     ":1: an effect has no name, expected name = \"...\""},
    {"HalfEffect", "[[effect]]\nname = \"x\"\nchannel = \"turn\"\n",
     ":1: effect \"x\" has a channel but no shape, expected both or neither"},
    {"Coefficients",
     "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = [\"1\", \"t\"]\ncoefficients = [1]\n",
     ":5: effect \"x\" has 1 coefficients, expected 2, one per shape"},
    {"Per", "[[effect]]\nname = \"x\"\nper = \"day\"\n",
     ":3: per is \"day\", expected \"session\""},
    {"EmptyShape", "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = [\" \"]\n",
     ":4: effect \"x\" has an empty shape, expected an expression"},
    {"SessionCoefficients",
     "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = [\"1\", \"t\"]\n"
     "coefficients = [1, 2, 3]\nper = \"session\"\n",
     ":5: effect \"x\" has 3 coefficients, expected 2, one per shape, per session"},
    {"NoShape", "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = []\n",
     ":4: effect \"x\" has no shape, expected one or more"},
    {"ShapeThatCannotBeRead",
     "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = [\n  \"1\",\n  \"sin(\"]\n",
     ":6: effect \"x\": shape \"sin(\" cannot be read: "},
    {"UnknownChannel", "[[effect]]\nname = \"x\"\nchannel = \"spin\"\nshape = [\"1\"]\n",
     ":3: effect \"x\": channel \"spin\" is unknown, expected one of travel, left,"},
    {"UnknownName", "\n[[effect]]\nname = \"ghosts\"\n",
     ":2: effect \"ghosts\" is not in the catalogue, expected a channel and a shape"},
    {"OpenName", "[[effect]]\nname = \"tyre drift\"\n",
     ":1: effect \"tyre drift\" needs a covariate, expected \"tyre drift (COLUMN)\""},
    {"CatalogueCoefficients", "[[effect]]\nname = \"slope\"\ncoefficients = [1]\n",
     ":3: effect \"slope\" has 1 coefficients, expected 2, one per shape"},
    {"ShapeText", "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = \"1\"\n",
     ":4: shape is no list, expected [ ... ]"},
};

INSTANTIATE_TEST_SUITE_P(EveryWay, BadModel, ::testing::ValuesIn(kBadModels),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(ModelToml, ReadsBackExactlyWhatItWrote) {
  const ScratchFolder scratch;
  Model out;
  out.robot.wheelbase = 1.0 / 3.0;
  out.noise.left = 0.1 + 0.2;
  out.noise.heading_per_rad = 1e-7;
  out.effects = {catalogue_effect("wheelbase"),
                 {"magnet \"in\" the \\ lights",
                  Channel::compass,
                  {"lights", "sin(heading)"},
                  {0.25, -1e-9},
                  false},
                 {"delay", Channel::delay, {"1"}, {0.1, 0.2}, true}};
  write_model(scratch.path() / "m.toml", out);
  const Model in = read_model(scratch.path() / "m.toml");
  EXPECT_EQ(in.robot.wheelbase, out.robot.wheelbase);
  EXPECT_EQ(in.noise.left, out.noise.left);
  EXPECT_EQ(in.noise.heading_per_rad, out.noise.heading_per_rad);
  EXPECT_EQ(in.noise.travel_per_s, 0.0);
  ASSERT_EQ(in.effects.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(in.effects[k].name, out.effects[k].name);
    EXPECT_EQ(in.effects[k].channel, out.effects[k].channel);
    EXPECT_EQ(in.effects[k].shape, out.effects[k].shape);
    EXPECT_EQ(in.effects[k].coefficients, out.effects[k].coefficients);
    EXPECT_EQ(in.effects[k].per_session, out.effects[k].per_session);
  }
}

/// Every kind of process, of channels in turn, with numbers of all digits.
TEST(ModelToml, PlacesOfSensorsComeBackBesideEveryDrive) {
  for (const DriveKind drive : {DriveKind::differential, DriveKind::wheels, DriveKind::ackermann}) {
    Model model;
    model.robot = usual_robot(drive);
    model.robot.mounted.sensor = Mounting{3.75, -0.1, 0.3};
    model.robot.mounted.antenna = Mounting{0.1 / 3.0, 0.0, 0.0};
    model.robot.mounted.scanner = Mounting{0.0, 0.0, -3.1};
    const ScratchFolder scratch;
    const Model back = read_model(scratch.write("m.toml", format_model(model)));
    EXPECT_EQ(back.robot.mounted, model.robot.mounted);
    EXPECT_FALSE(back.robot.mounted.tracked.has_value());
  }
}

TEST(ModelToml, NoiseProcessesComeBackToTheSameBits) {
  const ScratchFolder scratch;
  Model out;
  out.noise.processes = {{Channel::left, ProcessKind::white, 0.1 + 0.2, 0.0, 4.0 + 1.0 / 3.0},
                         {Channel::travel, ProcessKind::per_leg, 1.0 / 3.0},
                         {Channel::compass, ProcessKind::per_session, 1e-7},
                         {Channel::range, ProcessKind::per_pass, 0.05},
                         {Channel::bearing, ProcessKind::correlated_in_t, 0.02, 2.0 / 7.0},
                         {Channel::turn, ProcessKind::correlated_in_distance, 0.01, 1e5 / 3.0},
                         {Channel::drift, ProcessKind::walk_in_t, 1e-4 / 3.0},
                         {Channel::difference, ProcessKind::walk_in_distance, 0.003}};
  out.effects = {catalogue_effect("wheelbase")};
  write_model(scratch.path() / "m.toml", out);
  const Model in = read_model(scratch.path() / "m.toml");
  ASSERT_EQ(in.noise.processes.size(), out.noise.processes.size());
  for (std::size_t k = 0; k < in.noise.processes.size(); ++k) {
    const NoiseProcess& read = in.noise.processes[k];
    const NoiseProcess& written = out.noise.processes[k];
    EXPECT_EQ(read.channel, written.channel) << k;
    EXPECT_EQ(read.process, written.process) << k;
    EXPECT_EQ(read.sd, written.sd) << k;
    EXPECT_EQ(read.length, written.length) << k;
    EXPECT_EQ(read.tails, written.tails) << k;
    EXPECT_GT(read.line, k == 0 ? 0 : in.noise.processes[k - 1].line) << k;
  }
  ASSERT_EQ(in.effects.size(), 1U);
  EXPECT_EQ(in.noise.left, out.noise.left);
  EXPECT_EQ(format_model(in), format_model(out));
}

TEST(ModelToml, ANoiseProcessKnowsItsLineAndTheKeysComeInAnyOrder) {
  const ScratchFolder scratch;
  const auto file = scratch.write("m.toml",
                                  "[noise]\nleft = 0.01\n\n[[noise.process]]\nlength = 3\n"
                                  "sd = 0.02\nprocess = \"correlated in t\"\n"
                                  "channel = \"compass\"\n\n[[noise.process]]\n"
                                  "tails = 2.5\nsd = 1\nchannel = \"range\"\n"
                                  "process = \"white\"\n");
  const std::vector<NoiseProcess> read = read_model(file).noise.processes;
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].channel, Channel::compass);
  EXPECT_EQ(read[0].process, ProcessKind::correlated_in_t);
  EXPECT_EQ(read[0].sd, 0.02);
  EXPECT_EQ(read[0].length, 3.0);
  EXPECT_EQ(read[0].tails, 0.0);
  EXPECT_EQ(read[0].line, 4);
  EXPECT_EQ(read[1].channel, Channel::range);
  EXPECT_EQ(read[1].process, ProcessKind::white);
  EXPECT_EQ(read[1].length, 0.0);
  EXPECT_EQ(read[1].tails, 2.5);
  EXPECT_EQ(read[1].line, 10);
}

/// Without processes the file says nothing of them.
TEST(ModelToml, WithoutProcessesNoneAreWritten) {
  EXPECT_EQ(format_model(Model()).find("process"), std::string::npos);
}

/// Places, radii, thresholds and times of any digits, seed 5.
TEST(ModelToml, ShapeParametersComeBackToTheSameBits) {
  const ScratchFolder scratch;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> digits(-1.0, 1.0);
  std::uniform_int_distribution<int> size(-12, 12);
  const auto number = [&] { return digits(random) * std::pow(10.0, size(random)); };
  Model out;
  for (int k = 0; k < 200; ++k) {
    const std::string name = "e" + std::to_string(k);
    const Shape place("exp(-((x-{x})^2+(y-{y})^2)/(2*{r}^2))",
                      {{"x", number()}, {"y", number()}, {"r", std::abs(number())}});
    const Shape step("(1+sign(t-{t}))/2", {{"t", number()}});
    out.effects.push_back({name, Channel::creep, {place, step}, {number(), number()}});
    out.effects.push_back(catalogue_effect(
        *find_entry("missed ticks"), std::vector<ShapeParameter>{{"v0", std::abs(number())}}));
  }
  write_model(scratch.path() / "m.toml", out);
  const Model in = read_model(scratch.path() / "m.toml");
  ASSERT_EQ(in.effects.size(), out.effects.size());
  for (std::size_t k = 0; k < in.effects.size(); ++k) {
    EXPECT_EQ(in.effects[k].name, out.effects[k].name);
    EXPECT_EQ(in.effects[k].coefficients, out.effects[k].coefficients);
    ASSERT_EQ(in.effects[k].shape.size(), out.effects[k].shape.size());
    for (std::size_t i = 0; i < in.effects[k].shape.size(); ++i) {
      const Shape& written = out.effects[k].shape[i];
      EXPECT_FALSE(written.parameters().empty()) << written.text();
      EXPECT_EQ(in.effects[k].shape[i].parameters(), written.parameters()) << written.text();
    }
  }
  EXPECT_EQ(format_model(in), format_model(out));
}

TEST(ModelToml, ACatalogueNameAloneIsSpeltOut) {
  const ScratchFolder scratch;
  const auto file = scratch.write("m.toml", "[[effect]]\nname = \"hard iron\"\n");
  const Model model = read_model(file);
  ASSERT_EQ(model.effects.size(), 1U);
  EXPECT_EQ(model.effects[0].channel, Channel::compass);
  EXPECT_EQ(texts_of(model.effects[0].shape),
            (std::vector<std::string>{"sin(heading)", "cos(heading)"}));
  EXPECT_NE(format_model(model).find("channel = \"compass\"\nshape = [\"sin(heading)\""),
            std::string::npos);
}

/// A ring of landmarks with hostile names, numbers of all digits, seed 3.
LandmarkGraph hostile_map() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  LandmarkGraph map;
  for (const char* name : {"<script>alert(1)</script>", "a \"b\" & 'c'", "Tür ✓", "plain"}) {
    map.add_landmark(name, {normal(random), normal(random)});
  }
  map.set_covariance(2, (Matrix2() << 0.1, 1.0 / 3.0 * 0.1, 1.0 / 3.0 * 0.1, 0.2).finished());
  for (int k = 0; k < 4; ++k) {
    for (int t = 0; t <= k; ++t) {
      map.add_traversal(k, (k + 1) % 4,
                        {{normal(random) - 3.0, normal(random)},
                         (Matrix2() << 0.3, 0.1 / 3.0, 0.1 / 3.0, 0.7).finished()});
    }
  }
  return map;
}

TEST(MapGraphml, ReadsBackExactlyWhatItWrote) {
  const ScratchFolder scratch;
  const LandmarkGraph out = hostile_map();
  const LandmarkGraph in = read_map_graphml(scratch.write("m.graphml", format_map_graphml(out)));
  ASSERT_EQ(in.landmarks(), 4);
  ASSERT_EQ(in.routes(), 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(in.landmark(k).name, out.landmark(k).name);
    EXPECT_EQ(in.landmark(k).position, out.landmark(k).position);
    EXPECT_EQ(in.landmark(k).covariance, out.landmark(k).covariance);
    EXPECT_EQ(in.route(k).source, out.route(k).source);
    EXPECT_EQ(in.route(k).target, out.route(k).target);
    EXPECT_EQ(in.route(k).traversals, out.route(k).traversals);
    EXPECT_EQ(in.route(k).stretch, out.route(k).stretch);
    EXPECT_EQ(in.route(k).orientation, out.route(k).orientation);
    EXPECT_EQ(in.route(k).displacement, out.route(k).displacement);
    EXPECT_EQ(in.route(k).covariance, out.route(k).covariance);
  }
}

TEST(MapGraphml, ReadsWhatOthersWrite) {
  const ScratchFolder scratch;
  const LandmarkGraph map = read_map_graphml(scratch.write("m.graphml", R"(<?xml version="1.0"?>
<graphml><key id="d0" attr.name="x"/><key id="d1" for="node" attr.name="y"/>
<graph id="G" edgedefault="undirected"><desc>by hand</desc>
<node id="&#65;"><data key="d0"> 1.5
</data><data key="d1"><![CDATA[-2]]></data><data key="label">dock</data></node>
</graph></graphml>)"));
  ASSERT_EQ(map.landmarks(), 1);
  EXPECT_EQ(map.landmark(0).name, "A");
  EXPECT_EQ(map.landmark(0).position, Vector2(1.5, -2.0));
}

TEST(MapFormats, GeoJsonHoldsEveryLandmarkAndRoute) {
  const auto geojson = nlohmann::json::parse(format_geojson(hostile_map()));
  EXPECT_EQ(geojson["type"], "FeatureCollection");
  ASSERT_EQ(geojson["features"].size(), 8U);
  EXPECT_EQ(geojson["features"][0]["properties"]["landmark"], "<script>alert(1)</script>");
  EXPECT_EQ(geojson["features"][4]["geometry"]["type"], "LineString");
}

TEST(MapFormats, DotEscapesQuotes) {
  const std::string dot = format_dot(hostile_map());
  EXPECT_NE(dot.find("\"a \\\"b\\\" & 'c'\""), std::string::npos);
}

class BadMap : public ::testing::TestWithParam<Refused> {};

TEST_P(BadMap, IsRefused) {
  const ScratchFolder scratch;
  const auto file = scratch.write("m.graphml", GetParam().content);
  const std::string message = message_of(read_map_graphml, file);
  EXPECT_EQ(message.rfind(GetParam().message, 0), 0U) << message;
}

const std::string kTwoNodes =
    "<graphml><graph>\n<node id=\"A\"><data key=\"x\"> 0 </data><data key=\"y\">0</data></node>\n"
    "<node id=\"B\"><data key=\"x\">1</data><data key=\"y\">0</data></node>\n";

std::string nested(int deep) {
  std::string text;
  for (int k = 0; k < deep; ++k) text += "<g>";
  return text;
}

const Refused kBadMaps[] = {
    {"NoXml", "landmarks\n", ":1: no XML: "},
    {"NoGraph", "<graphml/>", ":1: no GraphML, expected a graphml element with a graph"},
    {"Directed", "<graphml><graph edgedefault=\"directed\"/></graphml>",
     ":1: the graph is directed, expected edgedefault=\"undirected\""},
    {"NoPosition", "<graphml><graph><node id=\"A\"/></graph></graphml>",
     ":1: landmark A: has no x, expected a number"},
    {"TextPosition",
     "<graphml><graph><node id=\"A\"><data key=\"x\">far</data><data key=\"y\">0</data></node>"
     "</graph></graphml>",
     ":1: landmark A: x is \"far\", expected a finite number"},
    {"UnknownEnd", "<graphml><graph>\n<edge source=\"A\" target=\"B\"/></graph></graphml>",
     ":2: route A - B: landmark A is unknown, expected a node"},
    {"MismatchedTags", "<graphml><graph>\n</graphml></graph>", ":2: no XML: mismatched tag"},
    {"CutOff", kTwoNodes, ":4: no XML: no element found"},
    {"BottomlessPit", nested(300000), ":1: elements are nested more than 100 deep"},
    {"NotUtf8", "<graphml><graph><node id=\"\xff\"/></graph></graphml>",
     ":1: no XML: not well-formed"},
    {"DirectedEdge",
     kTwoNodes + "<edge source=\"A\" target=\"B\" directed=\"true\"/></graph></graphml>",
     ":4: route A - B: is directed, expected undirected edges"},
    {"NegativeVariance",
     "<graphml><graph><node id=\"A\"><data key=\"x\">0</data><data key=\"y\">0</data>"
     "<data key=\"c_xx\">-1</data><data key=\"c_xy\">0</data><data key=\"c_yy\">1</data></node>"
     "</graph></graphml>",
     ":1: landmark A: c_xx, c_xy, c_yy are no covariance"},
};

INSTANTIATE_TEST_SUITE_P(EveryWay, BadMap, ::testing::ValuesIn(kBadMaps),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(ModelFile, DrivesComeBack) {
  const testing::ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "model.toml";
  const char* const texts[] = {
      "drive = \"skid-steer\"\nwheelbase = 0.5\ncolumns = [\"a\", \"b\", \"c\", \"d\"]\n",
      "drive = \"tricycle\"\nlength = 1.25\n",
      "drive = \"ackermann\"\nlength = 2.83\nwheel_left = 0.76\ncolumns = [\"v\", \"phi\"]\n",
      "drive = \"tricycle\"\nlength = 1.3\nsteer_left = -0.2\n",
      "drive = \"omni3\"\nradius = 0.195\n",
      "drive = \"mecanum\"\nwheelbase = 0.4\nlength = 0.5\n",
      "drive = \"wheels\"\ncolumns = [\"f\", \"s\", \"a\"]\n"
      "matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n",
      "drive = \"wheels\"\n[[robot.wheel]]\ncolumn = \"a\"\ny = 0.2\n"
      "[[robot.wheel]]\ncolumn = \"b\"\ny = -0.2\nx = 0.1\n"
      "[[robot.wheel]]\ncolumn = \"c\"\nx = -0.3\ndirection = 1.5\nroller = 0.1\n"};
  for (const char* const text : texts) {
    write_file(file, "[robot]\n" + std::string(text) + "\n[noise]\nwheel = 0.007\nsteer = 0.01\n");
    const Model out = read_model(file);
    EXPECT_EQ(out.noise.left, 0.007);
    EXPECT_EQ(out.noise.right, 0.007);
    write_model(file, out);
    const Model in = read_model(file);
    EXPECT_EQ(in.robot.drive, out.robot.drive) << text;
    EXPECT_EQ(in.robot.columns, out.robot.columns);
    EXPECT_EQ(in.robot.wheelbase, out.robot.wheelbase);
    EXPECT_EQ(in.robot.length, out.robot.length);
    EXPECT_EQ(in.robot.wheel_left, out.robot.wheel_left);
    EXPECT_EQ(in.robot.steer_left, out.robot.steer_left);
    EXPECT_TRUE(in.robot.matrix == out.robot.matrix);
    EXPECT_EQ(in.noise.steer, 0.01);
    EXPECT_NEAR(in.noise.left, 0.007, 1e-17);
  }
}

}  // namespace
}  // namespace trussmap::model_and_map_test
