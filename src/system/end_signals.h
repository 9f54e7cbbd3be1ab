// The signals by which a user ends a program: SIGINT, SIGTERM, SIGHUP.
#pragma once
#include "system/descriptors.h"

namespace gaitpad {

// Makes these signals readable instead of letting them end the process. Make it before any thread
// starts: it blocks them for this thread and for those that it starts. SIGPIPE is ignored: writing
// to a reader that has gone is an ordinary write error.
class EndSignals {
 public:
  EndSignals();
  // Readable when a signal has arrived; -1: no file descriptors are left, and signals end the
  // process as usual.
  int fd() const noexcept { return fd_.get(); }
  // The number of a signal that has arrived; 0: none. Never waits.
  int take() noexcept;

 private:
  OwnedFd fd_;
};

// From this call on, a signal more than a second later ends the process at once, with status
// 128 + signal, even if the calling thread waits. An earlier one counts as a repetition of the
// first: a terminal and `timeout` may both send one.
void end_at_next_signal() noexcept;

}  // namespace gaitpad
