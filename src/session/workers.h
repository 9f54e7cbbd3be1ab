// Threads that share the blocks of a crowd.
#pragma once
#include <functional>
#include <memory>

namespace gaitpad {

class Workers {
 public:
  // Uses at most `threads` threads, with the caller's; built without oneTBB, the caller's alone.
  explicit Workers(int threads);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;
  int threads() const noexcept { return threads_; }
  // Calls work(0) .. work(count - 1), each once, in any order, several at once, and waits for all.
  void for_each(int count, const std::function<void(int)>& work);

 private:
  struct Arena;
  int threads_ = 1;
  std::unique_ptr<Arena> arena_;  // null: there is only one thread
};

// Number of threads that can be started now, with the caller's: 1 .. `wanted`.
int startable_threads(int wanted);
// Number of threads that this machine runs at once.
int machine_threads() noexcept;

}  // namespace gaitpad
