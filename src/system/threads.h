// The calling thread: its name and the processor time that it used.
#pragma once
#include <pthread.h>
#include <time.h>

#include <cstdint>

namespace gaitpad {

// The thread's name in ps and in debuggers; at most 15 characters.
inline void name_thread(const char* name) noexcept { ::pthread_setname_np(::pthread_self(), name); }

inline std::int64_t thread_time_ns() noexcept {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
}

}  // namespace gaitpad
