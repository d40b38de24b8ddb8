// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/bag_topics.hpp"

#include "logs/byte_reader.hpp"
#include "logs/cdr.hpp"

#include <limits>

namespace trussmap::logs {
namespace {

constexpr std::uint64_t kLatest = std::numeric_limits<std::int64_t>::max();

}  // namespace

BagTopics::Definition BagTopics::definition_of(const BagChannel& channel) {
  const bool ros1 = channel.encoding == "ros1" && channel.schema_encoding == "ros1msg";
  if (channel.encoding != "cdr" && !ros1) {
    return {nullptr, channel.encoding.empty() ? "no encoding" : channel.encoding};
  }
  // IDL is read of standard types alone, by their names.
  const std::string& encoding = channel.schema_encoding;
  const bool here = (ros1 || encoding == "ros2msg") && channel.definition_known;
  const std::string_view text = here ? channel.definition : std::string_view();
  const auto [place, is_new] =
      definitions_.try_emplace(encoding + '\0' + channel.type + '\0' + std::string(text));
  Definition& found = place->second;
  if (!is_new) return found;
  if (ros1 && !here) {
    found.unread = "its definition is too large";
    return found;
  }
  try {
    found.layout = std::make_shared<Ros2Layout>(
        ros1 ? parse_ros1_definition(channel.type, text)
             : parse_ros2_definition(channel.type, text, visit_->definitions));
  } catch (const DefinitionError& error) {
    const bool known = ros1 || encoding.empty() || encoding == "ros2msg";
    found.unread = known ? error.what() : encoding;
  }
  return found;
}

std::size_t BagTopics::add(const BagChannel& channel) {
  const auto [place, is_new] = numbers_.try_emplace(channel.topic, topics_.size());
  Definition definition = definition_of(channel);
  definition.unread = in_a_line(definition.unread);
  if (is_new) {
    LogTopic& topic = topics_.emplace_back();
    topic.name = channel.topic;
    topic.type = channel.type;
    topic.encoding = channel.encoding;
    topic.unread = definition.unread;
  }
  channels_.push_back({place->second, channel.type, channel.encoding, definition.unread,
                       std::move(definition.layout)});
  asked_.emplace_back();
  return channels_.size() - 1;
}

bool BagTopics::ask(Channel& channel) {
  LogTopic& topic = topics_[channel.topic];
  topic.type = channel.type;
  topic.encoding = channel.encoding;
  topic.unread = channel.unread;
  const auto [place, is_new] = wanted_.try_emplace(
      topic.name + '\0' + channel.type + '\0' + channel.encoding + '\0' + channel.unread, false);
  if (is_new) place->second = visit_->wanted(topic);
  return place->second && channel.layout != nullptr;
}

bool BagTopics::count(std::size_t number) {
  Channel& channel = channels_[number];
  std::optional<bool>& asked = asked_[number];
  if (!asked) asked = ask(channel);
  ++topics_[channel.topic].messages;
  return *asked;
}

void BagTopics::deliver(std::size_t number, std::uint64_t log_time, std::uint64_t publish_time,
                        std::string_view data,
                        const std::function<void(const std::string&)>& fail) {
  const Channel& channel = channels_[number];
  LogTopic& topic = topics_[channel.topic];
  const std::string message = "a message of " + topic.name + " ";
  if (log_time > kLatest || publish_time > kLatest) {
    fail(message + "is " + std::to_string(std::max(log_time, publish_time)) +
         " ns after the epoch, expected " + std::to_string(kLatest) + " at most");
  }
  topic.type = channel.type;
  try {
    if (channel.encoding == "ros1") {
      decode_ros1(data, *channel.layout, visit_->elements, tree_);
    } else {
      if (is_zstd(data)) data = decompressor_.zstd_of_any_size(data, kLargestChunk);
      decode_cdr(data, *channel.layout, visit_->elements, tree_);
    }
  } catch (const CdrError& error) {
    fail(message + error.what());
  } catch (const DecompressError& error) {
    fail(message + "cannot be decompressed: " + error.what());
  }
  visit_->message({topic, channel.topic, true, static_cast<std::int64_t>(log_time),
                   static_cast<std::int64_t>(publish_time), tree_.root()});
}

const std::string& BagTopics::name(std::size_t channel) const {
  return topics_[channels_[channel].topic].name;
}

}  // namespace trussmap::logs
