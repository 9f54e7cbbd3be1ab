// Chooses the stick that drives the walk. Pads keeps the pads of a session, plugged in or not, each
// with its layout and its calibration, and gives one stick position a tick: that of the driving
// pad.
//
//   Pads pads({config}, 240);
//   pads.take_report(report);              // for each report of the tick, in order of arrival
//   const Stick stick = pads.finish_tick();
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/untouched.h"

namespace gaitpad {

// The facts about a pad that are known before its first report. pad_config() fills them
// (gaitpad/pad_configuration.h), or a program that has pads of its own.
struct PadConfig {
  std::shared_ptr<const PadLayout> layout;  // null: no report of the pad can be decoded
  Calibration calibration;
  bool is_usable = true;   // it has a stick that can drive
  bool is_present = true;  // plugged in at the start
  bool streams = false;    // it reports even while at rest: silence means that it is gone
  // It is the keyboard, which drives only while no other pad is plugged in.
  bool is_fallback = false;
  // Live pads: the pad told its own calibration when it was opened.
  bool has_factory_sticks = false;
  std::optional<FactoryGyro> factory_gyro;  // calibration of the gyroscope that the pad told
};
// Errors read `Calibration: left.inner is 2, outside [0, 0.9]`; those of the gyroscope are similar.
std::optional<Error> check(const PadConfig& config);

// A remark for users.
inline constexpr std::string_view kHatDrives =
    "while a pad's left stick has not moved, its D-pad drives (arcade sticks in D-pad mode)";

// The number of presses of each button.
using PressCounts = std::array<std::uint32_t, kButtonCount>;
// Counts the buttons that are up in `before` and down in `now` (PadState::buttons).
void count_presses(std::uint32_t before, std::uint32_t now, PressCounts& presses) noexcept;

// The version of the rules below that a recording was made with, by its V: line.
enum class PadRules {
  version_1,  // the first pad drives, moved or not, and a D-pad drives never
  version_2,
};

// Pads of a session; the class decides which of them drives.
//
// The first usable pad drives: the first of those plugged in at the start, else the first to be
// added. Another pad takes over when it is moved, by a tenth of a stick's deflection or a button,
// if the driving one has not been moved yet or has rested for 5 s: receivers without a pad, virtual
// pads and a pad's second device are there all the time but are never moved. A pad whose first
// report is already deflected or pressed takes over from one that rests and has not been moved yet.
//
// While a pad's left stick has not moved since it was plugged in, its D-pad is its left stick: the
// lever of an arcade stick in D-pad mode.
//
// When the driving pad is removed, another one takes over as soon as its stick is near its centre.
// If none has taken over, the old pad drives again when it comes back.
//
// The stick of a removed pad is neutral. After plugging in again it stays neutral until it has been
// near its centre. The stick of a streaming pad is neutral while the pad is silent for 100 ms. Time
// is counted in ticks. Which pad drives depends on the order of the reports alone, never on the
// numbers of the devices.
//
// A fallback drives only while no other usable pad is plugged in. But while the driving pad's left
// stick is neutral or exactly at rest and a fallback's left stick is not, the fallback's sticks
// count.
//
// Only the constructor allocates.
class Pads {
 public:
  Pads() = default;
  // A report's device is the index in `configs`. The rate is that of the ticks, clamped to 1 ..
  // kMaxRateHz.
  Pads(std::vector<PadConfig> configs, int rate_hz, PadRules rules = PadRules::version_2);

  // Sets the configuration of a device that was found later, before its first add_pad(). Swaps:
  // `config` receives the previous one.
  void set_pad(std::uint16_t device, PadConfig& config) noexcept;
  // Takes an input report. False if its device cannot send such a report: then nothing changes.
  bool take_report(const Report& report) noexcept;
  void add_pad(std::uint16_t device) noexcept;     // Call it when the pad was plugged in.
  void remove_pad(std::uint16_t device) noexcept;  // Call it when the pad was unplugged.
  // The driving stick after this tick's reports. Call it once a tick: it counts the silence.
  Stick finish_tick() noexcept;

  // The driving pad, which may be unplugged; kNoDevice: no pad has driven so far.
  std::uint16_t driving() const noexcept { return driving_; }
  // The driving pad's uncalibrated state; at rest if there is no driving pad.
  const PadState& driving_state() const noexcept;
  // The configuration of the driving pad; null if there is none.
  const PadConfig* driving_pad() const noexcept;
  // The number of reports of the driving pad since the beginning, sound or not.
  std::uint64_t driving_reports() const noexcept;
  // Number of presses of each button since the beginning, each on the pad that drove at that time.
  // Every report counts, so that a press between two ticks is not missed. A button that is held
  // while the pad is plugged in counts with the first report.
  const PressCounts& presses() const noexcept { return presses_; }
  // The number of times that the driving pad's left stick began to move the character untouched.
  std::int64_t untouched() const noexcept { return untouched_; }

 private:
  struct Pad {
    PadConfig config;
    PadState state;               // the state that the pad reported last
    JumpFilter filter;            // removes jumps of its sticks
    Stick stick;                  // the calibrated and filtered sticks of `state`
    bool is_awaited = false;      // plugged in again and not yet seen near its centre
    bool is_seen = false;         // it has reported since it was plugged in
    bool has_left_moved = false;  // its left stick has moved since it was plugged in
    Stick moved_to;               // position of its sticks when they moved last
    int resting_ticks = 0;        // ticks since it was moved, deflected or pressed
    std::uint64_t reports = 0;
    int silent_ticks = 0;
    int settled_ticks = 0;  // ticks of silence after which the filter's delay ends
    int turn = 0;  // rank among pads that can take over, the lowest first; 0: never plugged in
  };
  bool is_silent(const Pad& pad) const noexcept;
  // Sets the pad's `stick`. Call it when its configuration, state or filter has changed.
  static void calibrate(Pad& pad) noexcept;
  static void settle(Pad& pad) noexcept;
  bool is_near_centre(const Pad& pad) const noexcept;
  bool is_at_rest(const Pad& pad) const noexcept;
  bool take_movement(Pad& pad, std::uint32_t buttons_before) noexcept;
  // Lets another pad take over if it may. `is_first`: its first report since it was plugged in.
  void offer_seat(std::uint16_t device, bool is_first, bool has_moved) noexcept;
  void give_seat(std::uint16_t device) noexcept;
  bool can_take_over(const Pad& pad) const noexcept;
  bool has_lost_its_driver() const noexcept;
  bool is_fallback(std::uint16_t device) const noexcept;
  bool is_other_plugged_in() const noexcept;
  void replace_driver() noexcept;
  bool is_driven_by_hat(const Pad& pad) const noexcept;
  Stick stick_of(const Pad& pad) const noexcept;
  Stick fallback_stick() const noexcept;
  void watch(const Pad& pad, const vec2& left) noexcept;

  std::vector<Pad> pads_;
  PadRules rules_ = PadRules::version_2;
  std::uint16_t driving_ = kNoDevice;
  bool is_driver_moved_ = false;  // the driving pad was moved since it drives
  int turns_ = 0;
  PressCounts presses_{};
  UntouchedWatch watch_;  // watches the driving pad's left stick
  std::int64_t untouched_ = 0, ticks_ = 0;
  int rate_hz_ = 1;
  int silence_ticks_ = 0, settled_ticks_ = 0, yielding_ticks_ = 0;
};

}  // namespace gaitpad
