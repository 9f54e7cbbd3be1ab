// The processor cores that a thread may run on.
#pragma once
#include <sched.h>

namespace gaitpad {

// Pins this thread to one core, so that no migration is measured, and unpins it for work with
// several threads.
class Cores {
 public:
  Cores() noexcept;
  ~Cores() { use_all(); }
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;
  void use_one() const noexcept { use(one_); }
  void use_all() const noexcept { use(all_); }
  // The core that threads are pinned to; -1: it is unknown, and nothing is pinned.
  int core() const noexcept { return core_; }

 private:
  void use(const cpu_set_t& cores) const noexcept;

  cpu_set_t all_, one_;
  int core_ = -1;
};

}  // namespace gaitpad
