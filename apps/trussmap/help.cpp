// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "help.hpp"

#include <algorithm>
#include <memory>
#include <sstream>

namespace trussmap::app {
namespace {

constexpr std::size_t kHelpWidth = 100;
constexpr std::size_t kColumn = 30;  // where descriptions begin

constexpr const char* kRecordingFormat =
    "A recording is a folder of CSV files with a header row (m, s, rad; columns in any order):\n"
    "  drive.csv      t,left,right[,heading][,COVARIATE...]  a row per odometry interval, which "
    "ends\n"
    "                 at t: signed travel of each wheel, compass heading (may be empty), and any\n"
    "                 further numeric columns\n"
    "  sightings.csv  t,landmark[,range,bearing][,yaw[,dx,dy]]  a landmark seen; without range "
    "the\n"
    "                 robot stands on it; yaw: a tag's own axis less the robot's heading. May be\n"
    "                 left out where one of the files below is\n"
    "  fixes.csv      t,x,y[,sd][,quality]  positions without heading (GNSS, UWB); optional\n"
    "  loops.csv      t,t2,dx,dy,dtheta[,sd,sd_heading]  the pose at t2 in the robot's axes at t\n"
    "                 (scan matching); optional\n"
    "  survey.csv     landmark,x,y[,sd][,heading]  landmark positions measured independently, and\n"
    "                 the directions of their axes; optional\n"
    "  truth.csv      t,x,y,heading  robot poses measured independently; optional\n"
    "Several folders are several sessions of one robot in one place: landmarks of the same name "
    "are\n"
    "the same.";

/// "FLOAT:{a,b}" and the like, as help spells it.
std::string spelled_type(const CLI::Option& option) {
  const std::string whole = option.get_type_name();
  const std::size_t colon = whole.find(':');
  std::string base = whole.substr(0, colon);
  const std::string check = colon == std::string::npos ? "" : whole.substr(colon + 1);
  if (check.starts_with('{')) return option.get_expected_max() > 1 ? check + ",..." : check;
  if (base == "FLOAT") return option.get_expected_min() > 1 ? "X,X" : "X";
  if (base == "INT" || base == "UINT") return "N";
  return base;
}

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kColumn); }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text;
    if (option->get_type_size() != 0) {
      text = " " + spelled_value(*option);
      if (option->get_required()) text += " (required)";
    }
    for (const CLI::Option* other : option->get_excludes()) {
      text += " (not with " + other->get_name() + ")";
    }
    return text;
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    const std::string description = make_option_desc(option);
    if (description.empty()) return name + "\n";
    name += name.size() + 1 < kColumn ? std::string(kColumn - name.size(), ' ')
                                      : "\n" + std::string(kColumn, ' ');
    return name + wrapped(description, kHelpWidth - kColumn, kColumn) + "\n";
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::string name = "  " + command->get_name();
    name.resize(std::max(name.size() + 1, kColumn), ' ');
    std::string said = command->get_description();
    if (said.ends_with('.')) said.pop_back();
    return name + wrapped(said, kHelpWidth - kColumn, kColumn) + "\n";
  }

  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), kHelpWidth, 0) + "\n";
  }

  std::string make_footer(const CLI::App* app) const override {
    const std::string footer = app->get_footer();
    return footer.empty() ? footer : "\n" + footer + "\n";
  }
};

bool reads_recordings(const CLI::App& command) {
  return command.get_option_no_throw(kRecordingArgument) != nullptr;
}

}  // namespace

std::string spelled_value(const CLI::Option& option) {
  std::string text = spelled_type(option);
  const bool many = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  if (many && !text.ends_with("...")) text += "...";
  std::string standard = option.get_default_str();
  if (standard.starts_with('[')) standard = standard.substr(1, standard.size() - 2);
  if (!standard.empty()) text += "=" + standard;
  return text;
}

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::string result;
  std::istringstream lines(text);
  bool first = true;
  for (std::string line; std::getline(lines, line);) {
    if (!first) result += "\n" + std::string(indent, ' ');
    first = false;
    std::istringstream words(line);
    std::size_t length = 0;
    for (std::string word; words >> word;) {
      if (length > 0 && length + 1 + word.size() > width) {
        result += "\n" + std::string(indent, ' ');
        length = 0;
      }
      result += (length > 0 ? " " : "") + word;
      length += (length > 0 ? 1 : 0) + word.size();
    }
  }
  return result;
}

void begin_help(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
}

void finish_help(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!reads_recordings(*command)) continue;
    const std::string own = command->get_footer();
    command->footer(own + (own.empty() ? "" : "\n\n") + kRecordingFormat);
  }
}

}  // namespace trussmap::app
