// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/field_facts.hpp"
#include "logs/field_path.hpp"
#include "logs/frame_tree.hpp"
#include "logs/log_survey.hpp"
#include "logs/message_log.hpp"
#include "logs/pose_fields.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
using namespace logs;

namespace {

constexpr std::size_t kElements = 4;  // of a list of numbers that are looked at
constexpr std::size_t kJoints = 256;  // of a list of numbers that are kept: beside joints' names
constexpr std::size_t kMostTopicFields = 400;  // of a topic
constexpr std::size_t kMostSteps = 4096;       // of which the median is taken
constexpr std::uint64_t kAllOf = 50000;        // messages of a topic; of more every so many'th
constexpr std::uint64_t kEveryBeyond = 16;

struct TopicState {
  LogTopicFacts facts;
  std::map<std::string, std::size_t, std::less<>> by_path;
  std::vector<std::string> before;  ///< texts, by field
  std::vector<double> steps;        ///< s
};

/// JointState: elements by their joints' names, as map.toml names them.
std::vector<NamedField> fields_of(FieldRef message) {
  const auto names = message.member("name");
  if (!names || names->kind() != FieldKind::list || !message.member("position")) {
    return leaves_of(message, kElements);
  }
  std::vector<NamedField> found;
  for (const FieldRef& joint : names->children()) {
    for (const char* list : {"position", "velocity"}) {
      const std::string path = std::string(list) + '[' + std::string(joint.field().text) + ']';
      try {
        if (const auto field = FieldPath(path, false).find(message)) {
          found.push_back({path, *field});
        }
      } catch (const std::invalid_argument&) {  // a joint whose name no path can have
        continue;
      }
    }
  }
  return found;
}

class Surveyor {
 public:
  LogSurvey survey(const std::filesystem::path& log, const GivenDefinitions& definitions) {
    LogVisit visit;
    visit.definitions = definitions.get();
    visit.elements = kJoints;
    visit.wanted = [](const LogTopic&) { return true; };
    visit.message = [this](const LogMessage& message) { take(message); };
    const LogEnd end = read_message_log(log, visit);
    require_messages(log, end);
    LogSurvey result;
    for (std::size_t k = 0; k < end.topics.size(); ++k) {
      TopicState& state = states_[k];
      state.facts.name = end.topics[k].name;
      state.facts.type = end.topics[k].type;
      state.facts.unread = end.topics[k].unread;
      state.facts.messages = end.topics[k].messages;
      if (!state.steps.empty()) {
        const auto middle =
            state.steps.begin() + static_cast<std::ptrdiff_t>(state.steps.size() / 2);
        std::nth_element(state.steps.begin(), middle, state.steps.end());
        state.facts.step = *middle;
      }
      result.table = result.table || end.topics[k].table;
      result.topics.push_back(std::move(state.facts));
    }
    for (auto& [child, facts] : frames_) {
      result.frames.push_back(facts);
    }
    result.cut_off = end.cut_off;
    result.passed_over = counts_of(end.passed_over);
    return result;
  }

 private:
  void take(const LogMessage& message) {
    TopicState& state = states_[message.number];
    const std::uint64_t seen = state.facts.messages++;
    if (message.has_time) add_time(message, state);
    if (short_type(message.topic.type) == "tf2_msgs/TFMessage") {
      add_frames(message);
      return;
    }
    if (seen > kAllOf && seen % kEveryBeyond != 0) return;
    for (const NamedField& one : fields_of(message.fields)) {
      auto known = state.by_path.find(one.path);
      if (known == state.by_path.end()) {
        if (state.facts.fields.size() >= kMostTopicFields) continue;
        known = state.by_path.emplace(one.path, state.facts.fields.size()).first;
        state.facts.fields.emplace_back().path = one.path;
        state.before.emplace_back();
      }
      LogFieldFacts& facts = state.facts.fields[known->second];
      if (one.field.kind() == FieldKind::text) {
        add_text(std::string(one.field.field().text), facts, state.before[known->second]);
      } else {
        add_number(one.field.number(), facts);
      }
    }
  }

  static void add_time(const LogMessage& message, TopicState& state) {
    constexpr double kNanosecond = 1e-9;
    const std::int64_t t = stamp_of(message.fields).value_or(message.log_time);
    const double seconds = static_cast<double>(t) * kNanosecond;
    if (state.facts.first != state.facts.first) {
      state.facts.first = state.facts.last = seconds;
      return;
    }
    if (state.steps.size() < kMostSteps) state.steps.push_back(seconds - state.facts.last);
    state.facts.first = std::min(state.facts.first, seconds);
    state.facts.last = std::max(state.facts.last, seconds);
  }

  void add_frames(const LogMessage& message) {
    const auto all = message.fields.member("transforms");
    if (!all) return;
    for (const FieldRef& one : all->children()) {
      const auto child = one.member("child_frame_id");
      const auto pose = pose_of(one);
      if (!child || !pose) continue;
      const std::string name(child->field().text);
      FrameFacts& facts = frames_[name];
      const Eigen::Vector3d z = pose->rotation * Eigen::Vector3d::UnitZ();
      if (facts.samples == 0) {
        first_[name] = *pose;
        facts.translation_y = pose->position.y();
      }
      facts.parent = frame_of(one);
      facts.child = name;
      facts.topic = message.topic.name;
      facts.is_static = message.topic.name.ends_with("_static");
      const FieldPose& first = first_[name];
      facts.moves = facts.moves || !pose->position.isApprox(first.position, 1e-9);
      facts.turns = facts.turns || pose->rotation.angularDistance(first.rotation) > 1e-9;
      facts.z_axes += z * z.transpose();
      facts.last = pose->rotation;
      ++facts.samples;
    }
  }

  std::map<std::size_t, TopicState> states_;
  std::map<std::string, FrameFacts> frames_;
  std::map<std::string, FieldPose> first_;
};

}  // namespace

}  // namespace trussmap

namespace trussmap::logs {

void add_number(double value, LogFieldFacts& facts) {
  if (!std::isfinite(value)) return;
  if (facts.values == 0) {
    facts.first = facts.least = facts.largest = value;
  } else {
    facts.different += value != facts.last ? 1U : 0U;
    facts.decreases += value < facts.last ? 1U : 0U;
    facts.total_step += std::abs(value - facts.last);
  }
  facts.least = std::min(facts.least, value);
  facts.largest = std::max(facts.largest, value);
  facts.is_whole = facts.is_whole && value == std::floor(value);
  facts.last = value;
  ++facts.values;
}

void add_text(const std::string& text, LogFieldFacts& facts, std::string& before) {
  facts.is_text = true;
  if (text.empty()) return;
  if (facts.example.empty()) facts.example = text;
  facts.different += facts.values > 0 && text != before ? 1U : 0U;
  before = text;
  ++facts.values;
}

std::string short_type(std::string_view type) {
  std::string text(type);
  if (const std::size_t at = text.find("/msg/"); at != std::string::npos) text.erase(at, 4);
  return text;
}

double LogSurvey::upright_share(const FrameFacts& frame, const std::string& base) const {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // of the parent in the base
  std::string at = frame.parent;
  for (std::size_t links = 0; links < frames.size() && at != base; ++links) {
    const auto link = std::find_if(frames.begin(), frames.end(),
                                   [&](const FrameFacts& one) { return one.child == at; });
    if (link == frames.end()) break;
    rotation = link->last * rotation;
    at = link->parent;
  }
  const Eigen::RowVector3d up = rotation.toRotationMatrix().row(2);
  const double samples = static_cast<double>(std::max<std::size_t>(frame.samples, 1));
  return std::sqrt((up * frame.z_axes * up.transpose()).value() / samples);
}

LogSurvey survey_log(const std::filesystem::path& log, const GivenDefinitions& definitions) {
  return Surveyor().survey(log, definitions);
}

}  // namespace trussmap::logs

namespace trussmap {

LogInspection inspect_log(const std::filesystem::path& log, const LogOptions& options) {
  return inspect_logs({log}, options);
}

}  // namespace trussmap

namespace trussmap::logs {

LogInspection inspect_one_log(const std::filesystem::path& log,
                              const GivenDefinitions& definitions) {
  LogSurvey survey = survey_log(log, definitions);
  put_in_order(survey, log);
  survey.wheels = wheel_topics(survey);
  survey.wheels.constants = wheel_constants(JoinedLogs({log}, definitions), survey.wheels);
  std::string map = guessed_map(survey, log.string());
  std::vector<LogFrameFacts> frames;
  for (const FrameFacts& one : survey.frames) {
    frames.push_back({one.parent, one.child, one.is_static, one.samples});
  }
  return {std::move(survey.topics),
          std::move(frames),
          std::move(survey.cut_off),
          std::move(map),
          {},
          std::move(survey.passed_over)};
}

}  // namespace trussmap::logs
