// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Files that nobody writes by mistake: each is refused in words, at no cost.
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <lzma.h>

namespace trussmap::hostile_input_test {
namespace {

using testing::ScratchFolder;

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

std::string model_refusal(const std::string& text) {
  const ScratchFolder scratch;
  scratch.write("m.toml", text);
  return refusal([&] { static_cast<void>(read_model(scratch.path() / "m.toml")); });
}

std::string graphml_refusal(const std::string& nodes, const std::string& head = "") {
  const ScratchFolder scratch;
  scratch.write("m.graphml",
                "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + head +
                    "<graphml><key id=\"x\" for=\"node\" attr.name=\"x\" attr.type=\"double\"/>"
                    "<key id=\"y\" for=\"node\" attr.name=\"y\" attr.type=\"double\"/>\n"
                    "<graph edgedefault=\"undirected\">" +
                    nodes + "</graph></graphml>\n");
  return refusal([&] { static_cast<void>(read_map_graphml(scratch.path() / "m.graphml")); });
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(HostileInput, WhatTheTomlParserOnlyAsserts) {
  EXPECT_TRUE(holds(model_refusal("[.a]\n"), "no TOML")) << model_refusal("[.a]\n");
  EXPECT_TRUE(holds(model_refusal("\u0436 = 1\n"), ":1: no TOML"));
  EXPECT_TRUE(holds(model_refusal("[robot]\n\u65e5x = 3\n"), ":2: no TOML"));
}

TEST(HostileInput, NumbersThatOverflow) {
  EXPECT_TRUE(holds(model_refusal("[[effect]]\nname = \"wheelbase\"\ncoefficients = [1e300]\n"),
                    ":3: a coefficient is 1e+300, expected at most 1e12 in size"))
      << model_refusal("[[effect]]\nname = \"wheelbase\"\ncoefficients = [1e300]\n");
  const std::string ids = refusal(
      [] { static_cast<void>(parse_g2o("LANDMARK 0 9223372036854775807 1 1 9 0 9\n", "g")); });
  EXPECT_TRUE(holds(ids, "g:1: ")) << ids;
}

TEST(HostileInput, ANegativeZeroComesBackAsItWasWritten) {
  const ScratchFolder scratch;
  scratch.write("m.toml", "[[effect]]\nname = \"wheelbase\"\ncoefficients = [-0.0]\n");
  const std::string once = format_model(read_model(scratch.path() / "m.toml"));
  scratch.write("again.toml", once);
  EXPECT_EQ(format_model(read_model(scratch.path() / "again.toml")), once);
}

TEST(HostileInput, ACovarianceWithoutAnEnd) {
  const std::string said = graphml_refusal(
      "<node id=\"A\"><data key=\"x\">0</data><data key=\"y\">0</data>"
      "<data key=\"c_xx\">1</data><data key=\"c_xy\">0</data></node>");
  EXPECT_TRUE(holds(said, "landmark A: has no c_yy")) << said;
}

/// Limits that go when the test does.
class Limits {
 public:
  explicit Limits(const ReadLimits& limits) : before_(read_limits()) { set_read_limits(limits); }
  ~Limits() { set_read_limits(before_); }
  Limits(const Limits&) = delete;
  Limits& operator=(const Limits&) = delete;

 private:
  ReadLimits before_;
};

std::string nested(int depth) {
  std::string text;
  for (int k = 0; k < depth; ++k) text += "<desc>";
  for (int k = 0; k < depth; ++k) text += "</desc>";
  return text;
}

TEST(HostileInput, ElementsWithinElements) {
  const std::string said = graphml_refusal(nested(200));
  EXPECT_TRUE(holds(said, "nested more than 100 deep")) << said;
  EXPECT_TRUE(holds(said, "--max-nesting")) << said;
  const Limits more({0, 300});
  EXPECT_FALSE(holds(graphml_refusal(nested(200)), "nested"));
  EXPECT_TRUE(holds(graphml_refusal(nested(300)), "nested more than 300 deep"));
  EXPECT_THROW(set_read_limits({0, 0}), std::invalid_argument);
  EXPECT_EQ(read_limits().nesting, 300);
}

TEST(HostileInput, AFileThatIsTooLargeAsItIs) {
  const ScratchFolder scratch;
  const auto file = scratch.write("f", std::string((std::size_t{1} << 20U) + 1, 'a'));
  EXPECT_EQ(read_file(file).size(), (std::size_t{1} << 20U) + 1);
  const Limits one({std::size_t{1} << 20U, 100});
  const std::string said = refusal([&] { static_cast<void>(read_file(file)); });
  EXPECT_TRUE(holds(said, "is more than 1 MiB; allow more with --max-input-mib")) << said;
  scratch.write("f", std::string(std::size_t{1} << 20U, 'a'));
  EXPECT_EQ(read_file(file).size(), std::size_t{1} << 20U);
}

TEST(HostileInput, DefaultsThatMultiply) {
  std::string nodes;
  for (int k = 0; k < 2000; ++k) nodes += "<node/>";
  const std::string head =
      "<!DOCTYPE graphml [<!ATTLIST node kind CDATA \"" + std::string(20000, 'a') + "\">]>\n";
  const std::string said = graphml_refusal(nodes, head);
  EXPECT_TRUE(holds(said,
                    "grow to more than 16 MiB and 10 times their size; allow more with "
                    "--max-input-mib"))
      << said;
}

TEST(HostileInput, AnXzFileThatGrows) {
  const std::string zeros(std::size_t{80} << 20U, '0');
  std::vector<std::uint8_t> bytes(lzma_stream_buffer_bound(zeros.size()));
  std::size_t size = 0;
  ASSERT_EQ(lzma_easy_buffer_encode(0, LZMA_CHECK_CRC32, nullptr,
                                    reinterpret_cast<const std::uint8_t*>(zeros.data()),
                                    zeros.size(), bytes.data(), &size, bytes.size()),
            LZMA_OK);
  const ScratchFolder scratch;
  scratch.write("runs.csv.xz", std::string(bytes.begin(), bytes.begin() + static_cast<long>(size)));
  const std::string said =
      refusal([&] { static_cast<void>(read_file(scratch.path() / "runs.csv.xz")); });
  EXPECT_TRUE(holds(said,
                    "grow to more than 64 MiB and 200 times their size; allow more with "
                    "--max-input-mib"))
      << said;
  {
    const Limits enough({std::size_t{80} << 20U, 100});
    EXPECT_EQ(read_file(scratch.path() / "runs.csv.xz"), zeros);
  }
  const Limits less({std::size_t{79} << 20U, 100});
  const std::string again =
      refusal([&] { static_cast<void>(read_file(scratch.path() / "runs.csv.xz")); });
  EXPECT_TRUE(holds(again, "grow to more than 79 MiB; allow")) << again;
}

TEST(HostileInput, NamesThatCommandATerminal) {
  for (const std::string name :
       {"a\x1B[31m", "a\u202Eb", "a\u0085", "a\u2066", "a\uFFFE", "a\x7F"}) {
    const ScratchFolder scratch;
    scratch.write("drive.csv", "t,left,right\n1,1,1\n2,1,1\n");
    scratch.write("sightings.csv", "t,landmark\n1," + name + "\n");
    const std::string said = refusal([&] { static_cast<void>(read_recording(scratch.path())); });
    EXPECT_TRUE(holds(said, "sightings.csv:2: a landmark's name holds a control character"))
        << escaped_controls(said);
    if (name == "a\x1B[31m" || name == "a\uFFFE") {
      continue;  // XML cannot hold them: Expat says so
    }
    const std::string map = graphml_refusal("<node id=\"" + name + "\"/>");
    EXPECT_TRUE(holds(map, "a node's id holds a control character")) << escaped_controls(map);
  }
  EXPECT_TRUE(holds(model_refusal("[[effect]]\nname = \"a\\u202E\"\nchannel = \"turn\"\n"
                                  "shape = [\"1\"]\n"),
                    ":2: name holds a control character"));
}

TEST(HostileInput, ControlsAreEscapedForTheEye) {
  EXPECT_EQ(escaped_controls("Stra\u00DFe \u65E5\u672C \U0001F916"),
            "Stra\u00DFe \u65E5\u672C \U0001F916");
  EXPECT_EQ(escaped_controls("a\x1B[31mb\n"), "a\\x1B[31mb\\x0A");
  EXPECT_EQ(escaped_controls("a\nb", true), "a\nb");
  EXPECT_EQ(escaped_controls("\u202Eabc\u009B"), "\\u{202E}abc\\x9B");
  EXPECT_EQ(escaped_controls("\xC0\xAF\xF5"), "\\xC0\\xAF\\xF5");
}

}  // namespace
}  // namespace trussmap::hostile_input_test
