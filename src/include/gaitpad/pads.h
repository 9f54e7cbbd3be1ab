// Which stick drives the walk: the pads of a session, plugged in and out, each with its layout and
// its calibration, and the position of the driving one.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"
#include "gaitpad/report.h"

namespace gaitpad {

struct PadConfig {
  std::shared_ptr<const PadLayout> layout;  // null: its reports say nothing
  Calibration calibration;
  bool is_usable = true;            // it has a stick that can drive
  bool is_present = true;           // plugged in from the start
  bool streams = false;             // it reports while at rest too: silence means that it is gone
  bool is_fallback = false;         // the keyboard: it drives where no other pad is plugged in
  bool has_factory_sticks = false;  // live ones: it told its own calibration when it was opened
};

// The first usable pad drives: of those plugged in from the start, else the first to be added. It
// drives until it is removed; then another one that is plugged in takes over, but not before it is
// seen near its centre. Where none has taken over by then, the old one drives again.
// A removed pad is neutral, and after plugging in again until it has been seen near its centre; a
// streaming one also while it is silent for 100 ms. Time is counted in ticks. Who drives depends on
// the order of the reports alone, not on the devices' numbers.
// A fallback drives only while no other usable pad is plugged in. But while the left stick of the
// driving pad is exactly at rest, or neutral, and that of a fallback is not, its sticks count.
class Pads {
 public:
  Pads() = default;
  Pads(std::vector<PadConfig> configs, int rate_hz);

  // What is known of a device once it is found, before its first add(). Swaps: `config` is left
  // with what was known before.
  void set(std::uint16_t device, PadConfig& config) noexcept;
  // False where the report is not one that its device can send; then nothing changes.
  bool take(const Report& report) noexcept;
  void add(std::uint16_t device) noexcept;
  void remove(std::uint16_t device) noexcept;
  // The driving stick after this tick's reports. Once a tick: counts the silence.
  Stick stick_of_tick() noexcept;

  // kNoDevice: none has driven so far. It may be unplugged.
  std::uint16_t driving() const noexcept { return driving_; }
  // The driving pad's, uncalibrated; at rest where there is none.
  const PadState& driving_state() const noexcept;
  // The driving one as it is known, null where there is none.
  const PadConfig* driving_pad() const noexcept;
  // What has come of the driving pad since the beginning, sound or not.
  std::uint64_t driving_reports() const noexcept;
  // How often each button of the pad that drove then was pressed, since the beginning: by every
  // report, so that none is missed between two ticks. A button held while the pad is plugged in
  // counts with its first report.
  const std::array<std::uint32_t, kButtonCount>& presses() const noexcept { return presses_; }

 private:
  struct Pad {
    PadConfig config;
    PadState state;
    bool is_awaited = false;  // plugged in again and not yet seen near its centre
    bool is_seen = false;     // it has reported since it was plugged in
    std::uint64_t reports = 0;
    int silent_ticks = 0;
    int turn = 0;  // the lowest goes first among pads that can take over; 0: never plugged in
  };
  bool is_silent(const Pad& pad) const noexcept;
  bool is_near_centre(const Pad& pad) const noexcept;
  bool can_take_over(const Pad& pad) const noexcept;
  bool has_lost_its_driver() const noexcept;
  bool is_fallback(std::uint16_t device) const noexcept;
  bool is_other_plugged_in() const noexcept;
  void replace_driver() noexcept;
  void count_presses(std::uint32_t before, std::uint32_t now) noexcept;
  Stick stick_of(const Pad& pad) const noexcept;
  Stick fallback_stick() const noexcept;

  std::vector<Pad> pads_;
  std::uint16_t driving_ = kNoDevice;
  int turns_ = 0;
  std::array<std::uint32_t, kButtonCount> presses_{};
  int silence_ticks_ = 0;
};

}  // namespace gaitpad
