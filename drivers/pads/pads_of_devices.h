// Devices that are not exactly one pad: adapters and devices with several pads, a pair of Joy-Cons,
// and receivers, which are there even without a pad.
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

// A listing for each pad of the device; empty: it is one pad, or none. The first keeps the device's
// node, the others are `NODE:2` and so on, with their own ids and ports. Each states a descriptor
// in which the other pads do not appear as pads.
std::vector<DeviceListing> split_pads(const DeviceListing& device);
// The listings, with each device of several pads replaced by its pads.
std::vector<DeviceListing> with_split_pads(const std::vector<DeviceListing>& devices);
// The node or port of the whole device, without the pad's number.
std::string without_number(const std::string& part);
// True if split_pads() has made this descriptor.
bool is_one_of_several(const std::vector<std::uint8_t>& descriptor);

// A listing for each left Joy-Con and the right one that belongs to it, which are one pad with the
// reports of a Pro Controller; both must be usable. `node` is `LEFT+RIGHT`, `parts` are both pad
// paths. Two halves of a charging grip count as well: they tell which one is which only when they
// are opened.
std::vector<DeviceListing> joy_con_pairs(const std::vector<DeviceListing>& singles);
// Joins two open Joy-Cons, in any order. Error: they are not a left and a right one.
Result<std::unique_ptr<Device>> join_joy_cons(std::unique_ptr<Device> one,
                                              std::unique_ptr<Device> other);

// A pair's reports have the sensors of one side in bytes 13 to 48. This byte tells of which side;
// in a single Joy-Con's report it holds the motors' answer, which no layout reads.
inline constexpr std::size_t kPairSideByte = 12;
inline constexpr std::uint8_t kPairLeft = 'L', kPairRight = 'R';

// Watches for pads that connect to a receiver or leave it.
class PlugWatch {
 public:
  // True if the plug's state has changed; then `report` says so.
  bool has_changed(const PadQuirks& quirks, Report& report) noexcept {
    if (quirks.has_pad() == was_plugged_) return false;
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
// The DeviceListing::pad_path of such a pad: xone's dongle has one USB interface for all; `maker`
// is the sysfs folder of the device that made the event node.
std::string path_behind_receiver(const std::string& interface_path, std::string_view kernel_driver,
                                 const std::string& maker);

}  // namespace gaitpad
