// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/map_guess.hpp"

#include "logs/named_fields.hpp"
#include "recording/variable_names.hpp"

#include <algorithm>
#include <cctype>

namespace trussmap::logs {
namespace {

/// Fields of all topics by their whole paths.
void add_fields(const LogSurvey& survey, const std::string& file, std::vector<NamedFacts>& fields) {
  for (const LogTopicFacts& topic : survey.topics) {
    for (const LogFieldFacts& one : topic.fields) {
      std::string path = one.path;
      if (!topic.name.empty()) path = one.path.empty() ? topic.name : topic.name + '/' + one.path;
      fields.push_back(
          {std::move(path), &one, topic.step, topic.name, file, survey.time_unit, topic.type});
    }
  }
}

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_ros_types(const LogSurvey& survey) {
  return std::any_of(survey.topics.begin(), survey.topics.end(), [](const LogTopicFacts& one) {
    return one.type.find("_msgs/") != std::string::npos;
  });
}

}  // namespace

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string whole;
  std::string hump;
  const auto end = [&words](std::string& word) {
    if (!word.empty()) words.push_back(lowered(word));
    word.clear();
  };
  for (std::size_t k = 0; k < name.size(); ++k) {
    const auto c = static_cast<unsigned char>(name[k]);
    if (std::isalnum(c) == 0) {
      end(whole);
      end(hump);
      continue;
    }
    const auto before = static_cast<unsigned char>(k > 0 ? name[k - 1] : ' ');
    const bool new_hump = (std::isupper(c) != 0 && std::islower(before) != 0) ||
                          (std::isdigit(c) != 0) != (std::isdigit(before) != 0);
    if (new_hump) end(hump);
    whole += name[k];
    hump += name[k];
  }
  end(whole);
  end(hump);
  return words;
}

bool has_word(const std::string& name, const std::vector<std::string>& words) {
  const std::string lower = lowered(name);
  const std::vector<std::string> own = words_of(name);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    if (word.starts_with('=')) {
      return std::find(own.begin(), own.end(), word.substr(1)) != own.end();
    }
    // "gt_", "/gt": as they stand; "enc" begins a word: encoder, not presence.
    if (std::any_of(word.begin(), word.end(), [](unsigned char c) { return !std::isalnum(c); })) {
      return lower.find(word) != std::string::npos;
    }
    return std::any_of(own.begin(), own.end(),
                       [&](const std::string& one) { return one.starts_with(word); });
  });
}

bool is_called_truth(const std::string& name) {
  return has_word(name,
                  {"truth", "ground", "mocap", "vicon", "vrpn", "optitrack", "qualisys", "/gt"});
}

std::string covariate_name(const std::string& path) {
  std::string name;
  for (const char c : path) {
    const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (word) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.ends_with("_data")) name.resize(name.size() - 5);
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) {
    name.insert(0, "c_");
  }
  const std::vector<std::string>& reserved = recording::reserved_variables();
  if (std::find(reserved.begin(), reserved.end(), name) != reserved.end()) name += "_logged";
  return name;
}

namespace {

/// `logs`: "a.csv becomes".
void guess_head(const Guessed& guessed, const std::string& logs, MapText& text) {
  text.comment("How " + logs + " a recording (keys: docs/logs.md). Guessed from its names");
  text.comment("and values: read it once, mend what is wrong, take out what is not wanted.");
  if (guessed.to_state > 0) {
    text.comment(fmt::format("Lines to mend first: {} marked STATE IT.", guessed.to_state));
  }
  if (!guessed.wheels) {
    text.comment(
        "NOTHING LOOKS LIKE WHEELS: state [odometry], or [wheels.left] and [wheels.right].");
  }
  if (!guessed.places) {
    text.comment("NOTHING TIES THE DRIVE TO A PLACE: state [[sightings]], [fixes] or [truth].");
  }
  text.blank();
}

/// A bag and the tables beside it.
Guessed guess_of_bag(const LogSurvey& bag, const std::vector<NamedFacts>& tables,
                     const std::vector<LogClockFacts>& clocks, MapText& text) {
  FreeFields fields(tables);
  int to_state = guess_times(fields, clocks, text);
  MapText own;
  Guessed guessed = guess_by_types(bag, own);
  guessed.truth = own.str().find("\n[truth]") != std::string::npos;
  guessed.fixes = own.str().find("\n[fixes]") != std::string::npos;
  guessed.to_state += to_state;
  text.append(own);
  if (guess_beside(tables, guessed, text)) guessed.places = true;
  return guessed;
}

}  // namespace

std::string guessed_map(const LogSurvey& survey, const std::string& log) {
  MapText body;
  std::vector<NamedFacts> fields;
  add_fields(survey, "", fields);
  Guessed guessed;
  if (has_ros_types(survey)) {
    body.table("time");
    body.text("from", "stamp", "header.stamp, and where there is none when it was recorded (log)");
    guessed = guess_by_types(survey, body);
  } else {
    guessed = guess_by_names(fields, survey.table, {}, body);
  }
  MapText text;
  guess_head(guessed, log + " becomes", text);
  text.comment("survey.file = \"survey.csv\"   # landmarks measured apart: landmark,x,y [m]");
  return text.str() + "\n" + body.str();
}

std::string guessed_joined_map(const std::vector<LogSurvey>& surveys,
                               const std::vector<LogClockFacts>& clocks,
                               const std::string& survey) {
  MapText body;
  std::vector<NamedFacts> fields;
  std::string names;
  const auto bag = std::find_if(surveys.begin(), surveys.end(), has_ros_types);
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    if (surveys[k].table || bag == surveys.end()) add_fields(surveys[k], clocks[k].file, fields);
    names += (names.empty() ? "" : k + 1 == surveys.size() ? " and " : ", ") + clocks[k].file;
  }
  const Guessed guessed = bag == surveys.end() ? guess_by_names(fields, true, clocks, body)
                                               : guess_of_bag(*bag, fields, clocks, body);
  MapText text;
  guess_head(guessed, names + " become", text);
  const std::string line =
      "survey.file = " + io::toml_string(survey.empty() ? "survey.csv" : survey);
  const char* const why = "landmarks measured apart: landmark,x,y [m]";
  survey.empty() ? text.comment(line + "   # " + why) : text.line(line, why);
  return text.str() + "\n" + body.str();
}

}  // namespace trussmap::logs
