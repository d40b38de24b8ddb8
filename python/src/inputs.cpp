// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "inputs.hpp"

#include "arrays.hpp"
#include "trussmap/check.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::python {
namespace {

bool is_path(py::handle value) {
  return py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__");
}

void add(Given& given, py::handle recording) {
  if (py::isinstance<Recording>(recording)) {
    given.held.push_back(recording.cast<std::shared_ptr<Recording>>());
    given.folders.emplace_back();
  } else if (is_path(recording)) {
    given.held.push_back(nullptr);
    given.folders.push_back(recording.cast<std::filesystem::path>());
  } else {
    throw py::type_error("recordings: expected a Recording, a folder's path, or a list of these");
  }
}

std::string name_of_recording(const Given& given, std::size_t k) {
  return given.held[k] ? given.held[k]->name : given.folders[k].string();
}

void require(bool right, const char* what) {
  if (!right) throw py::value_error(what);
}

TimeSpan span_of(py::handle pair) {
  const std::vector<double> times = numbers(pair, "exclude");
  if (times.size() != 2 || !(times[0] < times[1])) {
    throw py::value_error("exclude: " + py::repr(pair).cast<std::string>() +
                          ", expected (from, to) in s, the earlier first");
  }
  return {times[0], times[1]};
}

std::vector<TimeSpan> spans_of(py::handle spans) {
  std::vector<TimeSpan> result;
  for (const py::handle one : py::iter(spans)) result.push_back(span_of(one));
  return result;
}

}  // namespace

Given given(py::handle recordings, py::handle model, bool may_lack) {
  Given result;
  if (py::isinstance<Recording>(recordings) || is_path(recordings)) {
    add(result, recordings);
  } else {
    if (!py::isinstance<py::iterable>(recordings)) add(result, recordings);  // throws
    for (const py::handle one : py::iter(recordings)) add(result, one);
  }
  require(!result.held.empty(), "recordings: expected one at least");
  if (py::isinstance<Model>(model)) {
    result.model = model.cast<Model>();
  } else if (is_path(model)) {
    result.model_file = model.cast<std::filesystem::path>();
  } else if (!(may_lack && model.is_none())) {
    throw py::type_error("model: expected a Model or a file's path");
  }
  return result;
}

Read read(const Given& given) {
  Read result;
  for (std::size_t k = 0; k < given.held.size(); ++k) {
    result.recordings.push_back(given.held[k] ? *given.held[k] : read_recording(given.folders[k]));
  }
  result.model_name = "model";
  if (given.model) {
    result.model = *given.model;
  } else if (!given.model_file.empty()) {
    result.model = read_model(given.model_file, result.recordings);
    result.model_name = given.model_file.string();
  }
  return result;
}

SessionOptions use_options(const std::vector<std::string>& without, double gate,
                           std::optional<double> every, double holdout, double min_drive,
                           double leg, double level) {
  require(gate >= 0.0, "gate: expected 0 (none) or more standard deviations");
  require(!every || *every >= 0.0, "every: expected 0 (all frames) or more seconds");
  require(holdout >= 0.0 && holdout <= 0.9, "holdout: expected a share from 0 to 0.9");
  require(min_drive >= 0.0, "min_drive: expected 0 or more metres");
  require(leg > 0.0, "leg: expected more than 0 metres");
  require(level >= 1e-6 && level <= 0.5, "level: expected a level from 1e-6 to 0.5");
  SessionOptions use;
  use.fit = gated_fit(gate);
  for (const std::string& one : without) {
    bool* used = one == "survey"  ? &use.fit.use_survey
                 : one == "truth" ? &use.fit.use_truth
                 : one == "fixes" ? &use.fit.use_fixes
                 : one == "loops" ? &use.fit.use_loops
                                  : nullptr;
    if (used == nullptr) {
      throw py::value_error("without: \"" + one + "\" is none of survey, truth, fixes and loops");
    }
    *used = false;
  }
  use.legs = {min_drive, leg, holdout};
  use.every = every;
  use.level = level;
  return use;
}

std::vector<std::vector<TimeSpan>> excluded_of(py::handle exclude, std::size_t recordings) {
  if (exclude.is_none() || py::len(exclude) == 0) return {};
  if (recordings == 1) return {spans_of(exclude)};
  std::vector<std::vector<TimeSpan>> result;
  require(py::len(exclude) == recordings,
          "exclude: expected a list of (from, to) for each of the recordings");
  for (const py::handle one : py::iter(exclude)) result.push_back(spans_of(one));
  return result;
}

Prepared prepared(const Given& given, const SessionOptions& use) {
  Read input = read(given);
  Prepared result;
  result.session = std::make_shared<Session>(
      open_session(with_wheels(input.recordings, input.model.robot), input.model, use));
  for (const CheckFinding& one :
       check_read_recordings(input.recordings, &input.model, input.model_name)) {
    result.mistakes.push_back(in_words(one));
  }
  result.subject = subject_of(given);
  return result;
}

void warn(const std::vector<std::string>& mistakes) {
  if (mistakes.empty()) return;
  const py::object category = py::module_::import("trussmap").attr("RecordingWarning");
  for (const std::string& one : mistakes) {
    if (PyErr_WarnEx(category.ptr(), one.c_str(), 1) < 0) throw py::error_already_set();
  }
}

std::string subject_of(const Given& given) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(given.held.size(), kNamed); ++k) {
    text += (k > 0 ? ", " : "") + name_of_recording(given, k);
  }
  if (given.held.size() > kNamed) {
    text += " and " + std::to_string(given.held.size() - kNamed) + " more";
  }
  return text + (given.model_file.empty() ? "" : " with " + given.model_file.string());
}

std::string for_print(std::string text) {
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace trussmap::python
