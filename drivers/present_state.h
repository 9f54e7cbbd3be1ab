// Asks a pad for its present state when its newest reports may have been dropped, and when it was
// just opened: a pad that reports changes only would not repeat them. The stick would stay where it
// was last seen, and a push after plugging in would not count, because its rest was never seen.
// Everything except `Ask` is for one thread and never waits.
#pragma once
#include <poll.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "drivers/posix.h"

namespace gaitpad {

struct ReportSize {
  std::uint8_t id = 0;      // 0: reports have no ids
  std::uint16_t bytes = 0;  // with the id
};
// The input reports that tell where the stick of a pad is, by its report descriptor.
std::vector<ReportSize> reports_with_stick(std::span<const std::uint8_t> descriptor);

class PresentState {
 public:
  // Gets the pad's answer to GET_REPORT of an input report, beginning with the id (0 if there are
  // no ids), and returns its size; 0: refused. It may wait for the pad, so a separate thread calls
  // it, one call at a time. A call that still waits when the PresentState is destroyed keeps what
  // it owns until it returns.
  using Ask = std::function<std::size_t(std::uint8_t id, std::span<std::uint8_t> answer)>;

  // With an empty `ask` nothing is ever asked.
  PresentState(bool is_numbered, Ask ask) : is_numbered_(is_numbered), ask_(std::move(ask)) {}

  // To be called with every input report.
  void heard(std::span<const std::uint8_t> report) noexcept;
  // The pad was opened: asks for these reports, unless they come by themselves.
  void opened(std::span<const ReportSize> reports) noexcept;
  // Reports may have been dropped; all others were given to heard(). Asks once for each id that is
  // then silent for 30 ms.
  void missed() noexcept;
  // While this is true, wait for poll_fds() too (below 0: none), and call take_answer() when the
  // pad itself has no report.
  bool is_waiting() const noexcept { return missed_count_ > 0; }
  std::array<pollfd, 2> poll_fds() const noexcept;
  // An answer in the form of a report, valid until the next call; empty: none. An answer that is
  // older than a report, or of another length than the reports before, is dropped.
  std::span<const std::uint8_t> take_answer() noexcept;

 private:
  struct Known {
    std::uint16_t size = 0;  // of the last report of this id; 0: none
    bool is_missed = false;
    bool was_zeros = false;  // a report was all zeros
  };
  struct Answer {
    std::uint8_t id = 0;
    std::vector<std::uint8_t> bytes;  // empty: refused
  };
  struct Request;
  struct Round;
  static void run(Round& round, const Ask& ask, const std::vector<Request>& requests) noexcept;
  void settle(Known& known) noexcept;
  void give_up() noexcept;
  bool start_timer() noexcept;
  bool may_ask() noexcept;
  void ask_all() noexcept;
  bool next_answer() noexcept;
  bool fits(const Known& known) const noexcept;

  bool is_numbered_;
  Ask ask_;
  std::array<Known, 256> known_{};
  int missed_count_ = 0;
  OwnedFd timer_;                 // runs from missed() until the pad is asked
  std::shared_ptr<Round> round_;  // the last one; shared with its thread
  bool is_round_valid_ = false;   // nothing was missed since
  Answer answer_;
};

}  // namespace gaitpad
