// What the window has to say: errors and remarks, each for a while, newest last.
#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace gaitpad {

class Messages {
 public:
  void add(std::string sentence, std::int64_t time_ns) {
    if (sentence.empty()) return;
    if (!shown_.empty() && shown_.back().sentence == sentence) shown_.pop_back();
    shown_.push_back({std::move(sentence), time_ns});
    if (shown_.size() > kMost) shown_.pop_front();
  }
  void forget_before(std::int64_t time_ns) {
    while (!shown_.empty() && shown_.front().time_ns < time_ns) shown_.pop_front();
  }
  void clear() noexcept { shown_.clear(); }
  std::vector<std::string> sentences() const {
    std::vector<std::string> all;
    for (const Message& message : shown_) all.push_back(message.sentence);
    return all;
  }

 private:
  static constexpr std::size_t kMost = 6;
  struct Message {
    std::string sentence;
    std::int64_t time_ns = 0;
  };
  std::deque<Message> shown_;
};

}  // namespace gaitpad
