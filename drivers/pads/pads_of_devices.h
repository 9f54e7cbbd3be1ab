// Devices that are not one pad each: adapters and devices of several pads, a pair of Joy-Cons, and
// receivers, which are there without a pad.
//
// Several: Nintendo's adapter for four GameCube controllers, and devices whose descriptor has
// several pad collections with report ids of their own (adapters for two pads, the two halves of a
// Legion Go).
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/driver.h"

namespace gaitpad {

// A listing for each pad of the device; empty: it is one pad, or none. The first keeps its node,
// the others are `NODE:2` and so on, with ids and ports of their own. Each states a descriptor in
// which the other pads are none.
std::vector<DeviceListing> split_pads(const DeviceListing& device);
// The same listings, the split ones in place of the whole.
std::vector<DeviceListing> with_split_pads(const std::vector<DeviceListing>& devices);
// The node or port of the whole device.
std::string without_number(const std::string& part);
// Whether the descriptor is one that split_pads() states.
bool is_one_of_several(const std::vector<std::uint8_t>& descriptor);

// A listing for each left Joy-Con and the right one that goes with it, which are one pad with the
// reports of a Pro Controller; both must be usable. `node` is `LEFT+RIGHT`, `parts` are both pad
// paths. Two halves of a charging grip count as well: which one is which they tell only when they
// are opened.
std::vector<DeviceListing> joy_con_pairs(const std::vector<DeviceListing>& singles);
// Joins two open Joy-Cons, in any order. Error: they are not a left and a right one.
Result<std::unique_ptr<Device>> join_joy_cons(std::unique_ptr<Device> one,
                                              std::unique_ptr<Device> other);

// A pair's reports have one side's sensors, bytes 13 to 48. This byte tells which side's; in a
// single Joy-Con's report it holds the motors' answer, which no layout reads.
inline constexpr std::size_t kPairSideByte = 12;
inline constexpr std::uint8_t kPairLeft = 'L', kPairRight = 'R';

// Whether a pad came to a receiver, or went, since the last packet.
class PlugWatch {
 public:
  // True if the plug's state has changed; then `report` says so.
  bool has_changed(const PadQuirks& quirks, Report& report) noexcept {
    if (quirks.is_plugged() == was_plugged_) return false;
    was_plugged_ = !was_plugged_;
    report.kind = was_plugged_ ? ReportKind::added : ReportKind::removed;
    report.size = 0;
    return true;
  }

 private:
  bool was_plugged_ = true;
};

// The port of a pad behind a receiver of Microsoft's, whose kernel driver gives all of its pads one
// port: Linux xpad.c says `/input0` of every interface of an Xbox 360 receiver.
std::string port_behind_receiver(const std::string& port, std::string_view kernel_driver,
                                 unsigned interface_number);
// DeviceListing::pad_path: xone's dongle has one USB interface for all; `maker` is the sysfs folder
// of the device that made the event node.
std::string path_behind_receiver(const std::string& interface_path, std::string_view kernel_driver,
                                 const std::string& maker);

}  // namespace gaitpad
