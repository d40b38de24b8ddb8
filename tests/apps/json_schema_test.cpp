// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The schema of what commands write with --json. Every test that runs the command holds what was
// written against it (scratch_folder.hpp); here, that this can fail, that no command is left out,
// and that no key that readers depend on is.
#include "json_schema.hpp"

#include "json_file.hpp"
#include "scratch_folder.hpp"

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::json_schema_test {
namespace {

using nlohmann::json;
using testing::against_schema;
using testing::definition_for;
using testing::json_file_of;
using testing::run_trussmap;
using testing::ScratchFolder;

/// A mesh of 4 x 4 with a hidden wheelbase error, and its commands.
class JsonSchema : public ::testing::Test {
 protected:
  JsonSchema() {
    run("simulate --mesh 4x4 --spacing 5 --tours 2 --seed 3 --effect wheelbase=0.02 --out " +
        robot_);
  }

  json run(const std::string& arguments) {
    const auto ran = run_trussmap(arguments + " --json " + file_);
    EXPECT_EQ(ran.status, 0) << arguments << "\n" << ran.output;
    return testing::read_json(file_);
  }

  /// A command that takes recordings and a model.
  json judge(const std::string& command, const std::string& options = "") {
    return run(fmt::format("{0} {1} --model {1}/model.toml {2}", command, robot_, options));
  }

  const ScratchFolder folder_;
  const std::string robot_ = folder_.path() / "robot";
  const std::string file_ = folder_.path() / "written.json";
};

TEST(JsonSchemaOfACall, IsThatOfItsCommand) {
  EXPECT_EQ(definition_for("diagnose a --model m.toml"), "diagnose");
  EXPECT_EQ(definition_for("fleet report f.db"), "fleet-report");
  EXPECT_EQ(definition_for("build a --store 'my maps.db' --json x"), "build-store");
  EXPECT_EQ(definition_for("adjust a.g2o --solver=petsc"), "adjust-solver");
  EXPECT_EQ(definition_for("adjust a.g2o --solver frontal"), "adjust");
  EXPECT_EQ(json_file_of("diagnose a --json \"my file.json\""), "my file.json");
  EXPECT_EQ(json_file_of("diagnose a --json=b.json --model c"), "b.json");
  EXPECT_EQ(json_file_of("diagnose a"), "");
}

TEST_F(JsonSchema, HasEveryCommandThatWritesJson) {
  const json schema = json::parse(run_trussmap("schema").output);
  const std::regex line(R"(\n  ([a-z]+) )");
  const std::string all = run_trussmap("--help").output;
  std::size_t with_json = 0;
  for (std::sregex_iterator at(all.begin(), all.end(), line), end; at != end; ++at) {
    const std::string name = (*at)[1];
    const std::string command = name == "fleet" ? "fleet report" : name;
    if (run_trussmap(command + " --help").output.find("\n  --json FILE") == std::string::npos)
      continue;
    ++with_json;
    EXPECT_TRUE(schema["definitions"].contains(definition_for(command))) << command;
  }
  EXPECT_GE(with_json, 16U);
}

/// Every key below a schema, as json_keys.txt has it.
void add_keys(const json& schema, const json& definitions, const std::string& at,
              std::set<std::string>& keys) {
  if (const auto ref = schema.find("$ref"); ref != schema.end()) {
    const auto name = ref->get<std::string>();
    add_keys(definitions.at(name.substr(name.rfind('/') + 1)), definitions, at, keys);
  }
  for (const char* parts : {"allOf", "anyOf"}) {
    const json list = schema.value(parts, json::array());
    for (const json& part : list) {
      add_keys(part, definitions, at, keys);
    }
  }
  const json properties = schema.value("properties", json::object());
  for (const auto& [key, value] : properties.items()) {
    keys.insert(at + "." + key);
    add_keys(value, definitions, at + "." + key, keys);
  }
  if (schema.contains("items")) add_keys(schema["items"], definitions, at, keys);
  if (schema.contains("additionalProperties")) {
    add_keys(schema["additionalProperties"], definitions, at + ".*", keys);
  }
}

TEST_F(JsonSchema, HasEveryKeyThatReadersDependOn) {
  const json definitions = json::parse(run_trussmap("schema").output).at("definitions");
  std::set<std::string> keys;
  for (const auto& [name, schema] : definitions.items()) {
    add_keys(schema, definitions, name, keys);
  }
  std::ifstream promised(TRUSSMAP_SOURCE_DIR "/tests/apps/json_keys.txt");
  std::size_t read = 0;
  for (std::string line; std::getline(promised, line);) {
    if (line.starts_with('#')) continue;
    ++read;
    EXPECT_TRUE(keys.contains(line)) << line;
  }
  EXPECT_GE(read, 480U);
}

TEST_F(JsonSchema, RefusesWhatIsNotAsDescribed) {
  json good = judge("compare");
  EXPECT_TRUE(against_schema(good, "compare").empty());
  json text = good;
  text["chi2"] = "a lot";
  json missing = good;
  missing.erase("dof");
  json verdict = good;
  verdict["verdict"] = "fine";
  json deep = good;
  deep["worst"][0]["dof"] = 1.5;
  json new_key = good;
  new_key["routes"][0]["colour"] = "red";
  for (const json& bad : {text, missing, verdict, deep, new_key}) {
    EXPECT_FALSE(against_schema(bad, "compare").empty()) << bad.dump().substr(0, 400);
  }
  EXPECT_EQ(against_schema(new_key, "compare"),
            std::vector<std::string>{"/routes/0/colour is not in the schema"});
  EXPECT_FALSE(against_schema(good, "diagnose").empty());
}

// What other tests do not run: run_trussmap holds it against the schema.
TEST_F(JsonSchema, HasWhatCriticismWrites) {
  const json diagnosis = judge("diagnose");
  EXPECT_EQ(diagnosis.at("missing"), "wheelbase");
  EXPECT_TRUE(judge("diagnose", "--stated-noise").at("noise_estimated").is_null());
  EXPECT_EQ(judge("discover").at("steps").at(1).at("added").at("effect"), "wheelbase");
  EXPECT_TRUE(judge("fit", "--noise").contains("noise"));
}

TEST_F(JsonSchema, HasWhatMapsAndGraphsWrite) {
  for (const std::string method : {"adjustment", "elastic", "elastic-printed", "gauss-markov"}) {
    const json built = judge("build", "--method " + method);
    EXPECT_EQ(built.at("method"), method);
    EXPECT_TRUE(built.contains("survey"));
  }
  const auto graph =
      folder_.write("square.g2o",
                    "EDGE_SE2 0 1 1 0 1.5708 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 1.5708 1 0 0 1 0 1\n"
                    "EDGE_SE2 2 3 1 0 1.5708 1 0 0 1 0 1\nEDGE_SE2 3 0 1 0 1.5708 1 0 0 1 0 1\n"
                    "EDGE_SE2 0 2 9 9 0 1 0 0 1 0 1\n");
  EXPECT_EQ(run("adjust --robust " + graph.string()).at("left_out"), json::array({{0, 2}}));
}

TEST_F(JsonSchema, HasWhatCalibrationsWrite) {
  EXPECT_TRUE(judge("calibrate").at("E_b").is_number());
  EXPECT_EQ(run("umbmark --simulate --true-E-b 1.02 --seed 1").at("rounds").size(), 1U);
  EXPECT_EQ(run("noise --simulate --true-k-left 0.0005 --true-k-right 0.0005 --seed 1").at("path"),
            "10,-10");
  // A wheel without noise of its own: k is 0, and its standard error does not exist.
  EXPECT_TRUE(run("noise --simulate --true-k-right 0.0005 --scatter 0.001 --sensor-sd "
                  "0.002,0.002,0 --seed 1")
                  .at("sd_k_left")
                  .is_null());
}

}  // namespace
}  // namespace trussmap::json_schema_test
