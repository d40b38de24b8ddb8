// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "bench_exports.hpp"

#include "call_again.hpp"
#include "page_runtime.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

bool is_of_catalogue(const Effect& effect) {
  try {
    const Effect known = catalogue_effect(effect.name);
    return known.channel == effect.channel && known.shape == effect.shape;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// " --exclude ..." of a step; empty where it uses all.
std::string exclusion(const WorkbenchStep& step, std::size_t recordings) {
  std::vector<std::string> stretches;
  for (std::size_t s = 0; s < step.excluded.size(); ++s) {
    for (const TimeSpan& span : step.excluded[s]) {
      const std::string number = recordings > 1 ? fmt::format("{}:", s + 1) : std::string();
      stretches.push_back(fmt::format("{}{}:{}", number, span.from, span.to));
    }
  }
  return stretches.empty() ? std::string()
                           : fmt::format(" --exclude {}", fmt::join(stretches, ","));
}

std::string commands(const BenchView& view, const BenchOrigin& origin) {
  std::vector<std::string> folders;
  for (const std::string& one : origin.recordings) folders.push_back(shell_quoted(one));
  const std::string recordings =
      fmt::format("{}{}", fmt::join(folders, " "),
                  exclusion(view.log.steps[view.log.at], origin.recordings.size()));
  const Model& given = view.log.steps.front().model;
  std::string text =
      "#!/bin/sh\n# What was done in the workbench, by commands. The noise is estimated anew by "
      "the "
      "fit, so\n# that coefficients agree to a small part of their standard errors.\nset -e\n";
  std::string model = shell_quoted(origin.model);
  std::size_t number = 0;
  const auto had = [&given](const Effect& effect) {
    return std::any_of(given.effects.begin(), given.effects.end(),
                       [&effect](const Effect& one) { return one.name == effect.name; });
  };
  const std::vector<Effect>& present = view.log.steps[view.log.at].model.effects;
  const bool all_there =
      std::all_of(given.effects.begin(), given.effects.end(), [&](const Effect& one) {
        return std::any_of(present.begin(), present.end(),
                           [&one](const Effect& other) { return other.name == one.name; });
      });
  if (!all_there) {
    text += "# Effects that the model had were removed: no command does that, take model.toml.\n";
  }
  for (const Effect& effect : present) {
    if (had(effect)) continue;
    const std::string out = fmt::format("step{}.toml", ++number);
    text += fmt::format("trussmap add {} {}", model, shell_quoted(effect.name));
    if (!is_of_catalogue(effect)) {
      text += fmt::format(" --channel {} --shape", trussmap::name_of(effect.channel));
      for (const std::string& shape : texts_of(effect.shape)) text += " " + shell_quoted(shape);
    }
    text += fmt::format(" --out {}\n", out);
    model = out;
  }
  if (!present.empty()) {
    text += fmt::format("trussmap fit {} --model {} --noise --out model.toml\n", recordings, model);
    model = "model.toml";
  }
  return text + fmt::format("trussmap diagnose {} --model {}\n", recordings, model);
}

std::string odometry(const BenchView& view) {
  const Robot& robot = view.now.fit().model.robot;
  const DrivenRecording& first = view.now.recordings().front();
  std::vector<std::string> covariates;
  for (const Covariate& one : first.drive.covariates) covariates.push_back("\"" + one.name + "\"");
  const bool two = robot.drive == DriveKind::differential;
  const bool turns_by_gyro = robot.drive == DriveKind::unicycle && robot.columns.size() == 1;
  return fmt::format(
      "// Odometry corrected by model.toml, row by row. Link trussmap::trussmap.\n"
      "#include <trussmap/corrected_odometry.hpp>\n#include <trussmap/model_file.hpp>\n\n"
      "#include <cstdio>\n\nint main() {{\n"
      "  const trussmap::Model model = trussmap::read_model(\"model.toml\");\n"
      "  trussmap::CorrectedOdometry odometry(\n"
      "      model, {{.covariates = {{{}}}, .compass = {}, .gyro = {}}});\n"
      "  trussmap::WheelRow row;\n"
      "  row.duration = 0.1;  // s\n{}"
      "{}"
      "  const trussmap::Pose pose = odometry.pose().pose;\n"
      "  std::printf(\"%.4f %.4f %.4f\\n\", pose.x, pose.y, pose.heading);\n}}\n",
      fmt::join(covariates, ", "), first.drive.has_compass(),
      first.drive.has_gyro() || turns_by_gyro,
      two ? "  row.left = 0.05;      // m, travel of the left wheel\n"
            "  row.right = 0.05;     // m\n"
          : fmt::format("  row.readings = std::vector<double>({});  // the model's columns\n",
                        robot.columns.size()),
      covariates.empty()
          ? std::string("  odometry.drive(row);\n")
          : fmt::format("  const double covariates[] = {{{}}};  // what they read, in that order\n"
                        "  odometry.drive(row, covariates);\n",
                        fmt::join(std::vector<std::string>(covariates.size(), "0.0"), ", ")));
}

/// What the model has by now, beside the one given.
RobotConstants constants_of(const BenchView& view) {
  const ModelFit& fit = view.now.fit();
  return with_velocity_variances(robot_constants(view.log.steps.front().model, fit),
                                 view.now.recordings(), fit.model);
}

/// A file of TOML: what is for other programs is a comment in it.
std::string constants_file(const RobotConstants& constants) {
  if (constants.empty()) {
    return constants.others.empty()
               ? "# the model has no effect\n"
               : fmt::format("# no constant undoes {}\n", fmt::join(constants.others, ", "));
  }
  const std::string text = constants_text(constants);
  std::istringstream lines(text);
  std::string result;
  bool toml = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    const bool inside = line.starts_with("  ");
    if (!inside) toml = line.starts_with("Constants");
    line.erase(0, inside && toml ? 2 : 0);
    result += (inside && toml ? "" : "# ") + line + "\n";
  }
  return result;
}

}  // namespace

std::optional<LocalReply> bench_export(const std::string& name, const BenchView& view,
                                       const BenchOrigin& origin) {
  const char* text = "text/plain; charset=utf-8";
  if (name == "model.toml") return LocalReply{200, text, format_model(view.now.fit().model), name};
  if (name == "commands.sh") return LocalReply{200, text, commands(view, origin), name};
  if (name == "constants.toml") {
    return LocalReply{200, text, constants_file(constants_of(view)), name};
  }
  if (name == "odometry.cpp") return LocalReply{200, text, odometry(view), name};
  if (name != "report.html") return std::nullopt;
  const Page page =
      with_constants(diagnosis_page(view.now.diagnosis(),
                                    evidence_of(view.now.recordings(), view.now.fit(),
                                                view.now.diagnosis(), view.now.options()),
                                    subject_of(origin.recordings, origin.model)),
                     constants_of(view));
  return LocalReply{200, "text/html; charset=utf-8", render_page(page, page_runtime()), name};
}

}  // namespace trussmap::app
