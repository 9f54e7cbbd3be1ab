#include "session/workers.h"

#ifdef GAITPAD_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace gaitpad {

struct Workers::Arena {
#ifdef GAITPAD_HAS_TBB
  explicit Arena(int threads)
      : most(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads) {}
  tbb::global_control most;  // otherwise oneTBB warns of more threads than cores
  tbb::task_arena arena;
#endif
};

int startable_threads(int wanted) {
  std::latch end(1);
  std::vector<std::jthread> others;
  try {
    while (static_cast<int>(others.size()) + 1 < wanted)
      others.emplace_back([&end] { end.wait(); });
  } catch (const std::system_error&) {  // thrown at a limit of the user or of the container
  }
  end.count_down();
  return static_cast<int>(others.size()) + 1;
}

Workers::Workers([[maybe_unused]] int threads) {
#ifdef GAITPAD_HAS_TBB
  threads_ = startable_threads(threads);  // oneTBB ends the program if it cannot start one
  if (threads_ > 1) arena_ = std::make_unique<Arena>(threads_);
#endif
}
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

void Workers::for_each(int count, const std::function<void(int)>& work) {
#ifdef GAITPAD_HAS_TBB
  if (arena_) {
    arena_->arena.execute([&] { tbb::parallel_for(0, count, work); });
    return;
  }
#endif
  for (int i = 0; i < count; ++i) work(i);
}

int machine_threads() noexcept {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace gaitpad
