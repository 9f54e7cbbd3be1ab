#include "drivers/realtime.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "drivers/process_memory.h"

namespace gaitpad {
namespace {

constexpr int kPriority = 20;  // above ordinary threads, below what sound servers ask for
// Part of the stack that is kept in memory; more than a tick needs.
constexpr std::size_t kStackBytes = std::size_t{256} << 10;
constexpr std::size_t kPageBytes = 4096;
constexpr rlim_t kGrowthBytes = rlim_t{16} << 20;  // how far stacks may grow after they were locked

std::atomic<int> locks{0};

std::string cause(const char* call, int number) {
  return fmt::format("{}: {}", call, std::strerror(number));
}

// The priority that is asked for: the limits of an ordinary user may allow only a lower one.
int allowed_priority() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_RTPRIO, &limit) != 0 || limit.rlim_cur == 0) return kPriority;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, kPriority));
}

// True if the limit on locked memory leaves room for growing stacks: a locked stack that grows
// beyond it ends the program by a segmentation fault.
bool has_room_below_limit() {
  rlimit limit{};
  if (::geteuid() == 0 || ::getrlimit(RLIMIT_MEMLOCK, &limit) != 0) return true;
  if (limit.rlim_cur == RLIM_INFINITY) return true;
  return static_cast<rlim_t>(mapped_bytes()) + kGrowthBytes <= limit.rlim_cur;
}

// Writes to the stack, so that the part that the next ticks use is in memory.
[[gnu::noinline]] void touch_stack() noexcept {
  std::array<volatile char, kStackBytes> stack;
  for (std::size_t i = 0; i < stack.size(); i += kPageBytes) stack[i] = 0;
}

}  // namespace

// Locks pages when they are first touched: MCL_CURRENT alone would read in every page of every
// library and of every thread's stack; MCL_FUTURE would do so for all memory that a renderer maps
// later.
std::optional<std::string> lock_memory() {
  touch_stack();
  if (!has_room_below_limit()) return cause("mlockall", ENOMEM);
  if (::mlockall(MCL_CURRENT | MCL_ONFAULT) != 0) return cause("mlockall", errno);
  ++locks;
  return std::nullopt;
}

void unlock_memory() noexcept {
  if (--locks == 0) ::munlockall();
}

// Uses the system call: glibc's pthread_setschedparam() does not know SCHED_RESET_ON_FORK. pid 0 is
// the calling thread.
std::optional<std::string> take_priority(RealtimeRank rank) {
  // How late a sleep may end while the thread is ordinary: 1 ns; the default is 50 us.
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param parameter{};
  const int highest = allowed_priority();
  parameter.sched_priority = rank == RealtimeRank::loop ? highest : std::max(1, highest - 1);
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0)
    return std::nullopt;
  return cause("SCHED_FIFO", errno);
}

void give_up_priority() noexcept {
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &ordinary);
}

std::string time_policy() {
  sched_param parameter{};
  const int policy = ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  ::sched_getparam(0, &parameter);
  if (policy == SCHED_FIFO) return fmt::format("SCHED_FIFO {}", parameter.sched_priority);
  if (policy == SCHED_RR) return fmt::format("SCHED_RR {}", parameter.sched_priority);
  return "normal priority";
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
