#include "holdfast/io/logs/topics.hpp"

#include <map>

#include "holdfast/io/files/errors.hpp"

namespace holdfast::io::logs {
namespace {

using files::error_at;

struct Topic {
  std::string type;
  std::string md5;
  std::uint64_t messages = 0;
};

/// By name, so that messages do not depend on the order in the file.
std::multimap<std::string, Topic> topics_of(const bag::BagFile& bag) {
  std::multimap<std::string, Topic> topics;
  for (const auto& connection : bag.connections()) {
    const auto [begin, end] = topics.equal_range(connection.topic);
    auto same = begin;
    while (same != end &&
           (same->second.type != connection.type || same->second.md5 != connection.md5)) {
      ++same;
    }
    if (same == end) {
      topics.emplace(connection.topic, Topic{connection.type, connection.md5, connection.messages});
    } else {
      same->second.messages += connection.messages;
    }
  }
  return topics;
}

std::string list(const std::multimap<std::string, Topic>& topics) {
  std::string text;
  for (const auto& [name, topic] : topics) {
    text += fmt::format("{}{} ({}, {} messages)", text.empty() ? "" : ", ", name, topic.type,
                        topic.messages);
  }
  return text.empty() ? "none" : text;
}

/// The topic that is meant when the user named none; empty if there is none.
Result<std::string> only_topic(const bag::BagFile& bag, const TopicRequest& request) {
  const auto topics = topics_of(bag);
  std::multimap<std::string, Topic> candidates;
  std::multimap<std::string, Topic> used;  // those with messages
  for (const auto& [name, topic] : topics) {
    if (topic.type != request.type) continue;
    candidates.emplace(name, topic);
    if (topic.messages > 0) used.emplace(name, topic);
  }
  if (!used.empty()) candidates = used;
  if (candidates.empty() && !request.required) return std::string();
  if (candidates.empty()) {
    return error_at(bag.path(), "has no topic of type {}; its topics are: {}", request.type,
                    list(topics));
  }
  const std::string& name = candidates.begin()->first;
  if (candidates.count(name) == candidates.size()) return name;
  return error_at(bag.path(), "has several topics of type {}: {}; choose one with {} TOPIC",
                  request.type, list(candidates), request.option);
}

Status check_topic(const bag::BagFile& bag, const TopicRequest& request, const std::string& name) {
  const auto topics = topics_of(bag);
  const auto [begin, end] = topics.equal_range(name);
  if (begin == end) {
    return error_at(bag.path(), "has no topic '{}' ({}); its topics are: {}", name, request.option,
                    list(topics));
  }
  for (auto topic = begin; topic != end; ++topic) {
    if (topic->second.type != request.type) {
      return error_at(bag.path(), "topic '{}' ({}) is of type {}, expected {}; its topics are: {}",
                      name, request.option, topic->second.type, request.type, list(topics));
    }
    if (topic->second.md5 != request.md5 && topic->second.md5 != "*") {
      return error_at(bag.path(),
                      "topic '{}' holds another version of {}: checksum {}, expected {}", name,
                      request.type, topic->second.md5, request.md5);
    }
  }
  return Done{};
}

}  // namespace

Result<std::vector<bool>> select_topic(const bag::BagFile& bag, const TopicRequest& request) {
  std::string name = request.topic;
  if (name.empty()) {
    auto only = only_topic(bag, request);
    if (!only) return only.error();
    name = *only;
  }
  std::vector<bool> wanted(bag.connections().size(), false);
  if (name.empty()) return wanted;
  const auto good = check_topic(bag, request, name);
  if (!good) return good.error();
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i] = bag.connections()[i].topic == name;
    if (wanted[i]) messages += bag.connections()[i].messages;
  }
  if (messages == 0 && request.required) {
    return error_at(bag.path(), "topic '{}' ({}, {}) holds no messages; the topics are: {}", name,
                    request.type, request.option, list(topics_of(bag)));
  }
  return wanted;
}

}  // namespace holdfast::io::logs
