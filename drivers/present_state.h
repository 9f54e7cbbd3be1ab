// A pad's present state, asked for where its newest reports may have been dropped: a pad that
// reports only changes would not say it again, and the stick would stay where it was last seen.
// Everything but `Ask` is for one thread and never waits.
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

class PresentState {
 public:
  // The pad's answer to GET_REPORT of an input report: the id first, 0 where there are none. Its
  // size; 0: refused. May wait for the pad, so a thread of its own calls it, never two at a time;
  // one that still waits when the PresentState is destroyed keeps what it owns until it returns.
  using Ask = std::function<std::size_t(std::uint8_t id, std::span<std::uint8_t> answer)>;

  // `ask` may be empty: then nothing is ever asked.
  PresentState(bool is_numbered, Ask ask) : is_numbered_(is_numbered), ask_(std::move(ask)) {}

  // Every input report that comes.
  void heard(std::span<const std::uint8_t> report) noexcept;
  // Reports may have been dropped, all that were not have been heard. The ids that are then silent
  // for 30 ms are asked for, once.
  void missed() noexcept;
  // Whether something is awaited; then poll_fds() are to be waited on and take() to be called when
  // the pad itself has nothing more. Below 0: none.
  bool is_waiting() const noexcept { return missed_count_ > 0; }
  std::array<pollfd, 2> poll_fds() const noexcept;
  // An answer in the form of a report, until the next call; empty: none. Never one that a report
  // has overtaken or that has not the length of the reports before it.
  std::span<const std::uint8_t> take() noexcept;

 private:
  struct Known {
    std::uint16_t size = 0;  // of the last report of this id, 0: there was none
    bool is_missed = false;
    bool was_zeros = false;  // once
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
  OwnedFd timer_;                 // runs from missed() to asking
  std::shared_ptr<Round> round_;  // the last one, also its thread's
  bool is_round_valid_ = false;   // nothing was missed since
  Answer answer_;
};

}  // namespace gaitpad
