// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fleets: a row per robot and day, their store, and what they say together.
#include "arrays.hpp"
#include "calls.hpp"
#include "fits.hpp"
#include "parts.hpp"
#include "results.hpp"
#include "results/fleet.hpp"
#include "rows.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/wording.hpp"

#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

FleetRow row_of(const std::string& robot, const py::object& date, const py::object& recordings,
                const py::object& model, const std::map<std::string, std::string>& metadata,
                const std::vector<std::string>& without, const py::object& exclude, double gate,
                std::optional<double> every, double holdout, double min_drive, double leg) {
  if (robot.empty()) throw py::value_error("robot: expected a name");
  const Given given = python::given(recordings, model);
  SessionOptions use = use_options(without, gate, every, holdout, min_drive, leg, kSignificance);
  use.fit.excluded = excluded_of(exclude, given.held.size());
  const std::string day = py::str(date).cast<std::string>();  // a datetime.date, too
  const Prepared input = unlocked([&] { return prepared(given, use); });
  warn(input.mistakes);
  return unlocked([&] {
    FleetRow row = fleet_row(robot, day, input.recordings(), input.model(),
                             format_model(input.model()), use.fit, use.legs);
    row.metadata = metadata;
    return row;
  });
}

struct FleetResult {
  FleetReport found;
  std::string subject;
};

/// Of a store, or of rows.
FleetResult run_report(const py::object& rows, double level) {
  if (!(level > 0.0 && level < 1.0)) throw py::value_error("level: expected more than 0, below 1");
  FleetResult result;
  if (py::isinstance<py::str>(rows) || py::hasattr(rows, "__fspath__")) {
    const fs::path store = rows.cast<fs::path>();
    result.subject = store.string();
    result.found = unlocked([&] { return fleet_report(read_fleet(store), level); });
  } else {
    std::vector<FleetRow> held = rows.cast<std::vector<FleetRow>>();
    result.subject = "fleet";
    result.found = unlocked([&] { return fleet_report(std::move(held), level); });
  }
  return result;
}

std::string text(const FleetResult& self) {
  std::string lines;
  for (const std::string& line : in_words(self.found)) lines += line + '\n';
  for (const std::string& note : self.found.notes) lines += "note: " + note + '\n';
  return lines;
}

Page page(const FleetResult& self) {
  return fleet_page(self.found, self.subject);
}

/// One row per robot of every coefficient, or per group; before each what it is of.
template <typename Row, typename Members>
py::list rows_below(const FleetReport& report, const Members& members) {
  py::list table;
  for (const FleetFinding& finding : report.findings) {
    for (const FleetCoefficient& one : finding.coefficients) {
      members(one, [&](const Row& row, const py::dict& more) {
        py::dict line;
        line["effect"] = finding.effect;
        line["shape"] = one.shape;
        line.attr("update")(more);
        line.attr("update")(py::cast(row).attr("to_dict")());
        table.append(line);
      });
    }
  }
  return table;
}

py::list table(const FleetResult& self, const std::string& what) {
  if (what == "findings") {
    py::list rows;
    for (const FleetFinding& finding : self.found.findings) {
      for (const FleetCoefficient& one : finding.coefficients) {
        py::dict line = py::cast(finding).attr("to_dict")();
        line.attr("update")(py::cast(one).attr("to_dict")());
        rows.append(line);
      }
    }
    return rows;
  }
  if (what == "robots") {
    return rows_below<FleetRobot>(self.found, [](const FleetCoefficient& one, const auto& add) {
      for (const FleetRobot& robot : one.members) add(robot, py::dict());
    });
  }
  if (what == "groups") {
    return rows_below<FleetGroup>(self.found, [](const FleetCoefficient& one, const auto& add) {
      for (const FleetKey& key : one.goes_with) {
        py::dict more;
        more["key"] = key.key;
        for (const FleetGroup& group : key.groups) add(group, more);
      }
    });
  }
  if (what == "tests") return table_of(self.found.tests);
  no_table(what, {"findings", "robots", "groups", "tests"});
}

void add_rows(py::module_& module) {
  RowClass<FleetRobot>(module, "FleetRobot");
  RowClass<FleetGroup>(module, "FleetGroup");
  RowClass<FleetKey>(module, "FleetKey");
  RowClass<FleetCoefficient>(module, "FleetCoefficient");
  RowClass<FleetLookAlike>(module, "FleetLookAlike");
  RowClass<FleetFinding>(module, "FleetFinding");
  RowClass<PooledTest>(module, "PooledTest");
}

void add_day(py::module_& module) {
  RowClass<FleetRow>(module, "FleetRow")
      .field("robot", &FleetRow::robot)
      .field("date", &FleetRow::date)
      .field("metadata", &FleetRow::metadata)
      .field("recordings", &FleetRow::recordings)
      .field("chi2", &FleetRow::chi2)
      .field("dof", &FleetRow::dof)
      .field("held_out_legs", &FleetRow::held_out_legs)
      .field("held_out_rms", &FleetRow::held_out_rms)
      .value(
          "g", [](const FleetRow& self) { return array_of(self.g); },
          "Whitened columns times residuals, an entry per column.")
      .value(
          "S", [](const FleetRow& self) { return array_of(self.S); },
          "Whitened columns times each other, a row and a column per column.")
      .value(
          "columns",
          [](const FleetRow& self) {
            py::list names;
            for (const FleetColumn& one : self.columns) {
              names.append(py::make_tuple(one.effect, one.shape));
            }
            return names;
          },
          "What g and S are of: effect, shape.");
  module.def("fleet_row", row_of, py::arg("robot"), py::arg("date"), py::arg("recordings"),
             py::arg("model"), py::kw_only(),
             py::arg("metadata") = std::map<std::string, std::string>(),
             py::arg("without") = std::vector<std::string>(), py::arg("exclude") = py::tuple(),
             py::arg("gate") = kModelGate, py::arg("every") = py::none(),
             py::arg("holdout") = LegOptions().share, py::arg("min_drive") = LegOptions().min_drive,
             py::arg("leg") = LegOptions().leg,
             doc("What a robot's day says of every effect: sums that pool with those of other "
                 "robots. `date`: YYYY-MM-DD, or a datetime.date; `metadata`: what effects may go "
                 "with.",
                 "fleet_row")
                 .c_str());
}

void add_report(py::module_& module) {
  py::class_<FleetResult> type(module, "FleetReport",
                               "What robots of a fleet have in common, which differ, which drift.");
  show(type, text, page);
  add_fields<FleetResult, FleetReport>(
      type, results::kDescribed<FleetReport>,
      [](const FleetResult& self) -> const FleetReport& { return self.found; });
  type.def("table", table, py::arg("what") = "findings",
           "A list of dicts: findings, robots, groups or tests.")
      .def("__repr__", [](const FleetResult& self) {
        return "<trussmap.FleetReport of " + std::to_string(self.found.robots) +
               " robots: " + std::to_string(self.found.findings.size()) + " findings>";
      });
  module.def("fleet_report", run_report, py::arg("fleet"), py::kw_only(),
             py::arg("level") = FleetReport().level,
             doc("What all robots have, who differs, who drifts, and what that goes with; of a "
                 "store's file, or of rows.",
                 "fleet_report")
                 .c_str());
}

}  // namespace

void add_fleets(py::module_& module) {
  add_rows(module);
  add_day(module);
  add_report(module);
  module.def(
      "add_to_fleet",
      [](const fs::path& file, const FleetRow& row, bool replace) {
        unlocked([&] { add_to_fleet(file, row, replace); });
      },
      py::arg("file"), py::arg("row"), py::kw_only(), py::arg("replace") = false,
      doc("add_to_fleet"));
  module.def(
      "read_fleet", [](const fs::path& file) { return unlocked([&] { return read_fleet(file); }); },
      py::arg("file"), doc("read_fleet"));
  module.def(
      "merge_fleets",
      [](const fs::path& out, const std::vector<fs::path>& shards) {
        return unlocked([&] { return merge_fleets(out, shards); });
      },
      py::arg("out"), py::arg("shards"), doc("merge_fleets"));
}

}  // namespace trussmap::python
