// Each case runs in a process of its own, for signals end it.
#include "system/end_signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include "system/clock.h"

namespace gaitpad {
namespace {

using testing::ExitedWithCode;

bool is_readable(const EndSignals& signals) {
  pollfd ready = {signals.fd(), POLLIN, 0};
  return ::poll(&ready, 1, 0) == 1;
}

TEST(EndSignals, AreReadInsteadOfEndingTheProcess) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto read = [signal] {
      EndSignals signals;
      if (is_readable(signals) || signals.take() != 0) ::_exit(100);
      ::raise(signal);
      if (!is_readable(signals)) ::_exit(101);
      ::_exit(signals.take());
    };
    EXPECT_EXIT(read(), ExitedWithCode(signal), "");
  }
}

TEST(EndSignals, AReaderThatHasGoneEndsNothing) {
  const auto raise_pipe = [] {
    const EndSignals signals;
    ::raise(SIGPIPE);
    ::_exit(7);
  };
  EXPECT_EXIT(raise_pipe(), ExitedWithCode(7), "");
}

TEST(EndSignals, ARepetitionWithinASecondDoesNotCutTheWorkOff) {
  const auto repeat = [] {
    const EndSignals signals;
    end_at_next_signal();
    ::raise(SIGTERM);
    ::_exit(7);
  };
  EXPECT_EXIT(repeat(), ExitedWithCode(7), "");
}

TEST(EndSignals, ALaterOneEndsTheProcessAtOnce) {
  const auto end_later = [] {
    const EndSignals signals;
    end_at_next_signal();
    sleep_until(now_ns() + 1'010'000'000);
    ::raise(SIGINT);
    ::_exit(7);
  };
  EXPECT_EXIT(end_later(), ExitedWithCode(128 + SIGINT), "");
}

}  // namespace
}  // namespace gaitpad
