// Sentences for the user from any thread, until somebody takes them.
#pragma once
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gaitpad {

class Remarks {
 public:
  void add(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(sentence));
  }
  void add_once(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    if (said_.size() >= kMaxSaid || waiting_.size() >= kMaxWaiting) return;
    if (said_.insert(sentence).second) waiting_.push_back(sentence);
  }
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  static constexpr std::size_t kMaxWaiting = 256, kMaxSaid = 4096;
  std::mutex mutex_;
  std::vector<std::string> waiting_;
  std::set<std::string> said_;
};

}  // namespace gaitpad
