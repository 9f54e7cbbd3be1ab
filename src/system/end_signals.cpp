#include "system/end_signals.h"

#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

#include "system/clock.h"

namespace gaitpad {
namespace {

constexpr int kEndingSignals[] = {SIGINT, SIGTERM, SIGHUP};

sigset_t ending_signals() noexcept {
  sigset_t set;
  sigemptyset(&set);
  for (int signal : kEndingSignals) sigaddset(&set, signal);
  return set;
}

constexpr std::int64_t kOneRequest_ns = 1'000'000'000;
std::atomic<std::int64_t> end_began_ns{0};

void end_at_once(int signal) {
  if (now_ns() - end_began_ns.load() > kOneRequest_ns) ::_exit(128 + signal);
}

}  // namespace

EndSignals::EndSignals() {
  const sigset_t set = ending_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  fd_ = OwnedFd(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  if (fd_.get() < 0) pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

int EndSignals::take() noexcept {
  signalfd_siginfo info = {};
  const bool has_come = ::read(fd_.get(), &info, sizeof info) == sizeof info;
  return has_come ? static_cast<int>(info.ssi_signo) : 0;
}

void end_at_next_signal() noexcept {
  end_began_ns = now_ns();
  struct sigaction action = {};
  action.sa_handler = &end_at_once;
  action.sa_flags = SA_RESTART;
  const sigset_t set = ending_signals();
  for (int signal : kEndingSignals) sigaction(signal, &action, nullptr);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace gaitpad
