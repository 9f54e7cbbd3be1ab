// Which stick drives the walk: the pads of a session, plugged in and out, each with its layout and
// its calibration, and the position of the driving one.
#pragma once
#include <cstdint>
#include <vector>

#include "hid/decode.h"
#include "hid/report.h"
#include "stick/calibration.h"

namespace gaitpad {

struct PadConfig {
  PadLayout layout;
  Calibration calibration;
  bool is_usable = true;   // it has a stick that can drive
  bool is_present = true;  // plugged in from the start
  bool streams = false;    // it reports while at rest too: silence means that it is gone
};

// The first usable pad drives. A removed one is neutral, and after plugging in again until it has
// been seen near its centre; a streaming one also while it is silent for 100 ms. Time is counted in
// ticks.
class Pads {
 public:
  Pads() = default;
  Pads(std::vector<PadConfig> configs, int rate_hz);

  // False where the report is not one that its device can send; then nothing changes.
  bool take(const Report& report) noexcept;
  void add(std::uint16_t device) noexcept;
  void remove(std::uint16_t device) noexcept;
  // The driving stick after this tick's reports. Once a tick: counts the silence.
  Stick stick_of_tick() noexcept;

 private:
  struct Pad {
    PadConfig config;
    PadState state;
    bool is_awaited = false;  // plugged in again and not yet seen near its centre
    int silent_ticks = 0;
  };
  std::vector<Pad> pads_;
  std::size_t driving_ = 0;  // pads_.size(): none
  int silence_ticks_ = 0;
};

}  // namespace gaitpad
