// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/map_guess.hpp"

#include "recording/variable_names.hpp"

#include <algorithm>
#include <cctype>

namespace trussmap {
namespace {

/// Fields of all topics by their whole paths.
std::vector<NamedFacts> all_fields(const LogSurvey& survey) {
  std::vector<NamedFacts> fields;
  for (const LogTopicFacts& topic : survey.topics) {
    for (const LogFieldFacts& one : topic.fields) {
      std::string path = one.path;
      if (!topic.name.empty()) path = one.path.empty() ? topic.name : topic.name + '/' + one.path;
      fields.push_back({std::move(path), &one, topic.step});
    }
  }
  return fields;
}

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// left, ticks and leftticks of leftTicks: parted at other characters, and at humps, too.
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

bool has_ros_types(const LogSurvey& survey) {
  return std::any_of(survey.topics.begin(), survey.topics.end(), [](const LogTopicFacts& one) {
    return one.type.find("_msgs/") != std::string::npos;
  });
}

}  // namespace

bool has_word(const std::string& name, const std::vector<std::string>& words) {
  const std::string lower = lowered(name);
  const std::vector<std::string> own = words_of(name);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    // "l_", "/gt": as they stand; "enc" begins a word: encoder, not presence.
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
  const std::vector<std::string>& reserved = reserved_variables();
  if (std::find(reserved.begin(), reserved.end(), name) != reserved.end()) name += "_logged";
  return name;
}

std::string guessed_map(const LogSurvey& survey, const std::string& log) {
  MapText body;
  const Guessed guessed = has_ros_types(survey)
                              ? guess_by_types(survey, body)
                              : guess_by_names(all_fields(survey), survey.table, body);
  MapText text;
  text.comment("How " + log + " becomes a recording (keys: docs/logs.md). Guessed from its names");
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
  text.comment("survey.file = \"survey.csv\"   # landmarks measured apart: landmark,x,y [m]");
  return text.str() + "\n" + body.str();
}

}  // namespace trussmap
