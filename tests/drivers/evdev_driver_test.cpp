#include <gtest/gtest.h>

#include "gaitpad/driver_registry.h"

namespace gaitpad {
namespace {

// Tests without a real node; the rig (tools/rig) tests real ones, and hid/evdev_layout_test the
// stated descriptor.
class EvdevDriver : public testing::Test {
 protected:
  void SetUp() override {
    driver_ = find_driver("evdev");
    ASSERT_NE(driver_, nullptr);
    if (!driver_->find) GTEST_SKIP() << "built without libevdev";
  }
  std::string open_problem(const std::string& node) {
    DeviceListing listing;
    listing.node = node;
    const auto device = driver_->open(listing, Detach::never);
    return device ? "opened" : device.error().message;
  }
  const DriverEntry* driver_ = nullptr;
};

TEST_F(EvdevDriver, WhatItFindsItCanOpenOrSaysWhyNot) {
  for (const DeviceListing& listing : driver_->find()) {
    EXPECT_EQ(listing.info.driver, "evdev");
    EXPECT_TRUE(listing.node.starts_with("/dev/input/event")) << listing.node;
    EXPECT_EQ(listing.problem.empty() && listing.info.descriptor.empty(), false) << listing.node;
  }
}

TEST_F(EvdevDriver, ANodeThatIsNotThereIsSaidToBeMissing) {
  EXPECT_EQ(open_problem("/dev/input/event9999"),
            "/dev/input/event9999: No such file or directory");
}

TEST_F(EvdevDriver, AFileThatIsNoInputNodeIsRefused) {
  EXPECT_EQ(open_problem("/dev/null"), "/dev/null: Inappropriate ioctl for device");
}

}  // namespace
}  // namespace gaitpad
