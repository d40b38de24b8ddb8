// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What calls take: recordings and a model, from objects or from files, and what of them to use.
#pragma once

#include "trussmap/session.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

namespace trussmap::python {

namespace py = pybind11;

/// One recording or several, in memory or in folders; a model, in memory or in a file.
struct Given {
  std::vector<std::shared_ptr<const Recording>> held;  ///< nullptr: to be read from its folder
  std::vector<std::filesystem::path> folders;          ///< beside each of them; may be empty
  std::optional<Model> model;
  std::filesystem::path model_file;
};

/// TypeError on anything else; `model` may be None where `may_lack`.
[[nodiscard]] Given given(py::handle recordings, py::handle model, bool may_lack = false);

/// Read.
struct Read {
  std::vector<Recording> recordings;  ///< as they are in their files
  Model model;
  std::string model_name;  ///< for messages
};

/// Touches no Python.
[[nodiscard]] Read read(const Given& given);

/// Read, checked and prepared for a fit.
struct Prepared {
  std::shared_ptr<Session> session;
  std::vector<std::string> mistakes;  ///< what check_recordings finds, in words
  std::string subject;                ///< recordings and model, for a page

  [[nodiscard]] const std::vector<DrivenRecording>& recordings() const {
    return session->rows.recordings;
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return session->rows.notes; }
  [[nodiscard]] const Model& model() const { return session->model; }
};

/// What these options are, for docstrings.
inline constexpr const char* kUseDoc =
    "\n\n`without`: of \"survey\", \"truth\", \"fixes\", \"loops\" what is not used. `exclude`: "
    "times "
    "[s] that are left out, pairs (from, to), of several recordings such a list for each. `gate`: "
    "standard deviations beyond which sightings, fixes and loops are left out that all others "
    "contradict; 0: none. `every` [s]: one frame of sightings in so many; 0: all; None: as long as "
    "their errors are found to last. `holdout`: share of the legs by which the model is judged. "
    "`min_drive` [m]: shortest leg between two landmarks. `leg` [m]: length of one where there is "
    "truth, or fixes, but no landmark. `level`: of significance. `progress`: a function of the "
    "step's name and the share of the call that is done.";

/// ValueError on what is out of range, or a name in `without` that is none.
[[nodiscard]] SessionOptions use_options(const std::vector<std::string>& without, double gate,
                                         std::optional<double> every, double holdout,
                                         double min_drive, double leg, double level);

/// Times that a fit leaves out: of one recording pairs (from, to) [s], of several a list of such
/// lists, one per recording; None: none. TypeError, ValueError on another form.
[[nodiscard]] std::vector<std::vector<TimeSpan>> excluded_of(py::handle exclude,
                                                             std::size_t recordings);

/// Touches no Python. std::invalid_argument where times to leave out are none of the recording's.
[[nodiscard]] Prepared prepared(const Given& given, const SessionOptions& use);

/// As Python warnings, of the category trussmap.RecordingWarning.
void warn(const std::vector<std::string>& mistakes);

/// "a, b and 3 more with model.toml".
[[nodiscard]] std::string subject_of(const Given& given);

/// The text without its last end of line, which print adds.
[[nodiscard]] std::string for_print(std::string text);

}  // namespace trussmap::python
