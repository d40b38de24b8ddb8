// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// check.
#include "results/checks.hpp"

#include "calls.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "rows.hpp"
#include "trussmap/check.hpp"
#include "trussmap/texts.hpp"

#include <utility>

namespace trussmap::python {
namespace {

struct CheckResult {
  std::vector<CheckFinding> findings;
};

CheckResult run_check(const py::object& recordings, const py::object& model) {
  const Given given = python::given(recordings, model, true);
  const bool has_model = !model.is_none();
  return unlocked([&] {
    const Read input = read(given);
    return CheckResult{check_read_recordings(input.recordings, has_model ? &input.model : nullptr,
                                             has_model ? input.model_name : "")};
  });
}

}  // namespace

void add_check(py::module_& module) {
  RowClass<CheckFinding>(module, "CheckFinding");
  py::class_<CheckResult>(module, "Check", "Mistakes of meaning in recordings.")
      .def_property_readonly(
          "findings", [](const CheckResult& self) { return py::tuple(py::cast(self.findings)); },
          "By recording, the columns of drives first.")
      .def("__len__", [](const CheckResult& self) { return self.findings.size(); })
      .def(
          "table", [](const CheckResult& self) { return table_of(self.findings); },
          "A list of dicts.")
      .def("__str__", [](const CheckResult& self) { return for_print(check_text(self.findings)); })
      .def("__repr__", [](const CheckResult& self) {
        return "<trussmap.Check: " + std::to_string(self.findings.size()) + " findings>";
      });
  module.def("check", run_check, py::arg("recordings"), py::arg("model") = py::none(),
             doc("Looks for mistakes in recordings: units, signs, axes, names, clocks.",
                 "check_recordings")
                 .c_str());
}

}  // namespace trussmap::python
