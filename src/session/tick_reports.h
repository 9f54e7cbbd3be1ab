// The reports on their way from the pads to the tick that uses them. No heap, lock or system call.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "session/pad_stream.h"
#include "session/session_frame.h"

namespace gaitpad {

// While ticks stand still reports gather for the next one. Of those that only move a stick the
// newest is kept; none that presses or releases a button is left out, as long as there is room.
// When there is none they stay with the pads, which keep the newest state (session/pad_queue.h).
class TickReports {
 public:
  static constexpr std::size_t kMaxInTick = 256;  // what is more waits for the next tick

  // Both outlive it.
  TickReports(PadStream& pads, Simulation& simulation);

  // For the tick that begins now. Valid until the next call.
  std::span<const Report> take(std::int64_t now_ns) noexcept;
  // While ticks stand still, as often as one likes. True where something has come.
  bool gather(std::int64_t now_ns) noexcept;
  // What was gathered shows already, though no tick has used it: the driving pad's state and the
  // buttons that were pressed.
  void show(SessionFrame& frame) const noexcept;

  // Any thread: the device was added, what the pads know of it may be read.
  bool is_known(std::uint16_t device) const noexcept;

 private:
  struct Gathered {  // of one device, since the last tick
    PadState state;
    bool has_state = false;
    int newest = -1;  // index in reports_ of its newest report where that may be replaced
    std::array<std::uint32_t, kButtonCount> presses{};
  };

  bool is_of_known_device(const Report& report) noexcept;
  // True: it took the place of an older one.
  bool replaces_older(const Report& report) noexcept;
  void begin_anew() noexcept;

  PadStream& pads_;
  Simulation& simulation_;
  std::vector<Report> reports_;  // kMaxInTick
  std::size_t count_ = 0;
  bool is_used_ = false;  // what stands in reports_ belongs to the last tick
  std::array<Gathered, kMaxPads> gathered_{};
  std::array<std::atomic<bool>, kMaxPads> is_known_{};
};

}  // namespace gaitpad
