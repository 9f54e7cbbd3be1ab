#include "session/realtime.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace gaitpad {
namespace {

constexpr int kPriority = 20;  // above ordinary threads, below what sound servers ask for

std::string cause(const char* call, int number) {
  return fmt::format("{}: {}", call, std::strerror(number));
}

// An ordinary user may have a lower priority than the wished one.
int allowed_priority() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_RTPRIO, &limit) != 0 || limit.rlim_cur == 0) return kPriority;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, kPriority));
}

}  // namespace

std::optional<std::string> lock_memory() {
  rlimit limit{};
  const bool is_unlimited =
      ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  // Below a limit MCL_FUTURE would let later allocations fail.
  if (::mlockall(is_unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0) return std::nullopt;
  return cause("mlockall", errno);
}

void unlock_memory() noexcept { ::munlockall(); }

std::optional<std::string> take_priority() {
  ::prctl(PR_SET_TIMERSLACK, 1UL);  // ns; counts for ordinary threads, which have 50 us
  sched_param parameter{};
  parameter.sched_priority = allowed_priority();
  const int problem = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameter);
  if (problem == 0) return std::nullopt;
  return cause("SCHED_FIFO", problem);
}

void give_up_priority() noexcept {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
}

std::optional<std::string> realtime_remark(const std::optional<std::string>& priority,
                                           const std::optional<std::string>& memory) {
  if (!priority && !memory) return std::nullopt;
  const char* user = std::getenv("USER");
  const std::string name = user != nullptr && *user != '\0' ? user : "YOUR_NAME";
  std::string refused = priority.value_or("");
  if (memory) refused += (priority ? ", " : "") + *memory;
  std::string lines;
  if (priority) lines += fmt::format("`{} - rtprio {}`", name, kPriority);
  if (memory) lines += fmt::format("{}`{} - memlock unlimited`", priority ? " and " : "", name);
  return fmt::format(
      "real-time running was refused ({}), so ticks may come late while the computer is busy; to "
      "allow it put {} into /etc/security/limits.d/gaitpad.conf and log in again",
      refused, lines);
}

}  // namespace gaitpad
