#include "session/workers.h"

#ifdef GAITPAD_HAS_TBB
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <thread>

namespace gaitpad {

struct Workers::Arena {
#ifdef GAITPAD_HAS_TBB
  explicit Arena(int threads) : tbb(threads) {}
  tbb::task_arena tbb;
#endif
};

Workers::Workers([[maybe_unused]] int threads) {
#ifdef GAITPAD_HAS_TBB
  threads_ = std::max(threads, 1);
  if (threads_ > 1) arena_ = std::make_unique<Arena>(threads_);
#endif
}
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

void Workers::for_each(int count, const std::function<void(int)>& work) {
#ifdef GAITPAD_HAS_TBB
  if (arena_) {
    arena_->tbb.execute([&] { tbb::parallel_for(0, count, work); });
    return;
  }
#endif
  for (int i = 0; i < count; ++i) work(i);
}

int machine_threads() noexcept {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace gaitpad
