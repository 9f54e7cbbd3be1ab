#include "doctor/findings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gaitpad/driver_registry.h"

namespace gaitpad {
namespace {

using State = Finding::State;
const RulesFile kNoRules = {"rules", ""};

// A machine with udev, and a pad without nodes in /dev.
Machine made_machine() {
  Machine machine;
  machine.has_udev = true;
  PadHardware& pad = machine.pads.emplace_back();
  pad.path = "/sys/devices/made";
  pad.name = "Made Pad";
  pad.bus = BusType::usb;
  pad.vendor = 0x1209;
  pad.product = 1;
  pad.hidraw.emplace_back().node = "/nowhere/hidraw0";
  return machine;
}

PadSighting sighting_of(const PadHardware& pad, const char* driver) {
  PadSighting sighting;
  sighting.listing.node = pad.hidraw[0].node;
  sighting.listing.pad_path = pad.path;
  for (const DriverEntry& entry : drivers()) {
    if (entry.name == std::string_view(driver)) sighting.driver = &entry;
  }
  sighting.is_pad = true;
  return sighting;
}

const Finding* find(const std::vector<Finding>& list, State state, std::string_view part) {
  const auto at = std::ranges::find_if(list, [&](const Finding& f) {
    return f.state == state && f.cause.find(part) != std::string::npos;
  });
  return at == list.end() ? nullptr : &*at;
}

TEST(Findings, WithoutAPadTheyNameWhatIsPluggedIn) {
  Machine machine;
  machine.has_udev = true;
  SystemNode& mouse = machine.usb_devices.emplace_back();
  mouse.vendor = 0x046d;
  mouse.product = 0xc077;
  mouse.name = "Mouse";
  const auto list = findings(machine, kNoRules);
  EXPECT_TRUE(find(list, State::problem, "none of the 1 USB devices is one: 046d:c077 Mouse"));
}

TEST(Findings, AMissingNodeIsAProblemWithAFixThatFitsTheMachine) {
  Machine machine = made_machine();
  const Finding* found = nullptr;
  auto list = findings(machine, kNoRules);
  ASSERT_TRUE(found = find(list, State::problem, "it is not in /dev"));
  EXPECT_EQ(found->node, "/nowhere/hidraw0");
  EXPECT_EQ(found->device, "Made Pad");
  EXPECT_EQ(found->fix, "sudo udevadm trigger");
  machine.is_container = true;
  list = findings(machine, kNoRules);
  ASSERT_TRUE(found = find(list, State::problem, "it is not in /dev"));
  EXPECT_NE(found->fix.find("--device /nowhere/hidraw0"), std::string::npos);
}

TEST(Findings, APadThatOneDriverOpensIsUsableAndItsOtherFaultsAreNotes) {
  Machine machine = made_machine();
  machine.sightings = {sighting_of(machine.pads[0], "hidraw")};
  const auto list = findings(machine, kNoRules);
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list[0].state, State::usable);
  EXPECT_NE(list[0].cause.find("works through hidraw (/nowhere/hidraw0)"), std::string::npos);
  EXPECT_TRUE(find(list, State::note, "it is not in /dev"));
  EXPECT_TRUE(std::ranges::is_sorted(list, {}, &Finding::state));
}

TEST(Findings, APadThatTheKernelHasIsUsableByUsbOnlyIfAsked) {
  Machine machine = made_machine();
  machine.sightings = {sighting_of(machine.pads[0], "usb")};
  machine.sightings[0].listing.kernel_driver = "usbhid";
  const auto list = findings(machine, kNoRules);
  EXPECT_FALSE(find(list, State::usable, ""));
  const Finding* found = find(list, State::note, "it can be taken from the kernel");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->fix, "gaitpad play --driver usb");
}

TEST(Findings, WhatTheDriverSaysIsTheCauseIfNothingElseExplainsIt) {
  Machine machine = made_machine();
  machine.pads[0].hidraw[0].node = "/dev/null";  // a node that everyone may open
  machine.pads[0].events.emplace_back().node = "/dev/null";
  machine.sightings = {sighting_of(machine.pads[0], "hidraw")};
  machine.sightings[0].problem = "/dev/null: the descriptor is cut off at byte 4";
  const auto list = findings(machine, kNoRules);
  EXPECT_TRUE(find(list, State::problem, "cut off at byte 4"));
}

TEST(Findings, WithoutUdevTheMachineHasAProblemAndAContainerAnotherFix) {
  Machine machine = made_machine();
  machine.has_udev = false;
  const auto problem = [&] {
    const auto list = findings(machine, kNoRules);
    return *std::ranges::find(list, "udev", &Finding::node);
  };
  EXPECT_EQ(problem().state, State::problem);
  EXPECT_EQ(problem().fix, "sudo systemctl start systemd-udevd");
  machine.is_container = true;
  EXPECT_NE(problem().fix.find("-v /run/udev"), std::string::npos);
}

TEST(Findings, RulesGetALineForAPadThatTheyDoNotName) {
  const Machine machine = made_machine();
  const std::string text = rules_text(machine, kNoRules);
  EXPECT_TRUE(opens_hidraw(text, {3, 0x1209, 1, std::nullopt}));
  EXPECT_EQ(rules_text(machine, {"rules", text}), text) << "it is named";
}

}  // namespace
}  // namespace gaitpad
