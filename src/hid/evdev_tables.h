// The tables of hid/evdev_codes: usages and codes as plain numbers, from the HID Usage Tables and
// Linux's input-event-codes.h.
#pragma once
#include <algorithm>
#include <iterator>

#include "hid/evdev_codes.h"

namespace gaitpad::evdev {

constexpr EvdevCode key(std::uint16_t code) { return {EvdevType::key, code}; }
constexpr EvdevCode axis(std::uint16_t code) { return {EvdevType::absolute, code}; }

struct Row {
  std::uint32_t usage = 0;
  EvdevCode code;
};
template <class Table>
const Row* row_of(const Table& table, std::uint32_t usage) noexcept {
  const auto it = std::find_if(std::begin(table), std::end(table),
                               [usage](const Row& row) { return row.usage == usage; });
  return it == std::end(table) ? nullptr : &*it;
}

// Pages of the HID Usage Tables.
inline constexpr std::uint16_t kDesktop = 0x01, kSimulation = 0x02, kConsumer = 0x0c;
inline constexpr std::uint16_t kKeyUnknown = 240;
inline constexpr std::uint32_t kBatteryStrength = usage_of(0x06, 0x20);

// Axes whose code may be given to several fields (hid-input clears it before it takes it).
inline constexpr Row kSharedAxes[] = {
    {usage::kX, axis(0x00)},
    {usage::kY, axis(0x01)},
    {usage::kZ, axis(0x02)},
    {usage::kRx, axis(0x03)},
    {usage::kRy, axis(0x04)},
    {usage::kRz, axis(0x05)},
    {usage_of(kConsumer, 0xe0), axis(0x20)},  // volume
};
inline constexpr std::uint32_t kWheel = usage_of(kDesktop, 0x38);
inline constexpr Row kAxes[] = {
    {usage_of(kDesktop, 0x36), axis(0x06)},  // slider: ABS_THROTTLE
    {usage_of(kDesktop, 0x37), axis(0x07)},  // dial: ABS_RUDDER
    {kWheel, axis(0x08)},
    {usage::kRudder, axis(0x07)},
    {usage::kThrottle, axis(0x06)},
    {usage::kAccelerator, axis(0x09)},  // ABS_GAS
    {usage::kBrake, axis(0x0a)},
    {usage_of(kSimulation, 0xc8), axis(0x08)},  // steering: ABS_WHEEL
};

// Keys beside the buttons: the system controls, and of the consumer page what pads and remotes
// have. Any other consumer usage becomes KEY_UNKNOWN.
inline constexpr Row kKeys[] = {
    {usage::kStart, key(0x13b)},
    {usage::kSelect, key(0x13a)},
    {usage_of(kDesktop, 0x81), key(116)},    // power down
    {usage_of(kDesktop, 0x82), key(142)},    // sleep
    {usage_of(kDesktop, 0x83), key(143)},    // wake up
    {usage_of(kDesktop, 0x84), key(0x1b6)},  // context menu
    {usage::kSystemMainMenu, key(139)},
    {usage_of(kDesktop, 0x86), key(148)},    // application menu
    {usage_of(kDesktop, 0x87), key(138)},    // help
    {usage_of(kDesktop, 0x88), key(174)},    // exit
    {usage_of(kDesktop, 0x89), key(0x161)},  // select
    {usage_of(kDesktop, 0x8a), key(106)},    // right, left, up, down
    {usage_of(kDesktop, 0x8b), key(105)},
    {usage_of(kDesktop, 0x8c), key(103)},
    {usage_of(kDesktop, 0x8d), key(108)},
    {usage_of(kDesktop, 0x8e), key(0x164)},   // cold restart
    {usage_of(kDesktop, 0x8f), key(0x198)},   // warm restart
    {usage_of(kDesktop, 0xb5), key(227)},     // display toggle
    {usage_of(kConsumer, 0x30), key(116)},    // power
    {usage_of(kConsumer, 0x32), key(142)},    // sleep
    {usage_of(kConsumer, 0x36), key(0x100)},  // function buttons: BTN_MISC
    {usage_of(kConsumer, 0x40), key(139)},    // menu, its pick, up, down, left, right, escape
    {usage_of(kConsumer, 0x41), key(0x161)},
    {usage_of(kConsumer, 0x42), key(103)},
    {usage_of(kConsumer, 0x43), key(108)},
    {usage_of(kConsumer, 0x44), key(105)},
    {usage_of(kConsumer, 0x45), key(106)},
    {usage_of(kConsumer, 0x46), key(1)},
    {usage_of(kConsumer, 0x65), key(212)},   // snapshot: KEY_CAMERA
    {usage_of(kConsumer, 0x82), key(0xf1)},  // mode step, recall last, enter channel
    {usage_of(kConsumer, 0x83), key(0x195)},
    {usage_of(kConsumer, 0x84), key(28)},
    {usage_of(kConsumer, 0xb0), key(207)},  // play, pause, record, fast forward, rewind
    {usage_of(kConsumer, 0xb1), key(119)},
    {usage::kConsumerRecord, key(167)},
    {usage_of(kConsumer, 0xb3), key(208)},
    {usage_of(kConsumer, 0xb4), key(168)},
    {usage_of(kConsumer, 0xb5), key(163)},  // next, previous, stop, eject
    {usage_of(kConsumer, 0xb6), key(165)},
    {usage_of(kConsumer, 0xb7), key(166)},
    {usage_of(kConsumer, 0xb8), key(161)},
    {usage_of(kConsumer, 0xb9), key(0x19a)},  // shuffle, repeat, slow
    {usage_of(kConsumer, 0xbc), key(0x1b7)},
    {usage_of(kConsumer, 0xbf), key(0x199)},
    {usage_of(kConsumer, 0xcd), key(164)},  // play/pause
    {usage_of(kConsumer, 0xe2), key(113)},  // mute, volume up, down
    {usage_of(kConsumer, 0xe9), key(115)},
    {usage_of(kConsumer, 0xea), key(114)},
    {usage_of(kConsumer, 0x1a2), key(0x244)},  // task select
    {usage_of(kConsumer, 0x1cb), key(0x247)},  // assistant
    {usage_of(kConsumer, 0x221), key(217)},    // search
    {usage::kConsumerHome, key(172)},
    {usage::kConsumerBack, key(158)},
    {usage_of(kConsumer, 0x225), key(159)},  // forward, stop, refresh
    {usage_of(kConsumer, 0x226), key(128)},
    {usage_of(kConsumer, 0x227), key(173)},
};

inline constexpr Row kDpad[] = {
    {usage::kDpadUp, key(kBtnDpadUp)},
    {usage::kDpadDown, key(kBtnDpadUp + 1)},
    {usage::kDpadLeft, key(kBtnDpadUp + 2)},
    {usage::kDpadRight, key(kBtnDpadUp + 3)},
};

// The usages by which the evdev driver states codes, where they are no buttons.
inline constexpr Row kStated[] = {
    {usage::kX, axis(0x00)},
    {usage::kY, axis(0x01)},
    {usage::kZ, axis(0x02)},
    {usage::kRx, axis(0x03)},
    {usage::kRy, axis(0x04)},
    {usage::kRz, axis(0x05)},
    {usage::kThrottle, axis(0x06)},
    {usage::kRudder, axis(0x07)},
    {kWheel, axis(0x08)},
    {usage::kAccelerator, axis(0x09)},
    {usage::kBrake, axis(0x0a)},
    {usage::kHatSwitch, axis(kAbsHat0X)},
    {usage::kStart, key(0x13b)},
    {usage::kSelect, key(0x13a)},
    {usage::kSystemMainMenu, key(139)},
    {usage::kConsumerRecord, key(167)},
    {usage::kConsumerHome, key(172)},
    {usage::kConsumerBack, key(158)},
    {usage::kDpadUp, key(kBtnDpadUp)},
    {usage::kDpadDown, key(kBtnDpadUp + 1)},
    {usage::kDpadLeft, key(kBtnDpadUp + 2)},
    {usage::kDpadRight, key(kBtnDpadUp + 3)},
};

}  // namespace gaitpad::evdev
