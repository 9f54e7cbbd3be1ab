#include "drivers/system_nodes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

// The tests hold on every machine; the rig (tools/rig) tests real hardware.

TEST(SystemNodes, EveryNodeIsADeviceFileWithASysfsFolder) {
  for (const char* subsystem : {"hidraw", "input", "usb"}) {
    for (const SystemNode& node : system_nodes(subsystem)) {
      EXPECT_TRUE(node.node.starts_with("/dev/")) << node.node;
      EXPECT_TRUE(node.sysfs_path.starts_with("/sys/")) << node.sysfs_path;
      EXPECT_LE(node.descriptor.size(), 4096u);
    }
  }
}

TEST(SystemNodes, AnUnknownSubsystemHasNoNodes) { EXPECT_TRUE(system_nodes("none").empty()); }

TEST(SystemNodes, AnInterfaceThatIsNotThereHasNoPath) {
  EXPECT_EQ(usb_interface_path("99-9:1.0"), "");
}

// Linux's power supplies (Documentation/ABI/testing/sysfs-class-power): hid-playstation reports
// percent, hid-nintendo a level; both are below the HID device.
TEST(Battery, IsWhatTheKernelHasOfThePad) {
  OwnFolder folder;
  const std::string supply = "/0003:054C:0CE6.0001/power_supply/it/";
  const auto pad = [&](const std::string& name) { return (folder.path / name).string(); };
  const auto write = [&](const std::string& name, const char* file, const std::string& text) {
    folder.write(name + supply + file, text);
  };
  write("percent", "capacity", "45\n");
  write("percent", "status", "Discharging\n");
  auto battery = battery_of(pad("percent"));
  ASSERT_TRUE(battery);
  EXPECT_EQ(battery->percent, 45);
  EXPECT_EQ(battery->status, "discharging");
  EXPECT_EQ(battery->level, "");
  write("level", "capacity_level", "Low\n");
  write("level", "status", "Unknown\n");
  battery = battery_of(pad("level"));
  ASSERT_TRUE(battery);
  EXPECT_FALSE(battery->percent);
  EXPECT_EQ(battery->level, "low");
  EXPECT_EQ(battery->status, "");
  write("unknown", "capacity_level", "Unknown\n");
  EXPECT_FALSE(battery_of(pad("unknown")));
  EXPECT_FALSE(battery_of(pad("none")));
  EXPECT_FALSE(battery_of(std::string()));
}

TEST(AccessProblem, AMissingNodeIsSaidToBeMissing) {
  EXPECT_EQ(access_problem("/dev/none/hidraw0"), "/dev/none/hidraw0: No such file or directory");
}

TEST(AccessProblem, NoneWhereTheUserMayReadAndWrite) { EXPECT_EQ(access_problem("/dev/null"), ""); }

TEST(AccessProblem, NamesOwnerAndModeOfWhatIsForbidden) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may open everything; the rig tries it as a user";
  OwnFolder folder;
  const std::string path = folder.write("node");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  const std::string problem = access_problem(path);
  EXPECT_NE(problem.find("permission denied"), std::string::npos) << problem;
  EXPECT_NE(problem.find("mode 0000"), std::string::npos) << problem;
}

TEST(HotplugMonitor, HasSomethingToWaitForAndNothingToTellAtFirst) {
  auto monitor = HotplugMonitor::create();
  if (!monitor) GTEST_SKIP() << monitor.error().message;
  EXPECT_GE(monitor->fd(), 0);
  HotplugMonitor moved = std::move(*monitor);
  EXPECT_GE(moved.fd(), 0);
}

}  // namespace
}  // namespace gaitpad
