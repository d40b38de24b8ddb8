// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/model_toml.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/workbench.hpp"
#include "trussmap/write_files.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap {
namespace {

using nlohmann::ordered_json;
using Kind = WorkbenchStep::Kind;

constexpr const char* kFormat = "trussmap workbench 1";
constexpr std::array<std::pair<Kind, const char*>, 5> kKinds{{{Kind::given, "given"},
                                                              {Kind::add, "add"},
                                                              {Kind::remove, "remove"},
                                                              {Kind::exclude, "exclude"},
                                                              {Kind::include, "include"}}};

const char* name_of(Kind kind) {
  return kKinds.at(static_cast<std::size_t>(kind)).second;
}

Kind kind_named(const std::string& name, const std::string& file) {
  for (const auto& [kind, known] : kKinds) {
    if (name == known) return kind;
  }
  throw InputError(
      file, 0,
      "no step is of the kind \"" + name + "\", expected given, add, remove, exclude or include");
}

ordered_json fingerprints_of(const std::vector<DrivenRecording>& recordings) {
  ordered_json list = ordered_json::array();
  for (const DrivenRecording& one : recordings) list.push_back(fingerprint(one));
  return list;
}

ordered_json json_of_step(const WorkbenchStep& step) {
  ordered_json result = {{"kind", name_of(step.kind)},
                         {"effect", step.effect},
                         {"from", step.from},
                         {"arrival_rms", step.arrival_rms},
                         {"expected_rms", step.expected_rms},
                         {"chi2", step.chi2},
                         {"dof", step.dof},
                         {"model", format_model(step.model)}};
  if (step.predicted_rms) result["predicted_rms"] = *step.predicted_rms;
  if (!step.label.empty()) result["label"] = step.label;
  for (const Effect& one : step.could_be) {
    result["could_be"].push_back(
        {{"name", one.name}, {"channel", name_of(one.channel)}, {"shape", texts_of(one.shape)}});
  }
  if (!step.excluded.empty()) {
    ordered_json& recordings = result["excluded"] = ordered_json::array();
    for (const std::vector<TimeSpan>& spans : step.excluded) {
      ordered_json& list = recordings.emplace_back(ordered_json::array());
      for (const TimeSpan& span : spans) list.push_back({span.from, span.to});
    }
    result["excluded_legs"] = step.excluded_legs;
  }
  return result;
}

std::vector<std::vector<TimeSpan>> excluded_of(const ordered_json& json, std::size_t recordings,
                                               const std::string& file) {
  std::vector<std::vector<TimeSpan>> result;
  for (const ordered_json& list : json) {
    std::vector<TimeSpan>& spans = result.emplace_back();
    for (const ordered_json& span : list) {
      spans.push_back({span.at(0).get<double>(), span.at(1).get<double>()});
    }
  }
  if (result.size() > recordings) {
    throw InputError(file, 0,
                     fmt::format("times are excluded of {} recordings, of which there are {}",
                                 result.size(), recordings));
  }
  return result;
}

WorkbenchStep step_of(const ordered_json& json, std::size_t number, std::size_t recordings,
                      const std::string& file) {
  WorkbenchStep step;
  step.kind = kind_named(json.at("kind").get<std::string>(), file);
  step.effect = json.at("effect").get<std::string>();
  step.from = json.at("from").get<std::size_t>();
  step.arrival_rms = json.at("arrival_rms").get<double>();
  step.expected_rms = json.at("expected_rms").get<double>();
  step.chi2 = json.at("chi2").get<double>();
  step.dof = json.at("dof").get<int>();
  if (json.contains("predicted_rms")) step.predicted_rms = json.at("predicted_rms").get<double>();
  step.label = json.value("label", "");
  for (const ordered_json& one : json.value("could_be", ordered_json::array())) {
    Effect effect;
    effect.name = one.at("name").get<std::string>();
    effect.channel = channel_named(one.at("channel").get<std::string>());
    for (const ordered_json& shape : one.at("shape"))
      effect.shape.emplace_back(shape.get<std::string>());
    step.could_be.push_back(std::move(effect));
  }
  if (json.contains("excluded")) {
    step.excluded = excluded_of(json.at("excluded"), recordings, file);
    step.excluded_legs = json.at("excluded_legs").get<std::size_t>();
  }
  step.model = io::model_from_text(json.at("model").get<std::string>(),
                                   fmt::format("{}, model of step {}", file, number));
  return step;
}

}  // namespace

std::string format_workbench_log(const WorkbenchLog& log,
                                 const std::vector<DrivenRecording>& recordings) {
  ordered_json steps = ordered_json::array();
  for (const WorkbenchStep& step : log.steps) steps.push_back(json_of_step(step));
  const ordered_json whole = {{"format", kFormat},
                              {"recordings", fingerprints_of(recordings)},
                              {"at", log.at},
                              {"steps", std::move(steps)}};
  return whole.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

WorkbenchLog read_workbench_log(const std::filesystem::path& path,
                                const std::vector<DrivenRecording>& recordings) {
  const std::string file = path.string();
  try {
    const ordered_json whole = ordered_json::parse(read_file(path));
    if (whole.at("format") != kFormat) {
      throw InputError(file, 0,
                       fmt::format("no log of a workbench, expected the format \"{}\"", kFormat));
    }
    if (whole.at("recordings") != fingerprints_of(recordings)) {
      throw InputError(
          file, 0, "the work was done on other recordings, expected the same in the same order");
    }
    WorkbenchLog log;
    for (const ordered_json& one : whole.at("steps")) {
      log.steps.push_back(step_of(one, log.steps.size(), recordings.size(), file));
      const WorkbenchStep& step = log.steps.back();
      if (log.steps.size() == 1 ? step.from != 0 : step.from >= log.steps.size() - 1) {
        throw InputError(file, 0,
                         fmt::format("step {} comes from none before it", log.steps.size() - 1));
      }
    }
    log.at = whole.at("at").get<std::size_t>();
    if (log.at >= log.steps.size()) {
      throw InputError(file, 0, fmt::format("is at step {}, of {}", log.at, log.steps.size()));
    }
    return log;
  } catch (const ordered_json::exception&) {
    throw InputError(file, 0,
                     "no log of a workbench: a value is missing or of a wrong kind, expected it as "
                     "trussmap serve wrote it");
  }
}

}  // namespace trussmap
